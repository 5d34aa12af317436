#include "tests/support/random_scenes.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "scene/load.h"
#include "sim/balance.h"
#include "tests/support/compare_steppers.h"
#include "tests/support/random_rods.h"

namespace shaken::test {
namespace {

using Json = nlohmann::ordered_json;

double to_digits(double value, int digits) {
  if (value == 0) return 0;
  const double scale = std::pow(10.0, digits - 1 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

/// Numbers with few digits, so that a case can be read.
class SceneDraw : public Draw {
 public:
  using Draw::Draw;
  bool chance(double p) { return uniform(0, 1) < p; }
  double plain(double low, double high) { return std::clamp(to_digits(uniform(low, high), 3), low, high); }
  double by_size(double low, double high) {
    return std::clamp(to_digits(low * std::pow(high / low, uniform(0, 1)), 3), low, high);
  }
  template <class T>
  T among(std::initializer_list<T> values) {
    return values.begin()[integer(0, static_cast<int>(values.size()) - 1)];
  }
};

Json draw_contact(SceneDraw& draw) {
  Json contact = Json::object();
  contact["restitution"] = draw.chance(0.5) ? draw.among({0.0, 0.3, 1.0, 0.05}) : draw.plain(0, 1);
  contact["friction"] = draw.chance(0.5) ? draw.among({0.0, 0.05, 1.0, 1000.0}) : draw.by_size(0.01, 3);
  return contact;
}

/// The thickest bead's diameter goes to `thickest`.
Json draw_shape(SceneDraw& draw, double size, double& thickest) {
  Json rods = Json::object();
  const double mid = draw.chance(0.4) ? 0.8 : std::clamp(to_digits(size * draw.plain(0.05, 1), 3), 0.05, 20.0);
  thickest = mid;
  switch (draw.integer(0, 9)) {
    case 0:  // a sphere
      rods["beads"] = 1;
      rods["mid_diameter"] = mid;
      return rods;
    case 1: {  // beads one by one
      const double length = std::clamp(to_digits(mid * draw.plain(1.5, 8), 3), 0.05, 50.0);
      const int n = std::clamp(static_cast<int>(std::ceil(length / (0.35 * mid))), 2, 101);
      Json diameters = Json::array();
      for (int b = 0; b < n; ++b) diameters.push_back(std::max(0.05, to_digits(mid * draw.plain(0.5, 1), 3)));
      diameters[static_cast<std::size_t>(draw.integer(0, n - 1))] = mid;
      rods["length"] = length;
      rods["bead_diameters"] = diameters;
      return rods;
    }
    default:
      break;
  }
  rods["length"] =
      draw.chance(0.5) ? draw.plain(2.5, 4.5) : std::clamp(to_digits(mid * draw.by_size(1.05, 30), 3), 0.05, 50.0);
  rods["mid_diameter"] = mid;
  const double end = std::max(0.05, to_digits(mid * (draw.chance(0.8) ? draw.plain(0.1, 1) : draw.plain(1, 1.5)), 3));
  rods["end_diameter"] = end;
  thickest = std::max(mid, end);
  if (draw.chance(0.2)) rods["profile"] = "polar";
  if (draw.chance(0.2)) {
    rods["beads"] = 2 * draw.integer(1, 50) + 1;
  } else {
    rods["bead_pitch"] = std::clamp(to_digits(0.4 * thickest, 3), 0.01, 10.0);
  }
  if (draw.chance(0.1)) rods["density"] = draw.by_size(0.001, 100);
  return rods;
}

Json draw_plates(SceneDraw& draw, Json& scene) {
  Json plates = Json::object();
  const double frequency = draw.chance(0.3)    ? draw.by_size(30, 100)
                           : draw.chance(0.8)  ? draw.by_size(30, 1000)
                           : draw.chance(0.95) ? draw.by_size(0.1, 30)
                                               : draw.by_size(1000, 20000);
  plates["frequency"] = frequency;
  if (draw.chance(0.06)) {
    scene["gravity"] = 0;
    plates["amplitude"] = draw.chance(0.3) ? 0.0 : draw.by_size(0.001, 0.5);
    if (draw.chance(0.4)) plates["base"] = false;
    if (draw.chance(0.4)) plates["lid"] = false;
  } else {
    plates["gamma"] = draw.chance(0.1) ? 0.0 : draw.plain(0, draw.chance(0.5) ? 10 : 30);
    if (draw.chance(0.1)) plates["lid"] = false;
    if (draw.chance(0.1)) scene["gravity"] = draw.by_size(100, 1e5);
  }
  if (draw.chance(0.15)) plates["noise"] = draw.by_size(0.001, 10);
  return plates;
}

void draw_walls(SceneDraw& draw, Json& scene) {
  if (!draw.chance(0.35)) return;
  const std::string arena = kArenaNames[static_cast<std::size_t>(draw.integer(0, kArenaNames.size() - 1))].first;
  Json& walls = scene["walls"] = draw_contact(draw);
  walls["arena"] = arena;
  if (arena == "annulus") walls["inner"] = draw.by_size(0.5, 10);
  if (arena == "stadium" && draw.chance(0.7)) walls["length"] = draw.chance(0.1) ? 0.0 : draw.by_size(0.1, 20);
  if ((arena == "ellipse" || arena == "wedge") && draw.chance(0.3)) walls["length"] = draw.by_size(4, 30);
  if (arena == "wedge" && draw.chance(0.6)) walls["narrow"] = draw.by_size(0.1, 10);
}

/// A step that plates of this frequency allow [us].
double draw_step(SceneDraw& draw, double frequency) {
  const double most = std::min(100.0, 1e6 / (20.0 * frequency));
  switch (draw.integer(0, 3)) {
    case 0:
      return std::min(most, draw.among({4.0, 16.0, 1.0}));
    case 1:
      return draw.by_size(0.1, most);
    default:
      return std::min(most, draw.plain(std::min(10.0, most), most));
  }
}

}  // namespace

Json SceneCase::to_json() const {
  Json json;
  json["scene"] = scene;
  json["ticks"] = ticks;
  json["stop"] = stop;
  if (begin != 0) json["begin"] = begin;
  if (threads != 1) json["threads"] = threads;
  if (drift != 0) json["drift"] = drift;
  if (heat != 0) json["heat"] = heat;
  if (spin != 0) json["spin"] = spin;
  return json;
}

SceneCase SceneCase::from_json(const Json& json) {
  SceneCase one;
  one.scene = json.at("scene");
  one.ticks = json.at("ticks").get<Tick>();
  one.stop = json.value("stop", one.ticks / 2);
  one.begin = json.value("begin", Tick{0});
  one.threads = json.value("threads", 1);
  one.drift = json.value("drift", 0.0);
  one.heat = json.value("heat", 0.0);
  one.spin = json.value("spin", 0.0);
  return one;
}

namespace {

/// Rods that ride on sticky plates at a low frequency, in touch with each other for long: beads of two rods then
/// approach or recede by next to nothing, while both move as fast as the plates.
void let_ride(SceneDraw& draw, Json& scene) {
  scene["plates"] = {{"frequency", draw.by_size(30, 70)}, {"gamma", draw.plain(2, 12)}};
  const Json sticky{{"restitution", 0}, {"friction", draw.by_size(0.1, 1000)}};
  scene["contacts"]["rod_base"] = scene["contacts"]["rod_lid"] = sticky;
  scene["contacts"]["rod_rod"]["restitution"] = draw.chance(0.6) ? 0.0 : draw.plain(0, 0.5);
  scene["time"]["step"] = std::to_string(draw.plain(20, 60)) + " us";
  scene["rods"]["area_fraction"] = draw.plain(0.3, 0.8);
}

/// Starts other than rows along x and random places, and boxes that are not square.
void draw_start_and_box(SceneDraw& draw, Json& scene) {
  const bool has_walls = scene.contains("walls");
  if ((!has_walls || scene["walls"]["arena"] == "channel") && draw.chance(0.25))
    scene["box"]["aspect"] = draw.by_size(0.2, 5);
  Json& rods = scene["rods"];
  if (rods.contains("start") || has_walls) return;
  const bool has_angle = draw.chance(0.3);
  if (!has_angle && draw.chance(0.25)) {
    rods["start"] = draw.among({"compressed", "polydomain", "defect_pair"});
    if (rods["start"] == "polydomain") rods["start_domains"] = draw.integer(1, 6);
  }
  if (has_angle || (rods.value("start", "") == "defect_pair" && draw.chance(0.5)))
    rods["start_angle"] = draw.plain(-90, 90);
}

/// Lattices of posts, and some at places of their own. Rods that do not fit among them are
/// drawn again.
void draw_posts(SceneDraw& draw, Json& scene) {
  if (!draw.chance(0.12) || scene["rods"].contains("start_angle")) return;
  Json& posts = scene["posts"] = draw_contact(draw);
  posts["diameter"] = draw.by_size(0.1, 3);
  if (draw.chance(0.7)) {
    posts["columns"] = draw.integer(1, 8);
    posts["rows"] = draw.integer(1, 8);
  } else {  // a row of posts that touch, or all but
    const double pitch = posts["diameter"].get<double>() * draw.among({1.0, 1.001, 1.2}), y = draw.plain(1, 6);
    const int n = draw.integer(1, 4);
    for (int k = 0; k < n; ++k) posts["places"].push_back({2.0 + k * pitch, y + (k % 2) * 0.3 * pitch});
  }
  const double fraction = std::min(scene["rods"]["area_fraction"].get<double>(), draw.plain(0.05, 0.4));
  scene["rods"]["area_fraction"] = fraction;
  if (!scene.contains("walls")) return;
  scene["rods"].erase("area_fraction");  // how large the arena is must be said
  scene["walls"]["size"] = draw.plain(6, 24);
}

/// Restitution that falls with speed, and species with contacts of their own.
void draw_contacts(SceneDraw& draw, Json& scene) {
  const auto of_kind = [&](Json& kind, const std::vector<std::string>& partners) {
    if (draw.chance(0.1)) kind["restitution_speed"] = draw.by_size(0.1, 1000);
    for (const std::string& name : partners) {
      if (draw.chance(0.6)) continue;
      const Json own = draw_contact(draw);
      if (draw.chance(0.7)) kind[name]["friction"] = own["friction"];
      if (draw.chance(0.7)) kind[name]["restitution"] = own["restitution"];
      if (draw.chance(0.2)) kind[name]["restitution_speed"] = draw.by_size(0.1, 1000);
    }
  };
  std::vector<std::string> species, pairs;
  if (scene.contains("rods_2")) species = {"rods_2"}, pairs = {"rods_rods_2", "rods_2_rods_2"};
  if (scene.contains("rods_3")) {
    species.emplace_back("rods_3");
    for (const char* pair : {"rods_rods_3", "rods_2_rods_3", "rods_3_rods_3"}) pairs.emplace_back(pair);
  }
  of_kind(scene["contacts"]["rod_rod"], pairs);
  of_kind(scene["contacts"]["rod_base"], species);
  of_kind(scene["contacts"]["rod_lid"], species);
  if (scene.contains("walls")) of_kind(scene["walls"], species);
  if (scene.contains("posts")) of_kind(scene["posts"], species);
}

/// Plates that do more than one vibration along z, and inclined ones.
void draw_plate_motion(SceneDraw& draw, Json& scene) {
  if (draw.chance(0.1) && !scene.contains("walls") && !scene.contains("posts")) {
    scene["plates"]["horizontal_amplitude"] = draw.by_size(0.001, 1);
    scene["plates"]["horizontal_phase"] = draw.plain(-180, 180);
    scene["plates"]["horizontal_angle"] = draw.plain(-180, 180);
  }
  const double frequency = scene["plates"]["frequency"].get<double>();
  if (draw.chance(0.1)) {
    scene["plates"]["second"] = {{"amplitude", draw.by_size(1e-4, 0.05)},
                                 {"frequency", to_digits(frequency * draw.plain(0.1, 1.0), 6)},
                                 {"phase", draw.plain(-180, 180)}};
  }
  if (draw.chance(0.1) && scene["plates"].value("lid", true)) {
    scene["plates"]["lid_motion"] = {{"amplitude", draw.chance(0.3) ? 0.0 : draw.by_size(1e-3, 0.1)},
                                     {"phase", draw.plain(-180, 180)}};
  }
  if (draw.chance(0.1)) {
    const bool is_flat = scene.contains("walls") || scene.contains("posts") || draw.chance(0.5);
    scene["plates"]["inclination"] = is_flat ? draw.plain(0.01, 1) : draw.plain(1, 90);
    scene["plates"]["inclination_angle"] = draw.plain(-180, 180);
  }
}

/// Rods that differ in size.
void draw_spread(SceneDraw& draw, Json& scene) {
  for (const char* name : {"rods", "rods_2", "rods_3"}) {
    if (!scene.contains(name) || !draw.chance(0.12)) continue;
    Json& rods = scene[name];
    rods["length_spread"] = draw.plain(0.01, 0.25);
    const bool has_profile = !rods.contains("bead_diameters") && !(rods.contains("beads") && rods["beads"] == 1);
    if (has_profile && draw.chance(0.5)) rods["end_diameter_spread"] = draw.plain(0.01, 0.25);
    if (!scene["rods"].contains("area_fraction")) continue;  // rows have room for the longest
    scene["rods"]["area_fraction"] = std::min(scene["rods"]["area_fraction"].get<double>(), draw.plain(0.05, 0.4));
  }
}

/// Species with noise of their own.
void draw_species_noise(SceneDraw& draw, Json& scene) {
  for (const char* name : {"rods_2", "rods_3"}) {
    if (!scene.contains(name) || !draw.chance(0.25)) continue;
    scene["plates"][name]["noise"] = draw.chance(0.3) ? 0.0 : draw.by_size(0.001, 10);
  }
}

}  // namespace

SceneCase draw_scene_case(std::uint64_t seed) {
  SceneDraw draw(seed);
  SceneCase one;
  Json& scene = one.scene;
  double thickest = 0;
  scene["rods"] = draw_shape(draw, 2.0, thickest);
  const bool random = draw.chance(0.25);
  const int most = draw.chance(0.8) ? 24 : 80;
  const int count = draw.integer(1, most);
  scene["rods"]["count"] = count;
  scene["rods"]["area_fraction"] = random ? draw.plain(0.05, 0.4) : draw.plain(0.2, 0.9);
  if (random) scene["rods"]["start"] = "random";
  for (const char* name : {"rods_2", "rods_3"}) {
    if (!draw.chance(0.12)) break;
    double its = 0;
    scene[name] = draw_shape(draw, 2.0, its);
    scene[name]["count"] = draw.integer(1, 12);
    scene["rods"]["area_fraction"] = draw.plain(0.05, 0.4);
    thickest = std::max(thickest, its);
  }
  draw_walls(draw, scene);
  const double room = draw.chance(0.7)   ? draw.plain(1.05, 2.5)
                      : draw.chance(0.8) ? draw.by_size(1.01, 1.05)
                                         : draw.by_size(2, 20);
  scene["box"]["gap"] = std::clamp(to_digits(thickest * room, 5), 0.05, 100.0);
  scene["plates"] = draw_plates(draw, scene);
  scene["contacts"]["rod_rod"] = draw_contact(draw);
  scene["contacts"]["rod_base"] = draw_contact(draw);
  scene["contacts"]["rod_lid"] = draw.chance(0.5) ? scene["contacts"]["rod_base"] : draw_contact(draw);
  scene["contacts"]["law"] = draw.among({"newton", "newton", "poisson", "energetic"});
  if (draw.chance(0.2)) scene["contacts"]["sweeps"] = draw.integer(1, 5);
  if (draw.chance(0.3)) scene["contacts"]["order"] = draw.among({"reversed", "shuffled"});
  const double frequency = scene["plates"]["frequency"].get<double>();
  const double step = draw_step(draw, frequency);
  scene["time"]["step"] = std::to_string(step) + " us";
  if (draw.chance(0.15)) scene["time"]["impacts"] = "at_instant";
  scene["time"]["seed"] = static_cast<std::int64_t>(seed % 1000000);
  scene["measure"] = Json::object();

  const bool rides = draw.chance(0.2);
  if (rides) let_ride(draw, scene);
  int n_rods = count;
  for (const char* name : {"rods_2", "rods_3"}) n_rods += scene.contains(name) ? scene[name]["count"].get<int>() : 0;
  const double rod_ticks = rides ? draw.by_size(1e5, 3e5) : draw.by_size(2e4, 1.5e5);
  one.ticks = std::clamp<Tick>(static_cast<Tick>(rod_ticks) / n_rods, 500, 20000);
  one.stop = draw.integer(1, static_cast<int>(one.ticks) - 1);
  if (draw.chance(0.15)) {
    const Tick border = Tick{1} << draw.among({31, 32, 33});
    one.begin = border - draw.integer(0, static_cast<int>(one.ticks));
  } else if (draw.chance(0.1)) {
    one.begin = static_cast<Tick>(draw.by_size(1, 1e11));
  }
  if (draw.chance(0.1)) one.threads = draw.among({2, 4});
  if (draw.chance(0.2)) one.drift = draw.by_size(1, 1000);
  if (draw.chance(0.2)) one.heat = draw.by_size(1, 1000);
  if (draw.chance(0.15)) one.spin = draw.by_size(1, 2000);
  draw_start_and_box(draw, scene);
  draw_posts(draw, scene);
  draw_contacts(draw, scene);
  draw_plate_motion(draw, scene);
  draw_spread(draw, scene);
  draw_species_noise(draw, scene);
  return one;
}

namespace {

/// The world that a case begins with.
Result<World> world_of(const SceneCase& one, const System& system) {
  const Result<Simulation> made = Simulation::start(system);
  if (!made) return made.error();
  World world = made->world();
  Tick later = one.begin;
  // plates are where they were; where there are two vibrations, at the start only
  if (system.has_second_vibration()) later = 0;
  if (const Tick period = world.plates.period_ticks(); period > 0) later -= later % period;
  world.tick += later;
  Draw draw(system.seed + 1);
  for (std::size_t i = 0; i < world.rods.size(); ++i) {
    Flight& rod = world.rods[i];
    rod.since += later;
    rod.velocity += one.drift * Vec3(0.6, 0.8, 0) + draw.vector(one.heat);
    rod.precession += draw.vector(one.spin);
    rod.prepare();
  }
  world.start = content(world);
  return world;
}

Compared compare_with_threads(const World& world, int n_threads, Tick ticks) {
  Simulation one = Simulation::start_from(world);
  Simulation several = Simulation::start_from(world);
  several.use_threads(n_threads, 1);
  const auto trouble = one.advance_to(world.tick + ticks);
  const auto its = several.advance_to(world.tick + ticks);
  const std::string where = " on " + std::to_string(n_threads) + " threads";
  if (trouble.has_value() != its.has_value() || (trouble && trouble->rods != its->rods))
    return {"other trouble" + where};
  if (one.tick() != several.tick() || one.state_hash() != several.state_hash()) return {"states differ" + where};
  if (!trouble && !same(one.world().counters, several.world().counters)) return {"counters differ" + where};
  return {"", true};
}

}  // namespace

CaseResult compare_steppers(const SceneCase& one) {
  CaseResult result;
  const auto plan = scene::load_scene(one.scene.dump(), "case");
  if (!plan) {
    result.problem = keys::to_string(plan.error());
    return result;
  }
  const Result<World> world = world_of(one, plan->system);
  if (!world) {
    result.problem = world.error().message;
    return result;
  }
  result.is_valid = true;
  const Compared compared = compare(*world, one.ticks, std::clamp<Tick>(one.stop, 1, one.ticks));
  result.difference = compared.difference;
  result.in_full = compared.in_full;
  result.rod_ticks = one.ticks * static_cast<Tick>(world->rods.size());
  constexpr Tick kMostOnThreads = 300;  // threads wait for each other in every tick
  if (result.difference.empty() && one.threads > 1)
    result.difference = compare_with_threads(*world, one.threads, std::min(one.ticks, kMostOnThreads)).difference;
  return result;
}

namespace {

/// Calls each(pointer) for every value within `json`, the outermost first.
void for_each_value(const Json& json, const Json::json_pointer& at, std::vector<Json::json_pointer>& all) {
  if (!at.empty()) all.push_back(at);
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) for_each_value(value, at / key, all);
}

}  // namespace

SceneCase shrink(SceneCase best, int tries) {
  const auto still_differs = [&](const SceneCase& candidate) {
    if (tries <= 0) return false;
    --tries;
    return !compare_steppers(candidate).difference.empty();
  };
  const auto try_it = [&](const SceneCase& candidate) {
    const bool better = still_differs(candidate);
    if (better) best = candidate;
    return better;
  };
  bool smaller = true;
  while (smaller && tries > 0) {
    smaller = false;
    for (const Tick part : {8, 4, 2}) {
      SceneCase shorter = best;
      shorter.ticks = std::max<Tick>(2, best.ticks / part);
      shorter.stop = std::clamp<Tick>(best.stop, 1, shorter.ticks - 1);
      if (shorter.ticks < best.ticks && try_it(shorter)) smaller = true;
    }
    for (double SceneCase::*extra : {&SceneCase::drift, &SceneCase::heat, &SceneCase::spin}) {
      SceneCase plainer = best;
      plainer.*extra = 0;
      if (best.*extra != 0 && try_it(plainer)) smaller = true;
    }
    SceneCase plainer = best;
    plainer.begin = 0;
    if (best.begin != 0 && try_it(plainer)) smaller = true;
    plainer = best;
    plainer.threads = 1;
    if (best.threads != 1 && try_it(plainer)) smaller = true;
    std::vector<Json::json_pointer> values;
    for_each_value(best.scene, Json::json_pointer{}, values);
    for (const auto& pointer : values) {
      if (!best.scene.contains(pointer)) continue;
      SceneCase without = best;
      without.scene.at(pointer.parent_pointer()).erase(pointer.back());
      const bool has_count = without.scene.contains(Json::json_pointer("/rods/count"));  // else it would be the paper's
      if (has_count && try_it(without)) {
        smaller = true;
        continue;
      }
      const Json& value = best.scene.at(pointer);
      if (value.is_number_integer() && value.get<std::int64_t>() > 1) {
        SceneCase fewer = best;
        fewer.scene.at(pointer) = value.get<std::int64_t>() / 2;
        if (try_it(fewer)) smaller = true;
      }
    }
  }
  return best;
}

}  // namespace shaken::test
