#include "base/process.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Replay : public Verb {
 public:
  VerbInfo info() const override {
    return {"replay", kResultsGroup, "Meet a run's numerical trouble again, and show the rods concerned",
            "  shaken replay runs/wild             from its last checkpoint to the tick of the trouble\n"
            "  shaken replay runs/wild --json      the same for programs",
            "0 the same trouble came back, 1 it did not, 2 the run has met none"};
  }

  void declare(Arguments& arguments) override {
    arguments.required("DIR", directory_, "The directory of a run that failed, with a trouble.json", Names::kFolder);
    arguments.flag("--json", json_, "Print JSON");
  }

  ExitCode run(const Context&) override {
    std::vector<std::string> command{sibling_program("shaken-worker").string(), "replay", directory_};
    if (json_) command.emplace_back("--json");
    become(command);
  }

 private:
  std::string directory_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_replay() { return std::make_unique<Replay>(); }

}  // namespace shaken::client
