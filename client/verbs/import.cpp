#include <fmt/format.h>

#include "base/process.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

class Import : public Verb {
 public:
  VerbInfo info() const override {
    return {
        "import", kPrepareGroup, "Make a run of rods from a file, from which a scene can start",
        "  shaken import rods.csv --scene scene.json          prints the \"start\" for scenes\n"
        "  shaken import rods.csv --scene scene.json --random-velocities\n"
        "  shaken import runs/first/trajectory.h5 --scene scene.json --frame 10\n"
        "  shaken import rods.csv --scene scene.json -s rods.count=31 --json\n"
        "\nThe first line of a table names its columns: x, y [mm]; nx, ny or angle [degrees]; and, if it has them, "
        "z, nz or tilt, species, vx, vy, vz [mm/s], wx, wy, wz [rad/s]. Rods without z lie on the base. All that is "
        "wrong is listed with its lines."};
  }

  void declare(Arguments& arguments) override {
    arguments.required("FILE", file_, "A table of rods in CSV, or the trajectory.h5 of a run", Names::kFile);
    arguments.option("--scene", scene_, "SCENE", "The scene whose rods these are: must be given", Names::kFile);
    arguments.repeatable("-s,--set", settings_, "PATH=VALUE", "Change one value of the scene", Names::kSetting);
    arguments.option("--frame", frame_, "N", "Of a trajectory: this frame, from 0; the last one if left out");
    arguments.flag("--random-velocities", random_velocities_,
                   "Of a table without velocities: as of any other start, by the scene's seed; 0 if left out");
    arguments.flag("--json", json_, "Print JSON, also of problems");
  }

  ExitCode run(const Context& context) override {
    if (scene_.empty()) throw Failure(ExitCode::kBadInput, "--scene is missing: the scene whose rods these are");
    if (frame_ && *frame_ < 0) {
      throw Failure(ExitCode::kBadInput, fmt::format("--frame takes a number from 0, not {}", *frame_));
    }
    std::vector<std::string> command{
        sibling_program("shaken-worker").string(), "import", "--scene", scene_, "--root", context.root().string()};
    for (const std::string& setting : settings_) command.insert(command.end(), {"-s", setting});
    if (frame_) command.insert(command.end(), {"--frame", std::to_string(*frame_)});
    if (random_velocities_) command.emplace_back("--random-velocities");
    if (json_) command.emplace_back("--json");
    command.insert(command.end(), {"--", file_});
    become(command);
  }

 private:
  std::string file_;
  std::string scene_;
  std::vector<std::string> settings_;
  std::optional<int> frame_;
  bool random_velocities_ = false;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_import() { return std::make_unique<Import>(); }

}  // namespace shaken::client
