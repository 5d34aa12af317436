// SPDX-License-Identifier: MIT
#include "scene/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/accuracy.h"
#include "scene/derived.h"
#include "scene/observables.h"
#include "sim/rod/species.h"

namespace shaken::scene {

namespace {

constexpr double kAgreement = 1e-6;      // relative, of quantities given twice
constexpr double kRoomRoundArena = 0.2;  // [mm]
constexpr double kLeastTicksPerPeriod = 20;
constexpr double kDeepestOverlap = 0.5;  // of a bead's radius, beyond which a run ends

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
    shapes();
    const std::size_t n_before_shaking = problems_.size();
    shaking();
    shaking_ok_ = problems_.size() == n_before_shaking;
    if (arena()) packing();
    box();
    gap();
    schedule();
    periodic();
    if (!all_ok || problems_.size() > n_before) return std::nullopt;
    return plan_;
  }

 private:
  using Paths = std::vector<std::string>;

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

  bool ok(const Paths& paths) const {
    return std::all_of(paths.begin(), paths.end(), [&](const std::string& path) { return draft_.is_ok(path); });
  }

  /// Reports a problem of several fields where the first of them that was given stands.
  void report(const Paths& paths, std::string message) {
    for (const std::string& path : paths) {
      if (const Given* found = draft_.find(path)) {
        problems_.push_back(problem_at(found->place, path, std::move(message)));
        return;
      }
    }
    problems_.push_back(problem_at(draft_.place(), paths.front(), std::move(message)));
  }

  /// Complains if what followed from `causes` lies outside of the field's range.
  void check_derived(std::string_view path, const Paths& causes) {
    const Field& field = field_at(path);
    const double value = std::get<double>(field.fetch(plan_));
    if (value >= field.low && value <= field.high) return;
    std::string said;
    for (const std::string& cause : causes) {
      const Field& given_field = field_at(cause);
      said += fmt::format("{}{} {}", said.empty() ? "" : " and ", cause, show(given_field, given_field.fetch(plan_)));
    }
    report(causes, fmt::format("{} make {} {}, outside {}", said, path, show(field, value),
                               format_range(field.low, field.high, field.dimension)));
  }

  // The step that a word for accuracy stands for.
  void accuracy() {
    const Given* word = draft_.find("accuracy");
    if (!word || !ok({"accuracy", "time.step"})) return;
    const AccuracyLevel* level = accuracy_level(std::get<std::string>(word->value));
    if (given("time.step") && plan_.system.dt != level->step) {
      report({"accuracy"}, fmt::format("accuracy \"{}\" is a time.step of {}, but time.step {} is given; remove one",
                                       level->name, time(level->step), time(plan_.system.dt)));
      return;
    }
    plan_.system.dt = level->step;
  }

  /// Every species that is there: the name of its group, its shape and number.
  struct Kind {
    std::string name;
    RodShape& rod;
    int& count;
    std::string path(const char* key) const { return name + "." + key; }
  };
  std::vector<Kind> kinds() {
    std::vector<Kind> all{{"rods", plan_.system.rod, plan_.system.n_rods}};
    for (std::size_t k = 0; k < plan_.system.added.size(); ++k) {
      if (auto& added = plan_.system.added[k]) all.push_back({fmt::format("rods_{}", k + 2), added->rod, added->count});
    }
    return all;
  }

  // The number of beads, and whether they make a rod.
  void shapes() {
    shapes_ok_ = true;
    for (const Kind& kind : kinds()) shapes_ok_ = shape(kind) && shapes_ok_;
  }

  bool shape(const Kind& kind) {
    RodShape& rod = kind.rod;
    const std::string length_path = kind.path("length"), mid = kind.path("mid_diameter"),
                      end = kind.path("end_diameter"), beads = kind.path("beads"), pitch_path = kind.path("bead_pitch"),
                      list = kind.path("bead_diameters");
    if (!ok({length_path, mid, end, beads, pitch_path, list})) return false;
    if (!rod.bead_diameters.empty()) return free_shape(kind);
    if (given(beads) && given(pitch_path)) {
      report({beads}, fmt::format("{} and {} are both given; remove one", beads, pitch_path));
      return false;
    }
    if (given(beads) && rod.n_beads % 2 == 0) {
      report({beads}, fmt::format("{} is even; a rod has a centre bead, so an odd number; did you mean {}?",
                                  rod.n_beads, rod.n_beads + 1));
      return false;
    }
    if (given(beads) && rod.n_beads == 1) {
      if (!given(length_path)) rod.length = rod.mid_diameter;
      if (rod.length == rod.mid_diameter) return true;
      report({length_path, beads}, fmt::format("one bead is a sphere: {} ({}) must be {} ({})", length_path,
                                               length(rod.length), mid, length(rod.mid_diameter)));
      return false;
    }
    const double thickest = std::max(rod.mid_diameter, rod.end_diameter);
    if (rod.length <= thickest) {
      report({length_path, mid, end}, fmt::format("a rod of length {} is not longer than its thickest bead ({})",
                                                  length(rod.length), length(thickest)));
      return false;
    }
    if (!given(beads)) {
      const double pitch = number(pitch_path);
      if ((rod.length - rod.end_diameter) / pitch > kMaxBeads - 1) {
        report({pitch_path, length_path}, fmt::format("beads every {} make more than {} on a rod of {}", length(pitch),
                                                      kMaxBeads, length(rod.length)));
        return false;
      }
      rod.n_beads = beads_for_pitch(rod.length, rod.end_diameter, pitch);
    }
    if (rod.n_beads > 1 && !touching(rod)) {
      RodShape enough = rod;
      while (!touching(enough) && enough.n_beads < kMaxBeads) enough.n_beads += 2;
      report({beads, pitch_path, length_path},
             fmt::format("{} beads leave holes between them on a rod of {}; take at least {}", rod.n_beads,
                         length(rod.length), enough.n_beads));
      return false;
    }
    return true;
  }

  static bool touching(const RodShape& candidate) {
    const Species species = make_species(candidate);
    for (int b = 0; b + 1 < species.n_beads(); ++b) {
      if (species.bead_radius[b] + species.bead_radius[b + 1] < species.pitch()) return false;
    }
    return true;
  }

  // Beads one by one: what the other keys say of them follows.
  bool free_shape(const Kind& kind) {
    RodShape& rod = kind.rod;
    const std::vector<double>& diameters = rod.bead_diameters;
    const std::string list = kind.path("bead_diameters");
    const auto n = static_cast<int>(diameters.size());
    const double thickest = *std::max_element(diameters.begin(), diameters.end());
    bool fine = true;
    const auto follows = [&](const char* key, double value) {
      if (given(kind.path(key)) && number(kind.path(key)) != value) {
        report({kind.path(key)},
               fmt::format("{} follows from {}, which makes it {:.10g}; remove it", kind.path(key), list, value));
        fine = false;
      }
      return value;
    };
    if (n > kMaxBeads) {
      report({list}, fmt::format("{} beads are more than {}", n, kMaxBeads));
      return false;
    }
    rod.n_beads = static_cast<int>(follows("beads", n));
    rod.mid_diameter = follows("mid_diameter", thickest);
    rod.end_diameter = follows("end_diameter", diameters.back());
    for (const char* key : {"profile", "bead_pitch"}) {
      if (!given(kind.path(key))) continue;
      report({kind.path(key)}, fmt::format("{} and {} are both given; remove one", list, kind.path(key)));
      fine = false;
    }
    if (n == 1) rod.length = follows("length", thickest);
    if (!fine) return false;
    if (n > 1 && rod.length <= thickest) {
      report({kind.path("length"), list}, fmt::format("a rod of length {} is not longer than its thickest bead ({})",
                                                      length(rod.length), length(thickest)));
      return false;
    }
    const double pitch = n > 1 ? (rod.length - 0.5 * (diameters.front() + diameters.back())) / (n - 1) : 0.0;
    for (int b = 0; b < n; ++b) {
      const double center = 0.5 * diameters.front() + b * pitch;
      const double radius = 0.5 * diameters[static_cast<std::size_t>(b)];
      if (center - radius >= -1e-9 && center + radius <= rod.length + 1e-9) continue;
      report({list, kind.path("length")},
             fmt::format("bead {} of {} would stick out beyond the tips of a rod of {}", b + 1,
                         length(diameters[static_cast<std::size_t>(b)]), length(rod.length)));
      return false;
    }
    if (!touching(rod)) {
      report({list}, fmt::format("{} beads of these diameters leave holes between them on a rod of {}; give more", n,
                                 length(rod.length)));
      return false;
    }
    return true;
  }

  // Gamma, amplitude and frequency.
  void shaking() {
    if (!ok({"plates.gamma", "plates.amplitude", "plates.frequency", "gravity"})) return;
    System& system = plan_.system;
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
      report({"plates.gamma"},
             fmt::format("plates.gamma {:.10g} contradicts plates.amplitude {} at plates.frequency {} and gravity {}, "
                         "which make {:.10g}; remove one",
                         gamma, length(system.amplitude), format_quantity(system.frequency, Dimension::kFrequency),
                         format_quantity(system.gravity, Dimension::kAcceleration), *gamma_of(system)));
    }
  }

  // Gamma compares the plates with gravity. Without it only Gamma = 0, plates at rest, means anything.
  void shaking_without_weight() {
    System& system = plan_.system;
    if (given("plates.gamma") && number("plates.gamma") != 0) {
      report({"plates.gamma"},
             "plates.gamma compares the plates with gravity, which is 0; give plates.amplitude and plates.frequency "
             "instead");
    } else if (!given("plates.amplitude")) {
      system.amplitude = 0;
      if (given("plates.gamma")) return;
      report({"gravity"},
             "without gravity plates.gamma has no meaning; give plates.amplitude (0: plates at rest) and "
             "plates.frequency");
    } else if (given("plates.gamma") && system.amplitude > 0) {
      report({"plates.gamma"},
             fmt::format("plates.gamma 0 contradicts plates.amplitude {}; remove one", length(system.amplitude)));
    } else if (system.amplitude > 0 && !given("plates.frequency")) {
      report({"gravity"},
             fmt::format("without gravity plates.amplitude {} does not tell plates.frequency; give that too",
                         length(system.amplitude)));
    }
  }

  // Arena and box fit into each other; false where they do not, or cannot be told.
  bool arena() {
    System& system = plan_.system;
    if (!ok({"walls.size", "walls.inner", "walls.arena", "box.side"}) || !shapes_ok_) return false;
    if (!system.walls) return true;
    double thickest = 0;
    double longest = 0;
    for (const Kind& kind : kinds()) {
      thickest = std::max(thickest, 2.0 * make_species(kind.rod).max_radius);
      longest = std::max(longest, kind.rod.length);
    }
    const double room = thickest + kRoomRoundArena;  // so that rods do not meet through the periodic border
    SideWalls& walls = *system.walls;
    const std::size_t n_before = problems_.size();
    if (given("walls.inner") && walls.arena != Arena::kAnnulus) {
      const Field& arena = field_at("walls.arena");
      report({"walls.inner"}, fmt::format("only an annulus has an inner wall, and walls.arena is {}; remove "
                                          "walls.inner, or set walls.arena to \"annulus\"",
                                          show(arena, arena.fetch(plan_))));
    }
    if (!given("walls.size") && !given("box.side") && given("rods.count") && given("rods.area_fraction")) {
      if (!ok({"rods.count", "rods.area_fraction"})) return false;
      walls.size = arena_size_for(walls, system.n_rods * make_species(system.rod).area / number("rods.area_fraction"));
      check_derived("walls.size", {"rods.count", "rods.area_fraction"});
    } else if (!given("walls.size")) {
      walls.size = system.box_side - room;
      check_derived("walls.size", {"box.side"});
    }
    if (!given("box.side")) {
      system.box_side = walls.size + room;
      check_derived("box.side", {"walls.size"});
    }
    if (system.box_side < walls.size + room * (1 - 1e-12)) {
      report({"walls.size", "box.side"},
             fmt::format("an arena of {} does not fit into a box of {}: at most {}; or leave box.side out",
                         length(walls.size), length(system.box_side), length(system.box_side - room)));
    } else if (walls.arena == Arena::kAnnulus && walls.inner >= walls.size) {
      report({"walls.inner", "walls.size"},
             fmt::format("an inner wall of {} does not fit into an outer one of {}, {}", length(walls.inner),
                         length(walls.size), given("walls.size") ? "walls.size" : "as large as box.side allows"));
    } else if (walls.arena == Arena::kAnnulus && walls.size - walls.inner < 2.0 * longest) {
      report({"walls.inner", "walls.size"},
             fmt::format("an annulus from {} to {} leaves no room for rods of {} to turn: its walls must be a rod "
                         "length apart",
                         length(walls.inner), length(walls.size), length(longest)));
    }
    return problems_.size() == n_before;
  }

  /// What sets the area that the rods share, as it was written: "box.side 40 mm".
  std::string room_for_rods() const {
    const System& system = plan_.system;
    std::string box = "box.side " + length(system.box_side);
    if (!system.walls) return box;
    if (given("walls.size")) return "walls.size " + length(system.walls->size);
    return fmt::format("{} (an arena of {})", box, length(system.walls->size));
  }

  // Number of rods, box and area fraction.
  void packing() {
    for (const Kind& kind : kinds()) {
      if (!ok({kind.path("area_fraction"), kind.path("count")}) || !numbers_of(kind)) return;
    }
    System& system = plan_.system;
    double fraction = 0;
    Paths causes;
    std::string all;
    for (const Kind& kind : kinds()) {
      fraction += area_fraction_of(system, kind.rod, kind.count);
      causes.push_back(kind.path("area_fraction"));
      causes.push_back(kind.path("count"));
    }
    causes.insert(causes.end(), {"walls.size", "box.side", "rods.start"});
    const bool random = system.start == Start::kRandom;
    const double most = random ? kMaxAreaFractionRandom : kMaxAreaFractionAligned;
    if (draft_.is_ok("rods.start") && fraction > most) {
      report(causes,
             fmt::format("{} rods in {} of {} are an area fraction of {:.4g}; {} at most {} can be placed{}",
                         system.n_all_rods(), system.walls ? "an arena" : "a box",
                         length(system.walls ? system.walls->size : system.box_side), fraction,
                         random ? "at random" : "in rows", most, random ? "; start \"aligned\" packs more" : ""));
    } else {
      for (const Kind& kind : kinds()) {
        check_derived(kind.path("area_fraction"),
                      {kind.path("count"), given("walls.size") ? "walls.size" : "box.side"});
      }
    }
  }

  /// Number and area fraction of one species; false after a complaint.
  bool numbers_of(const Kind& kind) {
    System& system = plan_.system;
    const std::string fraction_path = kind.path("area_fraction"), count_path = kind.path("count");
    const bool is_first = kind.name == "rods";
    const double area = make_species(kind.rod).area;
    if (!is_first && !given(count_path) && !given(fraction_path)) {
      report({kind.name, fraction_path}, fmt::format("how many rods? Give {} or {}", count_path, fraction_path));
      return false;
    }
    const double wanted = given(fraction_path) || is_first ? number(fraction_path) : 0.0;
    const auto count_for = [&] { return std::round(wanted * area_for_rods(system) / area); };
    if (!given(count_path)) {
      const Field& field = field_at(count_path);
      if (count_for() < field.low || count_for() > field.high) {
        report({fraction_path, "walls.size", "box.side"},
               fmt::format("{} {:.10g} and {} make {} rods, outside [{:.10g}, {:.10g}]", fraction_path, wanted,
                           room_for_rods(), count_for(), field.low, field.high));
        return false;
      }
      kind.count = static_cast<int>(count_for());
    } else if (is_first && given(fraction_path) && !given("box.side") && !system.walls) {
      system.box_side = std::sqrt(kind.count * area / wanted);
      check_derived("box.side", {"rods.count", "rods.area_fraction"});
    } else if (given(fraction_path) && count_for() != kind.count &&
               !agree(area_fraction_of(system, kind.rod, kind.count), wanted)) {
      report({fraction_path},
             fmt::format("{} {:.10g} contradicts {} {} in {}, which make {:.10g}; remove one", fraction_path, wanted,
                         count_path, kind.count, room_for_rods(), area_fraction_of(system, kind.rod, kind.count)));
      return false;
    }
    return true;
  }

  void box() {
    const System& system = plan_.system;
    if (!shapes_ok_) return;
    for (const Kind& kind : kinds()) {
      const Species species = make_species(kind.rod);
      const double least = least_box_side(std::span(&species, 1));
      if (ok({"box.side", kind.path("count"), kind.path("area_fraction")}) && system.box_side < least * (1.0 - 1e-9)) {
        report({"box.side", "walls.size", kind.path("count"), kind.path("length")},
               fmt::format("a periodic box of {} is too small for rods of {}: at least {}", length(system.box_side),
                           length(kind.rod.length), length(least)));
      }
    }
  }

  void gap() {
    const System& system = plan_.system;
    for (const Kind& kind : kinds()) {
      const Paths diameters{kind.path("mid_diameter"), kind.path("end_diameter"), kind.path("bead_diameters")};
      const double thickest = kind.rod.bead_diameters.empty()
                                  ? std::max(kind.rod.mid_diameter, kind.rod.end_diameter)
                                  : *std::max_element(kind.rod.bead_diameters.begin(), kind.rod.bead_diameters.end());
      if (!ok({"box.gap"}) || !ok(diameters) || system.gap > thickest) continue;
      report({"box.gap", diameters[0], diameters[1], diameters[2]},
             fmt::format("a gap of {} is too small for rods {} thick", length(system.gap), length(thickest)));
    }
    if (!system.base && system.gravity > 0 && ok({"plates.base", "gravity"})) {
      report({"plates.base", "gravity"}, "without a base rods fall out of sight: set gravity to 0");
    }
  }

  // The tick against the vibration, and sampling against the tick.
  void schedule() {
    const System& system = plan_.system;
    if (!ok({"time.step"})) return;
    const bool shaking_given = ok({"plates.frequency", "plates.gamma", "plates.amplitude"});
    if (shaking_given && system.dt * system.frequency * kLeastTicksPerPeriod > 1) {
      report({"time.step", "accuracy", "plates.frequency", "plates.amplitude"},
             fmt::format("a step of {} is too long for plates at {}: at most {}", time(system.dt),
                         format_quantity(system.frequency, Dimension::kFrequency),
                         time(1 / (kLeastTicksPerPeriod * system.frequency))));
    } else if (shaking_given && ok({"gravity"}) && shaking_ok_ && shapes_ok_) {
      plates_in_a_tick();
    }
    for (const Field& field : fields()) {
      const std::string_view block = block_around(field.path);
      const bool is_interval = field.form == Form::kQuantity && field.dimension == Dimension::kTime && !block.empty();
      if (!is_interval || !draft_.is_on(block) || !draft_.is_ok(field.path)) continue;
      const double every = std::get<double>(field.fetch(plan_));
      if (every < system.dt) {
        report({field.path, "time.step", "accuracy"},
               fmt::format("{} {} is shorter than time.step {}", field.path, time(every), time(system.dt)));
      }
    }
    if (plan_.velocity && ok({"measure.velocity.every", "measure.velocity.window"}) &&
        plan_.velocity->window < plan_.velocity->every) {
      report({"measure.velocity.window", "measure.velocity.every"},
             fmt::format("measure.velocity.window {} is shorter than measure.velocity.every {}",
                         time(plan_.velocity->window), time(plan_.velocity->every)));
    }
    if (plan_.defects && ok({"rods.length", "measure.defects.smoothing", "measure.defects.grid"})) {
      plan_.defects->smoothing = plan_.defects->smoothing_for(plan_.system.rod.length);
      plan_.defects->grid = plan_.defects->grid_for(plan_.system.rod.length);
    }
    if (plan_.pairs && ok({"rods.length", "box.side", "measure.pairs.range"})) {
      const double half_box = plan_.system.box_side / 2;
      plan_.pairs->range = plan_.pairs->range_for(plan_.system.rod.length, plan_.system.box_side);
      if (plan_.pairs->range > half_box * (1 + 1e-12)) {
        report(
            {"measure.pairs.range", "box.side"},
            fmt::format("a map of {} each way reaches beyond half the box, {}: distances have no nearest image there",
                        length(plan_.pairs->range), length(half_box)));
      }
    }
  }

  // Plates that go deeper into a rod within a tick than any overlap may be: a run must sooner or later meet that
  // (kMaxOverlapFraction in sim/stepping/tick.h).
  void plates_in_a_tick() {
    const System& system = plan_.system;
    if (!system.base && !system.lid) return;
    const double speed = peak_speed_of(system);
    double thinnest = INFINITY;
    for (const Kind& kind : kinds()) {
      const Species species = make_species(kind.rod);
      thinnest = std::min(thinnest, *std::min_element(species.bead_radius.begin(), species.bead_radius.end()));
    }
    const double deepest = kDeepestOverlap * thinnest;
    if (speed * system.dt <= deepest) return;
    report({"time.step", "accuracy", "plates.gamma", "plates.amplitude", "plates.frequency"},
           fmt::format("plates as fast as {:.4g} mm/s move further in a step of {} than half the radius of the "
                       "thinnest bead, {}, the deepest overlap there may be: the run would end in numerical "
                       "trouble; take a step of at most {}, or shake less",
                       speed, time(system.dt), length(deepest), time(deepest / speed)));
  }

  // What is only there without walls.
  void periodic() {
    if (!plan_.system.walls) return;
    for (const Observable& observable : observables()) {
      const std::string& block = observable.block.path;
      if (observable.within_walls() || !draft_.is_on(block)) continue;
      report({block, "walls"},
             fmt::format("{} is of {} of a periodic box: walls leave none", block, observable.periodic));
    }
  }

  const Draft& draft_;
  std::vector<Problem>& problems_;
  RunPlan plan_;
  bool shapes_ok_ = false;
  bool shaking_ok_ = false;
};

}  // namespace

std::optional<RunPlan> resolve(const Draft& draft, std::vector<Problem>& problems) {
  return Resolver(draft, problems).run();
}

}  // namespace shaken::scene
