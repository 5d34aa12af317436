#include <filesystem>

#include "base/failure.h"
#include "base/process.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Bench : public Verb {
 public:
  VerbInfo info() const override {
    return {"bench", kHelpGroup, "Measure this build on this machine; without a name: lists the benches",
            "  shaken bench speed --quick                    rod-seconds per CPU-second, in about a minute\n"
            "  shaken bench effects                          CPU time with each effect switched off\n"
            "  shaken bench speed --help"};
  }

  void declare(Arguments& arguments) override { arguments.rest(words_); }

  ExitCode run(const Context&) override {
    const std::filesystem::path program = sibling_program("shaken-bench");
    if (!std::filesystem::exists(program)) {  // `./dev demo` and some packages do without it
      throw Failure(ExitCode::kFailed, "shaken-bench is not in " + program.parent_path().string() +
                                           ": `./dev build` makes it, or `cmake --build build/release --target "
                                           "shaken-bench`");
    }
    std::vector<std::string> command{program.string()};
    command.insert(command.end(), words_.begin(), words_.end());
    if (words_.empty()) command.emplace_back("--help");
    become(command);
  }

 private:
  std::vector<std::string> words_;
};

}  // namespace

std::unique_ptr<Verb> make_bench() { return std::make_unique<Bench>(); }

}  // namespace shaken::client
