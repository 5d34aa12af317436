// `shaken calibrate`: the scene of each species by itself, from which the Python package finds its noise
// (python/shaken/calibration/app.py).
#include <fmt/format.h>

#include <span>

#include "client/scene_input.h"
#include "client/verbs/in_python.h"
#include "client/verbs/verbs.h"
#include "scene/canonical.h"
#include "scene/keys/derived.h"
#include "scene/keys/measured_species.h"
#include "scene/load.h"

namespace shaken::client {
namespace {

/// A species by itself, as shaken/calibration/rods.py takes it.
Json species_json(const scene::RunPlan& plan, std::size_t number) {
  const scene::RunPlan alone = scene::rods_of_species(plan, number);
  const System& system = alone.system;
  const Species mean = scene::species_of(system.rod);
  return {{"name", number == 0 ? "rods" : fmt::format("rods_{}", number + 1)},
          {"has_axis", system.rod.has_axis()},
          {"rod_area_mm2", scene::area_fraction_of(system, system.rod, 1) * system.area()},
          {"least_side_mm", least_box_side(std::span(&mean, 1))},
          {"scene", scene::to_json(alone)}};
}

class Calibrate : public InPython {
 public:
  VerbInfo info() const override {
    return {
        "calibrate", kPrepareGroup, "The rotational noise with which rods have a wanted rotational diffusion",
        "  shaken calibrate scene.json --rotational-diffusion 4 --area-fraction 0.3\n"
        "                                   the noise that gives D_r = 4 rad^2/s, of each species\n"
        "  shaken calibrate scene.json --rotational-diffusion 4 --area-fraction 0.3 --of rods_2\n"
        "  shaken calibrate scene.json -d 4 -d 8 --area-fraction 0.3     several D_r, which share what is measured\n"
        "  shaken calibrate scene.json -d 4        of rods that meet no other\n"
        "  shaken calibrate -d 4 --area-fraction 0.3 --precision 0.1 --plot noise.pdf\n"
        "                                   the paper's rods; rougher; and D_r against the noise\n"
        "D_r is that of rods of one species by themselves, on the plates of the scene. Where contacts with the plates "
        "do not slow rods that are alone, these keep turning and have no D_r; the command says so. Give "
        "--area-fraction then."};
  }

  void declare_options(Arguments& arguments) override {
    arguments.optional("SCENE", scene_, "A scene file; the paper's scene if left out", Names::kFile);
    arguments.repeatable("-d,--rotational-diffusion", "D",
                         "Rotational diffusion coefficient that the rods are to have, in rad^2/s; repeatable");
    arguments.repeatable("--of", "rods|rods_2|rods_3", "Of this species; of all if left out; repeatable");
    arguments.option("--area-fraction", "F",
                     "Area fraction at which rods of the species are among their like; alone if left out");
    arguments.option("--precision", "P", "Relative standard error of D_r, 0.05 if left out");
    arguments.option("--threads", "N", "Runs at a time; as many as there are cores if left out");
    arguments.option("--plot", "FILE", "Draw D_r against the noise: a .png, .pdf or .svg", Names::kFile);
    arguments.repeatable("-s,--set", settings_, "PATH=VALUE", "Change one value of the scene; repeatable",
                         Names::kSetting);
    arguments.flag("--json", "Print JSON, with every level of noise that was measured");
  }

  ExitCode run(const Context& context) override {
    const SceneInput input = scene_.empty() ? SceneInput{"the paper's scene", "{}"} : read_scene_input(scene_);
    const auto plan = scene::load_scene(input.text, input.file, settings_);
    if (!plan) throw Failure(ExitCode::kBadInput, refusal_text(plan.error()));
    Json species = Json::array();
    for (std::size_t number = 0; number < kMostSpecies; ++number) {
      if (plan->system.has_species(number)) species.push_back(species_json(*plan, number));
    }
    return go_on(context, "calibration", {"--species=" + species.dump()});
  }

 private:
  std::string scene_;
  std::vector<std::string> settings_;
};

}  // namespace

std::unique_ptr<Verb> make_calibrate() { return std::make_unique<Calibrate>(); }

}  // namespace shaken::client
