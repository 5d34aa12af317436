#include <fmt/format.h>

#include <filesystem>

#include "base/files.h"
#include "base/process.h"
#include "client/live/api_client.h"
#include "client/starter_scene.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

/// Where the schema of scenes lies beside this program, for editors; empty if it is not there.
std::string schema_url() {
  std::error_code error;
  const auto file = std::filesystem::canonical(
      sibling_program("shaken").parent_path() / "../share/shaken/schemas/scene.schema.json", error);
  if (error) return "";
  std::string url = "file://";
  for (const auto& part : file.relative_path()) url += "/" + url_encoded(part.string());
  return url;
}

/// The scene to start from, which names its schema.
std::string starter_scene() {
  std::string scene(kStarterScene);
  const std::string url = schema_url();
  if (!url.empty()) scene.insert(scene.find('\n') + 1, fmt::format("  \"$schema\": \"{}\",  // for editors\n\n", url));
  return scene;
}

class Init : public Verb {
 public:
  VerbInfo info() const override {
    return {"init", kPrepareGroup, "Write a commented scene to start from",
            "  shaken init                   scene.json\n"
            "  shaken init dense.json\n"
            "  shaken init - | less          to stdout"};
  }

  void declare(Arguments& arguments) override {
    arguments.optional("FILE", file_, "Where to write, scene.json if left out; - writes to stdout", Names::kFile);
    arguments.flag("--force", force_, "Replace a file that exists");
  }

  ExitCode run(const Context& context) override {
    if (file_ == "-") {
      context.console.out << starter_scene();
      return ExitCode::kOk;
    }
    if (std::filesystem::exists(file_) && !force_) {
      throw Failure(ExitCode::kBadInput, fmt::format("{} exists: --force replaces it", file_));
    }
    done_or_fail(write_file_atomically(file_, starter_scene()));
    context.console.out << fmt::format(
        "{0}: next `shaken validate {0}`, then `shaken run {0} --out runs/first` or `shaken submit {0}`\n", file_);
    return ExitCode::kOk;
  }

 private:
  std::string file_ = "scene.json";
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_init() { return std::make_unique<Init>(); }

}  // namespace shaken::client
