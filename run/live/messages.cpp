#include "run/live/messages.h"

#include <cmath>

#include "analysis/order.h"
#include "sim/balance.h"

namespace shaken::run {
namespace {

constexpr double kMicrojoulePerPicojoule = 1e-6;

}  // namespace

proto::Frame make_frame(const World& world, const Snapshot& snapshot) {
  const analysis::NematicOrder order = analysis::nematic_order(world.cell(), snapshot.director);
  proto::Frame frame;
  frame.sim_time_s = snapshot.time;
  frame.tick = snapshot.tick;
  frame.box = snapshot.box;
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
  const analysis::NematicOrder order = analysis::nematic_order(world.cell(), snapshot.director);
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

}  // namespace shaken::run
