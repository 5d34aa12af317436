#include "sim/start/from_another_run.h"

#include <cmath>
#include <cstdio>
#include <tuple>

#include "base/core/check.h"
#include "base/core/rng.h"
#include "sim/balance.h"

namespace shaken {
namespace {

constexpr double kKick = 1e-6;  ///< of a velocity, that sets replicas from one state apart
constexpr SecondVibration kNoSecond{0, 0, 0};

}  // namespace

std::string start_mismatch(const System& system, const System& other) {
  std::string all;
  const auto compare = [&](bool is_same, const char* what) {
    if (!is_same) all += std::string(all.empty() ? "" : ", ") + what;
  };
  const auto arena_of = [](const System& one) {
    const SideWalls walls = one.walls.value_or(SideWalls{});
    return std::tuple(one.walls.has_value(), walls.arena, walls.size, walls.inner, walls.length, walls.narrow);
  };
  compare(system.rod == other.rod && system.added == other.added, "the rods");
  compare(system.n_rods == other.n_rods, "their number");
  compare(system.box_aspect == other.box_aspect, "the shape of the box");
  compare(system.base == other.base && system.lid == other.lid, "the plates that are there");
  // a lid that is elsewhere at the start might come down on rods
  const auto lid_of = [](const System& one) {
    return one.has_lid_motion() ? std::tuple(true, *one.lid_motion, one.amplitude, one.second.value_or(kNoSecond))
                                : std::tuple(false, LidMotion{}, 0.0, kNoSecond);
  };
  compare(lid_of(system) == lid_of(other), "how the lid moves");
  compare(arena_of(system) == arena_of(other), "the walls");
  compare(standing_posts(system) == standing_posts(other), "the posts");
  if ((system.walls && other.walls) || (system.posts && other.posts)) {
    compare(system.box_side == other.box_side, "the side of the box");
    compare(system.gap == other.gap, "the gap");
  }
  return all;
}

double off_the_beat(const System& system, Tick tick) {
  if (!system.has_moving_plates()) return 0;
  const double time = static_cast<double>(tick) * system.dt;
  const auto off = [&](bool moves, double frequency) {
    return moves && frequency > 0 ? time - std::round(time * frequency) / frequency : 0.0;
  };
  const bool first_moves = system.amplitude > 0 || system.horizontal_amplitude > 0 || system.has_lid_motion();
  const double first = off(first_moves, system.frequency);
  if (!system.has_second_vibration()) return first;
  const double second = off(true, system.second->frequency);
  return std::abs(second) > std::abs(first) ? second : first;
}

std::string nearest_beat(const System& system, Tick tick) {
  const auto text = [](const char* words, double first, double second) {
    char line[120];
    std::snprintf(line, sizeof line, words, first, second);
    return std::string(line);
  };
  if (system.has_second_vibration())
    return text("both vibrations, of %.10g and %.10g Hz, must be whole ones there", system.frequency,
                system.second->frequency);
  return text("the nearest whole one is at %.10g s", static_cast<double>(tick) * system.dt - off_the_beat(system, tick),
              0);
}

bool is_resized(const System& system, const System& other) {
  return system.box_side != other.box_side || system.gap != other.gap;
}

Result<void> check_left(const System& system, const World& left) {
  if (const std::string differs = start_mismatch(system, left.system); !differs.empty()) {
    return Error{"not the same as where the rods come from: " + differs};
  }
  const double off = off_the_beat(left.system, left.tick);
  if (std::abs(off) <= 0.5 * left.system.dt * (1 + 1e-6)) return {};
  const double now = static_cast<double>(left.tick) * left.system.dt;
  return Error{"its plates are in the middle of a vibration at " + std::to_string(now) + " s and would jump; " +
               nearest_beat(left.system, left.tick)};
}

RodsLeft rods_left(const World& world, const World& left) {
  RodsLeft rods;
  rods.poses.reserve(left.rods.size());
  rods.motions.reserve(left.rods.size());
  std::vector<std::size_t> next(world.species.size(), 0);  // of each shape, where to look for its next rod
  for (const std::uint8_t kind : world.shape_of_rod) {
    std::size_t& from = next[kind];
    while (left.shape_of_rod[from] != kind) ++from;
    const PoseAndMotion rod = rod_at(left, from++, left.tick);
    rods.poses.push_back(rod.pose);
    rods.motions.push_back(rod.motion);
  }
  return rods;
}

Result<World> make_world(const System& system, const World& left) {
  SHAKEN_TRY(check_left(system, left));
  SHAKEN_CHECK(!is_resized(system, left.system), "sim/start/compression.h makes that");
  World world = empty_world(system);
  const bool has_plates = system.base || system.lid;
  const double rise = has_plates ? world.plates.at(0).base - left.plates.at(left.tick).base : 0.0;
  auto [poses, motions] = rods_left(world, left);
  world.rods.resize(poses.size());
  for (std::size_t i = 0; i < world.rods.size(); ++i) {
    const Species& species = world.species_of(i);
    poses[i].position.z() += rise;
    if (system.seed != left.system.seed) {
      Rng rng(system.seed, RngStream::kKicks, 0, static_cast<std::uint64_t>(i));
      for (double& component : motions[i].velocity) component *= 1.0 + kKick * rng.normal();
    }
    begin_flight(world.rods[i], 0, poses[i], motions[i], system.box(), species.inertia_ratio);
    world.rods[i].image = {0, 0};
  }
  world.start = content(world);
  return world;
}

}  // namespace shaken
