#include "base/process.h"
#include "client/verbs/verbs.h"
#include "run/import/import_run.h"

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
    arguments.required("FILE", asked_.file, "A table of rods in CSV, or the trajectory.h5 of a run", Names::kFile);
    arguments.options_of([this](CLI::App& app) { run::declare(app, asked_); });
    arguments.hand_on(words_);
  }

  ExitCode run(const Context& context) override {
    std::vector<std::string> command{sibling_program("shaken-worker").string(), "import", "--root",
                                     context.root().string()};
    command.insert(command.end(), words_.begin(), words_.end());
    command.insert(command.end(), {"--", asked_.file});
    become(command);
  }

 private:
  run::ImportOptions asked_;
  std::vector<std::string> words_;  ///< the same, as they were given
};

}  // namespace

std::unique_ptr<Verb> make_import() { return std::make_unique<Import>(); }

}  // namespace shaken::client
