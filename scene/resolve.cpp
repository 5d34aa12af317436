// SPDX-License-Identifier: MIT
#include "scene/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "scene/accuracy.h"
#include "scene/derived.h"
#include "sim/rod/species.h"

namespace shaken::scene {

namespace {

constexpr double kAgreement = 1e-6;       // relative, of quantities given twice
constexpr double kLeastBoxLengths = 2.2;  // a rod must not meet two images of another; and some room for the lists
constexpr double kLeastTicksPerPeriod = 20;

bool agree(double a, double b) { return std::abs(a - b) <= kAgreement * std::max(std::abs(a), std::abs(b)); }

std::string length(double value) { return format_quantity(value, Dimension::kLength); }
std::string time(double value) { return format_quantity(value, Dimension::kTime); }

class Resolver {
 public:
  Resolver(const Draft& draft, std::vector<Problem>& problems) : draft_(draft), problems_(problems) {}

  std::optional<RunPlan> run() {
    const std::size_t n_before = problems_.size();
    bool all_ok = true;
    for (std::size_t i = 0; i < fields().size(); ++i) {
      const Given* given = draft_.find(i);
      all_ok = all_ok && (!given || given->ok);
      store(fields()[i], given);
    }
    accuracy();
    shape();
    shaking();
    packing();
    box();
    schedule();
    if (!all_ok || problems_.size() > n_before) return std::nullopt;
    return plan_;
  }

 private:
  using Paths = std::initializer_list<std::string_view>;

  void store(const Field& field, const Given* given) {
    const Value& value = given && given->ok ? given->value : field.fallback;
    if (!field.store || std::holds_alternative<std::monostate>(value) || !draft_.is_on(block_around(field.path)))
      return;
    field.store(plan_, value);
  }

  bool given(std::string_view path) const { return draft_.find(path) != nullptr; }

  /// The number given at `path`, or its default.
  double number(std::string_view path) const {
    const Given* found = draft_.find(path);
    return std::get<double>(found && found->ok ? found->value : field_at(path).fallback);
  }

  bool ok(Paths paths) const {
    return std::all_of(paths.begin(), paths.end(), [&](std::string_view path) { return draft_.is_ok(path); });
  }

  /// Reports a problem of several fields where the first of them that was given stands.
  void complain(Paths paths, std::string message) {
    for (const std::string_view path : paths) {
      if (const Given* found = draft_.find(path)) {
        problems_.push_back(problem_at(found->place, path, std::move(message)));
        return;
      }
    }
    problems_.push_back(problem_at(draft_.place(), *paths.begin(), std::move(message)));
  }

  /// Complains if what followed from `causes` lies outside of the field's range.
  void check_derived(std::string_view path, Paths causes) {
    const Field& field = field_at(path);
    const double value = std::get<double>(field.fetch(plan_));
    if (value >= field.low && value <= field.high) return;
    std::string said;
    for (const std::string_view cause : causes) {
      const Field& given_field = field_at(cause);
      said += fmt::format("{}{} {}", said.empty() ? "" : " and ", cause, show(given_field, given_field.fetch(plan_)));
    }
    complain(causes, fmt::format("{} make {} {}, outside {}", said, path, show(field, value),
                                 format_range(field.low, field.high, field.dimension)));
  }

  // The step that a word for accuracy stands for.
  void accuracy() {
    const Given* word = draft_.find("accuracy");
    if (!word || !ok({"accuracy", "time.step"})) return;
    const AccuracyLevel* level = accuracy_level(std::get<std::string>(word->value));
    if (given("time.step") && plan_.system.dt != level->step) {
      complain({"accuracy"}, fmt::format("accuracy \"{}\" is a time.step of {}, but time.step {} is given; remove one",
                                         level->name, time(level->step), time(plan_.system.dt)));
      return;
    }
    plan_.system.dt = level->step;
  }

  // The number of beads, and whether they make a rod.
  void shape() {
    RodShape& rod = plan_.system.rod;
    if (!ok({"rods.length", "rods.mid_diameter", "rods.end_diameter", "rods.beads", "rods.bead_pitch"})) return;
    if (given("rods.beads") && given("rods.bead_pitch")) {
      return complain({"rods.beads"}, "rods.beads and rods.bead_pitch are both given; remove one");
    }
    if (given("rods.beads") && rod.n_beads % 2 == 0) {
      return complain({"rods.beads"},
                      fmt::format("{} is even; a rod has a centre bead, so an odd number; did you mean {}?",
                                  rod.n_beads, rod.n_beads + 1));
    }
    if (given("rods.beads") && rod.n_beads == 1) {
      if (rod.length != rod.mid_diameter) {
        complain({"rods.length", "rods.beads"},
                 fmt::format("one bead is a sphere: rods.length ({}) must be rods.mid_diameter ({})",
                             length(rod.length), length(rod.mid_diameter)));
        return;
      }
      shape_ok_ = true;
      return;
    }
    const double thickest = std::max(rod.mid_diameter, rod.end_diameter);
    if (rod.length <= thickest) {
      complain({"rods.length", "rods.mid_diameter", "rods.end_diameter"},
               fmt::format("a rod of length {} is not longer than its thickest bead ({})", length(rod.length),
                           length(thickest)));
      return;
    }
    if (!given("rods.beads")) {
      const double pitch = number("rods.bead_pitch");
      if ((rod.length - rod.end_diameter) / pitch > kMaxBeads - 1) {
        complain({"rods.bead_pitch", "rods.length"}, fmt::format("beads every {} make more than {} on a rod of {}",
                                                                 length(pitch), kMaxBeads, length(rod.length)));
        return;
      }
      rod.n_beads = beads_for_pitch(rod.length, rod.end_diameter, pitch);
    }
    const auto touching = [](const RodShape& candidate) {
      const Species species = make_species(candidate);
      return species.bead_radius[0] + species.bead_radius[1] >= species.bead_offset[1] - species.bead_offset[0] &&
             species.max_radius * 2 >= species.bead_offset[1] - species.bead_offset[0];
    };
    if (rod.n_beads > 1 && !touching(rod)) {
      RodShape enough = rod;
      while (!touching(enough) && enough.n_beads < kMaxBeads) enough.n_beads += 2;
      complain({"rods.beads", "rods.bead_pitch", "rods.length"},
               fmt::format("{} beads leave holes between them on a rod of {}; take at least {}", rod.n_beads,
                           length(rod.length), enough.n_beads));
      return;
    }
    shape_ok_ = true;
  }

  // Gamma, amplitude and frequency.
  void shaking() {
    if (!ok({"plates.gamma", "plates.amplitude", "plates.frequency", "gravity"})) return;
    Scene& system = plan_.system;
    if (system.gravity == 0) return shaking_without_weight();
    const double gamma = number("plates.gamma");
    if (!given("plates.amplitude")) {
      system.amplitude = amplitude_for(gamma, system.frequency, system.gravity);
      check_derived("plates.amplitude", {"plates.gamma", "plates.frequency"});
    } else if (!given("plates.gamma")) {
      check_derived("plates.gamma", {"plates.amplitude", "plates.frequency"});
    } else if (!given("plates.frequency") && system.amplitude > 0 && gamma > 0) {
      system.frequency = frequency_for(gamma, system.amplitude, system.gravity);
      check_derived("plates.frequency", {"plates.gamma", "plates.amplitude"});
    } else if (!agree(*gamma_of(system), gamma)) {
      complain(
          {"plates.gamma"},
          fmt::format("plates.gamma {:.10g} contradicts plates.amplitude {} at plates.frequency {} and gravity {}, "
                      "which make {:.10g}; remove one",
                      gamma, length(system.amplitude), format_quantity(system.frequency, Dimension::kFrequency),
                      format_quantity(system.gravity, Dimension::kAcceleration), *gamma_of(system)));
    }
  }

  // Gamma compares the plates with gravity. Without it only Gamma = 0, plates at rest, means anything.
  void shaking_without_weight() {
    Scene& system = plan_.system;
    if (given("plates.gamma") && number("plates.gamma") != 0) {
      complain({"plates.gamma"},
               "plates.gamma compares the plates with gravity, which is 0; give plates.amplitude and plates.frequency "
               "instead");
    } else if (!given("plates.amplitude")) {
      system.amplitude = 0;
      if (given("plates.gamma")) return;
      complain({"gravity"},
               "without gravity plates.gamma has no meaning; give plates.amplitude (0: plates at rest) and "
               "plates.frequency");
    } else if (given("plates.gamma") && system.amplitude > 0) {
      complain({"plates.gamma"},
               fmt::format("plates.gamma 0 contradicts plates.amplitude {}; remove one", length(system.amplitude)));
    } else if (system.amplitude > 0 && !given("plates.frequency")) {
      complain({"gravity"},
               fmt::format("without gravity plates.amplitude {} does not tell plates.frequency; give that too",
                           length(system.amplitude)));
    }
  }

  // Number of rods, box and area fraction.
  void packing() {
    if (!shape_ok_ || !ok({"rods.area_fraction", "rods.count", "box.side"})) return;
    Scene& system = plan_.system;
    const double area = make_species(system.rod).area;
    const double wanted = number("rods.area_fraction");
    const auto count_for = [&] { return std::round(wanted * system.box_side * system.box_side / area); };

    if (!given("rods.count")) {
      const Field& field = field_at("rods.count");
      if (count_for() < field.low || count_for() > field.high) {
        complain({"rods.area_fraction", "box.side"},
                 fmt::format("rods.area_fraction {:.10g} and box.side {} make {} rods, outside [{:.10g}, {:.10g}]",
                             wanted, length(system.box_side), count_for(), field.low, field.high));
        return;
      }
      system.n_rods = static_cast<int>(count_for());
    } else if (given("rods.area_fraction") && !given("box.side")) {
      system.box_side = std::sqrt(system.n_rods * area / wanted);
      check_derived("box.side", {"rods.count", "rods.area_fraction"});
    } else if (given("rods.area_fraction") && count_for() != system.n_rods &&
               !agree(area_fraction_of(system), wanted)) {
      complain({"rods.area_fraction"},
               fmt::format("rods.area_fraction {:.10g} contradicts rods.count {} in box.side {}, which make {:.10g}; "
                           "remove one",
                           wanted, system.n_rods, length(system.box_side), area_fraction_of(system)));
      return;
    }
    const double fraction = area_fraction_of(system);
    const bool random = system.start == Start::kRandom;
    const double most = random ? kMaxAreaFractionRandom : kMaxAreaFractionAligned;
    if (draft_.is_ok("rods.start") && fraction > most) {
      complain({"rods.area_fraction", "rods.count", "box.side", "rods.start"},
               fmt::format("{} rods in a box of {} are an area fraction of {:.4g}; {} at most {} can be placed{}",
                           system.n_rods, length(system.box_side), fraction, random ? "at random" : "in rows", most,
                           random ? "; start \"aligned\" packs more" : ""));
    } else {
      check_derived("rods.area_fraction", {"rods.count", "box.side"});
    }
  }

  void box() {
    const Scene& system = plan_.system;
    if (shape_ok_ && ok({"box.side", "rods.count", "rods.area_fraction"}) &&
        system.box_side < kLeastBoxLengths * system.rod.length) {
      complain({"box.side", "rods.count", "rods.length"},
               fmt::format("a periodic box of {} is too small for rods of {}: at least {}", length(system.box_side),
                           length(system.rod.length), length(kLeastBoxLengths * system.rod.length)));
    }
    const double thickest = std::max(system.rod.mid_diameter, system.rod.end_diameter);
    if (ok({"box.gap", "rods.mid_diameter", "rods.end_diameter"}) && system.gap <= thickest) {
      complain({"box.gap", "rods.mid_diameter", "rods.end_diameter"},
               fmt::format("a gap of {} is too small for rods {} thick", length(system.gap), length(thickest)));
    }
  }

  // The tick against the vibration, and sampling against the tick.
  void schedule() {
    const Scene& system = plan_.system;
    if (!ok({"time.step"})) return;
    if (ok({"plates.frequency", "plates.gamma", "plates.amplitude"}) &&
        system.dt * system.frequency * kLeastTicksPerPeriod > 1) {
      complain({"time.step", "accuracy", "plates.frequency", "plates.amplitude"},
               fmt::format("a step of {} is too long for plates at {}: at most {}", time(system.dt),
                           format_quantity(system.frequency, Dimension::kFrequency),
                           time(1 / (kLeastTicksPerPeriod * system.frequency))));
    }
    for (const Field& field : fields()) {
      const std::string_view block = block_around(field.path);
      const bool is_interval = field.form == Form::kQuantity && field.dimension == Dimension::kTime && !block.empty();
      if (!is_interval || !draft_.is_on(block) || !draft_.is_ok(field.path)) continue;
      const double every = std::get<double>(field.fetch(plan_));
      if (every < system.dt) {
        complain({field.path, "time.step", "accuracy"},
                 fmt::format("{} {} is shorter than time.step {}", field.path, time(every), time(system.dt)));
      }
    }
    if (plan_.defects && ok({"rods.length", "measure.defects.smoothing", "measure.defects.grid"})) {
      if (!given("measure.defects.smoothing")) plan_.defects->smoothing = plan_.system.rod.length / 2;
      if (!given("measure.defects.grid")) plan_.defects->grid = plan_.system.rod.length / 8;
    }
  }

  const Draft& draft_;
  std::vector<Problem>& problems_;
  RunPlan plan_;
  bool shape_ok_ = false;
};

}  // namespace

std::optional<RunPlan> resolve(const Draft& draft, std::vector<Problem>& problems) {
  return Resolver(draft, problems).run();
}

}  // namespace shaken::scene
