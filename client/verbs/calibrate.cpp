// SPDX-License-Identifier: MIT
// `shaken calibrate`: the scene of each species by itself, from which the Python package finds its noise
// (python/shaken/calibration/app.py).
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <span>
#include <utility>

#include "base/paths.h"
#include "base/plots_by_python.h"
#include "base/process.h"
#include "client/scene_input.h"
#include "client/verbs/verbs.h"
#include "scene/canonical.h"
#include "scene/derived.h"
#include "scene/load.h"
#include "scene/rods_of_species.h"

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

class Calibrate : public Verb {
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

  void declare(Arguments& arguments) override {
    arguments.optional("SCENE", scene_, "A scene file; the paper's scene if left out", Names::kFile);
    arguments.repeatable("-d,--rotational-diffusion", wanted_, "D",
                         "Rotational diffusion coefficient that the rods are to have, in rad^2/s; repeatable");
    arguments.repeatable("--of", of_, "rods|rods_2|rods_3", "Of this species; of all if left out; repeatable");
    arguments.option("--area-fraction", area_fraction_, "F",
                     "Area fraction at which rods of the species are among their like; alone if left out");
    arguments.option("--precision", precision_, "P", "Relative standard error of D_r, 0.05 if left out");
    arguments.option("--threads", threads_, "N", "Runs at a time; as many as there are cores if left out");
    arguments.option("--plot", plot_, "FILE", "Draw D_r against the noise: a .png, .pdf or .svg", Names::kFile);
    arguments.repeatable("-s,--set", settings_, "PATH=VALUE", "Change one value of the scene; repeatable",
                         Names::kSetting);
    arguments.flag("--json", json_, "Print JSON, with every level of noise that was measured");
  }

  ExitCode run(const Context&) override {
    const SceneInput input = scene_.empty() ? SceneInput{"the paper's scene", "{}"} : read_scene_input(scene_);
    const auto plan = scene::load_scene(input.text, input.file, settings_);
    if (!plan) throw Failure(ExitCode::kBadInput, refusal_text(plan.error()));
    Json species = Json::array();
    for (std::size_t number = 0; number < kMostSpecies; ++number) {
      if (plan->system.has_species(number)) species.push_back(species_json(*plan, number));
    }
    std::vector<std::string> command = python_command("calibration");
    command.push_back("--species=" + species.dump());
    for (const std::string& wanted : wanted_) command.push_back("--rotational-diffusion=" + wanted);
    for (const std::string& name : of_) command.push_back("--of=" + name);
    if (area_fraction_) command.push_back(fmt::format("--area-fraction={}", *area_fraction_));
    if (precision_) command.push_back(fmt::format("--precision={}", *precision_));
    if (threads_) command.push_back(fmt::format("--threads={}", *threads_));
    if (!plot_.empty()) command.push_back("--plot=" + plot_);
    if (json_) command.emplace_back("--json");
    setenv("SHAKEN_PROGRAM", sibling_program("shaken").c_str(), 1);
    become(command);
  }

 private:
  std::vector<std::string> wanted_, of_, settings_;
  std::string scene_, plot_;
  std::optional<double> area_fraction_, precision_;
  std::optional<int> threads_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_calibrate() { return std::make_unique<Calibrate>(); }

}  // namespace shaken::client
