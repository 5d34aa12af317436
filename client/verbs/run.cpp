// SPDX-License-Identifier: MIT
#include "client/process.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Run : public Verb {
 public:
  VerbInfo info() const override {
    return {"run", kPrepareGroup, "Simulate one scene here and now, without a daemon",
            "  shaken run scene.json --out runs/first\n"
            "  shaken run scene.json --out runs/dilute -s rods.area_fraction=0.5 -s time.measure=5\n"
            "  shaken run large.json --out runs/large --threads 2\n"
            "  shaken run scene.json --out runs/first        goes on from the last checkpoint\n"
            "  shaken plot runs/first && shaken movie runs/first"};
  }

  void declare(Arguments& arguments) override {
    arguments.required("SCENE", scene_, "A scene file", Names::kFile);
    arguments.option("-o,--out", out_, "DIR", "The run's directory (required); made if need be", Names::kFolder);
    arguments.option("-t,--threads", threads_, "N",
                     "Threads that share each tick, 1 if not given: worth it from about 5,000 rods on");
    arguments.repeatable("-s,--set", settings_, "PATH=VALUE", "Change one value of the scene");
  }

  ExitCode run(const Context&) override {
    if (out_.empty()) throw Failure(ExitCode::kBadInput, "run needs a directory to write to: --out DIR");
    std::vector<std::string> command{sibling_program("shaken-worker").string(), scene_, "--out", out_};
    for (const std::string& setting : settings_) command.insert(command.end(), {"-s", setting});
    if (!threads_.empty()) command.insert(command.end(), {"--threads", threads_});
    become(command);
  }

 private:
  std::string scene_;
  std::string out_;
  std::string threads_;
  std::vector<std::string> settings_;
};

}  // namespace

std::unique_ptr<Verb> make_run() { return std::make_unique<Run>(); }

}  // namespace shaken::client
