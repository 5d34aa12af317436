#include <fmt/format.h>

#include "base/process.h"
#include "client/live/target.h"
#include "client/scene_input.h"
#include "client/verbs/verbs.h"
#include "scene/canonical.h"
#include "scene/load.h"

namespace shaken::client {
namespace {

class Run : public Verb {
 public:
  VerbInfo info() const override {
    return {"run", kPrepareGroup, "Simulate one scene here and now, without a daemon",
            "  shaken run scene.json                         into runs/ID, named after what the scene says\n"
            "  shaken run scene.json --out runs/first\n"
            "  shaken run scene.json --out runs/dilute -s rods.area_fraction=0.5 -s time.measure=5\n"
            "  shaken run large.json --out runs/large --threads 2\n"
            "  shaken run scene.json --out runs/first        goes on from the last checkpoint\n"
            "  shaken plot runs/first && shaken movie runs/first",
            "0 done, 1 failed, 2 bad input, 97 no room on the disk, 98 an error of the system that may "
            "pass, 99 stopped by Ctrl-C or a signal; after these the same command goes on from a checkpoint"};
  }

  void declare(Arguments& arguments) override {
    arguments.required("SCENE", scene_, "A scene file", Names::kFile);
    arguments.option("-o,--out", out_, "DIR", "The run's directory, made if need be; runs/ID if left out",
                     Names::kFolder);
    arguments.option("-t,--threads", threads_, "N",
                     "Threads that share each tick, 1 if not given: worth it from about 2,000 rods on");
    arguments.repeatable("-s,--set", settings_, "PATH=VALUE", "Change one value of the scene");
  }

  ExitCode run(const Context&) override {
    if (threads_ && (*threads_ < 1 || *threads_ > 64)) {
      throw Failure(ExitCode::kBadInput, fmt::format("--threads takes a number from 1 to 64, not {}", *threads_));
    }
    if (out_.empty()) {
      const SceneInput input = read_scene_input(scene_);
      const auto plan = scene::load_scene(input.text, input.file, settings_);
      if (!plan) throw Failure(ExitCode::kBadInput, refusal_text(plan.error()));
      out_ = "runs/" + short_id(scene::run_id(*plan));
    }
    std::vector<std::string> command{sibling_program("shaken-worker").string(), scene_, "--out", out_};
    for (const std::string& setting : settings_) command.insert(command.end(), {"-s", setting});
    if (threads_) command.insert(command.end(), {"--threads", std::to_string(*threads_)});
    become(command);
  }

 private:
  std::string scene_;
  std::string out_;
  std::optional<int> threads_;
  std::vector<std::string> settings_;
};

}  // namespace

std::unique_ptr<Verb> make_run() { return std::make_unique<Run>(); }

}  // namespace shaken::client
