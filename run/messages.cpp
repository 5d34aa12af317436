// SPDX-License-Identifier: MIT
#include "run/messages.h"

#include <cmath>
#include <limits>

#include "analysis/order.h"
#include "sim/balance.h"

namespace shaken::run {
namespace {

constexpr double kMicrojoulePerPicojoule = 1e-6;

void append(std::vector<double>& all, const std::vector<double>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

analysis::NematicOrder order_of(const World& world, const Snapshot& snapshot) {
  if (!has_axis(world)) return {.order = std::numeric_limits<double>::quiet_NaN(), .director = 0};
  return order_of(snapshot, species_if_several(world));
}

analysis::NematicOrder order_of(const Snapshot& snapshot, std::span<const std::uint8_t> species_of_rod) {
  if (species_of_rod.empty()) return analysis::nematic_order(snapshot.director);
  std::vector<Vec3> directors;
  for (std::size_t i = 0; i < snapshot.n_rods(); ++i) {
    if (species_of_rod[i] == 0) directors.push_back(snapshot.director[i]);
  }
  return analysis::nematic_order(directors);
}

std::span<const std::uint8_t> species_if_several(const World& world) {
  if (world.species.size() > 1) return world.species_of_rod;
  return {};
}

bool has_axis(const World& world) { return world.species.front().n_beads() > 1; }

proto::Frame make_frame(const World& world, const Snapshot& snapshot) {
  return make_frame(snapshot, order_of(world, snapshot));
}

proto::Frame make_frame(const Snapshot& snapshot, const analysis::NematicOrder& order) {
  proto::Frame frame;
  frame.sim_time_s = snapshot.time;
  frame.tick = snapshot.tick;
  frame.box_side_mm = snapshot.box_side;
  frame.order = order.order;
  frame.director_rad = order.director;
  frame.rods.reserve(snapshot.n_rods());
  for (std::size_t i = 0; i < snapshot.n_rods(); ++i) {
    const Vec3& n = snapshot.director[i];
    frame.rods.push_back(proto::make_pose(snapshot.position[i].x(), snapshot.position[i].y(), {n.x(), n.y(), n.z()}));
  }
  return frame;
}

observables_t make_observables(const World& world, const Snapshot& snapshot, const Progress& progress) {
  const analysis::NematicOrder order = order_of(world, snapshot);
  double speed2_xy = 0;
  double speed2_z = 0;
  double n2_z = 0;
  for (std::size_t i = 0; i < snapshot.n_rods(); ++i) {
    speed2_xy += snapshot.velocity[i].head<2>().squaredNorm();
    speed2_z += snapshot.velocity[i].z() * snapshot.velocity[i].z();
    n2_z += snapshot.director[i].z() * snapshot.director[i].z();
  }
  const double n_rods = std::max<double>(1.0, static_cast<double>(snapshot.n_rods()));

  observables_t message;
  message.utime = 0;
  message.sequence = 0;
  message.sim_time_s = snapshot.time;
  message.sim_time_total_s = progress.sim_time_total;
  message.n_rods = static_cast<std::int32_t>(snapshot.n_rods());
  message.order = order.order;
  message.order_running_mean = progress.order_running_mean;
  message.director_rad = order.director;
  message.rms_speed_xy_mm_s = std::sqrt(speed2_xy / n_rods);
  message.rms_speed_z_mm_s = std::sqrt(speed2_z / n_rods);
  message.rms_n_z = std::sqrt(n2_z / n_rods);
  message.kinetic_energy_uJ = kinetic_energy(world).total() * kMicrojoulePerPicojoule;
  message.max_overlap_mm = world.counters.max_overlap();
  message.collisions_rod_rod = world.counters.impulses_rod_rod;
  message.collisions_rod_base = world.counters.impulses_rod_base;
  message.collisions_rod_lid = world.counters.impulses_rod_lid;
  message.sim_rate = progress.sim_rate;
  message.eta_s = progress.eta;
  return message;
}

defects_t make_defects(const DefectSample& sample) {
  defects_t message;
  message.utime = 0;
  message.sequence = 0;
  message.sim_time_s = sample.time;
  message.smoothing_mm = sample.smoothing;
  message.n_defects = static_cast<std::int32_t>(sample.defects.size());
  for (const analysis::Defect& defect : sample.defects) {
    message.x_mm.push_back(defect.position.x());
    message.y_mm.push_back(defect.position.y());
    message.charge.push_back(defect.charge);
    message.direction_rad.push_back(defect.direction);
  }
  return message;
}

frame_static_t make_frame_static(const World& world, const std::string& label) {
  frame_static_t message;
  message.utime = 0;
  message.sequence = 0;
  message.sim_time_s = 0;
  message.n_rods = static_cast<std::int32_t>(world.rods.size());
  message.box_side_mm = world.system.box_side;
  message.gap_mm = world.system.gap;
  message.n_species = static_cast<std::int32_t>(world.species.size());
  for (const Species& species : world.species) {
    message.species_beads.push_back(species.n_beads());
    append(message.bead_offset_mm, species.bead_offset);
    append(message.bead_radius_mm, species.bead_radius);
  }
  message.n_beads = static_cast<std::int32_t>(message.bead_offset_mm.size());
  const std::span<const std::uint8_t> species_of_rod = species_if_several(world);
  message.rod_species.assign(species_of_rod.begin(), species_of_rod.end());
  message.n_rod_species = static_cast<std::int32_t>(message.rod_species.size());
  message.arena_size_mm = 0;
  message.arena_inner_mm = 0;
  if (const auto& walls = world.system.walls) {
    message.arena = name_of(walls->arena);
    message.arena_size_mm = walls->size;
    message.arena_inner_mm = walls->arena == Arena::kAnnulus ? walls->inner : 0;
  }
  message.label = label;
  return message;
}

}  // namespace shaken::run
