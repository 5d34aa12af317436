#include "client/completion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>

#include "base/plots_by_python.h"
#include "client/live/target.h"
#include "client/verbs/in_python.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

/// Whether `name` may be offered to a shell: letters, digits, blanks and a few signs. What a shell expands is left out:
/// "$(...)" in somebody's scene could be carried out at the next Tab.
bool is_plain(const std::string& name) {
  static constexpr std::string_view kPlain = "._-+=,:@% ";
  return std::all_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x80 || std::isalnum(byte) != 0 || kPlain.find(c) != std::string_view::npos;
  });
}

class Completion : public Verb {
 public:
  VerbInfo info() const override {
    return {"completion", kHelpGroup, "Script that lets the shell complete verbs, options, files and IDs",
            "  eval \"$(shaken completion bash)\"     now, in this shell\n"
            "  echo 'eval \"$(shaken completion bash)\"' >> ~/.bashrc\n"
            "  echo 'eval \"$(shaken completion zsh)\"' >> ~/.zshrc\n"
            "  shaken completion ids                the IDs of sweeps and jobs, one a line; also sweeps, jobs, and\n"
            "                                       fields, of the newest sweep's results"};
  }

  void declare(Arguments& arguments) override {
    arguments.required("WHAT", what_, "bash or zsh; or ids, sweeps, jobs, or fields, which the script asks for",
                       {"bash", "zsh", "ids", "sweeps", "jobs", "fields"});
  }

  ExitCode run(const Context& context) override {
    std::ostream& out = context.console.out;
    if (what_ == "bash") {
      out << bash_completion(context.app);
    } else if (what_ == "zsh") {
      out << zsh_completion(context.app);
    } else if (what_ == "ids" || what_ == "sweeps" || what_ == "jobs") {
      ApiClient session(context.root());
      if (what_ != "jobs") print_sweeps(session, out);
      if (what_ != "sweeps") print_jobs(session, out);
    } else if (what_ == "fields") {
      std::vector<std::string> command = python_command("tables");
      command.insert(command.end(), {"fields", root_option(context)});
      return context.console.run_instead(context.console, command);
    } else {
      throw Failure(ExitCode::kBadInput,
                    fmt::format("no completion for '{}': bash, zsh, ids, sweeps, jobs or fields", what_));
    }
    return ExitCode::kOk;
  }

 private:
  static void print_sweeps(ApiClient& session, std::ostream& out) {
    const Json sweeps = session.get("/v1/sweeps");
    std::set<std::string> words;  // sweeps may share a name
    for (const Json& sweep : sweeps.at("sweeps")) {
      words.insert(sweep.at("id").get<std::string>());
      if (const std::string name = text_of(sweep, "name"); is_plain(name)) words.insert(name);
    }
    words.erase("");
    for (const std::string& word : words) out << word << "\n";
  }

  static void print_jobs(ApiClient& session, std::ostream& out) {
    const Json jobs = session.get("/v1/jobs");
    for (const Json& job : jobs.at("jobs")) out << short_id(job.at("id").get<std::string>()) << "\n";
  }

  std::string what_;
};

}  // namespace

std::unique_ptr<Verb> make_completion() { return std::make_unique<Completion>(); }

}  // namespace shaken::client
