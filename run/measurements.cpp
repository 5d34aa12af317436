// SPDX-License-Identifier: MIT
#include "run/measurements.h"

#include <algorithm>
#include <utility>

#include "analysis/director_field.h"
#include "analysis/steady.h"
#include "sim/effects/side_walls.h"

namespace shaken::run {

using analysis::StateReader;
using analysis::StateWriter;

double largest_tilt(const Species& species, double gap) {
  if (species.half_length <= 0) return 1.0;
  return std::clamp((gap / 2 - species.end_radius) / species.half_length, 0.0, 1.0);
}

Measurements::Measurements(const scene::RunPlan& plan, const Species& species, std::span<const std::uint8_t> kinds)
    : steady_(plan.steady), walls_(plan.system.walls) {
  if (std::any_of(kinds.begin(), kinds.end(), [](std::uint8_t kind) { return kind != 0; })) {
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      if (kinds[i] == 0) measured_.push_back(i);
    }
  }
  const double dt = plan.system.dt;
  if (plan.order) order_.emplace(Timed<analysis::OrderSeries>{{plan.order->every, dt}, {}});
  if (plan.angles) {
    angles_.emplace(Timed<analysis::Blocked<analysis::AngleDistribution>>{
        {plan.angles->every, dt}, analysis::Blocked(analysis::AngleDistribution(plan.angles->bins))});
  }
  if (plan.tilt) {
    // Soft overlaps let rods tilt a little further; a gap that lets them stand gives the whole range.
    const double n_z_max = std::max(largest_tilt(species, plan.system.gap), 1e-6);
    tilt_.emplace(Timed<analysis::Blocked<analysis::TiltVelocity>>{
        {plan.tilt->every, dt}, analysis::Blocked(analysis::TiltVelocity(plan.tilt->bins, n_z_max))});
  }
  if (plan.defects) {
    const double length = plan.system.rod.length;
    smoothing_ = plan.defects->smoothing > 0 ? plan.defects->smoothing : length / 2;
    mesh_ = plan.defects->grid > 0 ? plan.defects->grid : length / 8;
    defects_.emplace(Timed<analysis::DefectSeries>{{plan.defects->every, dt}, {}});
  }
  if (plan.g2) {
    g2_.emplace(Timed<analysis::Blocked<analysis::OrientationCorrelation>>{
        {plan.g2->every, dt},
        analysis::Blocked(analysis::OrientationCorrelation(plan.g2->bins, plan.system.box_side / 2))});
  }
  if (plan.msd) {
    const Cadence cadence(plan.msd->every, dt);
    msd_.emplace(Timed<analysis::MeanSquareDisplacement>{
        cadence, analysis::MeanSquareDisplacement(static_cast<double>(cadence.period()) * dt)});
  }
}

template <class Visitor>
void Measurements::visit(Visitor visitor) {
  if (order_) visitor("order", *order_);
  if (angles_) visitor("angles", *angles_);
  if (tilt_) visitor("tilt", *tilt_);
  if (defects_) visitor("defects", *defects_);
  if (g2_) visitor("g2", *g2_);
  if (msd_) visitor("msd", *msd_);
}

template <class Visitor>
void Measurements::visit(Visitor visitor) const {
  if (order_) visitor("order", *order_);
  if (angles_) visitor("angles", *angles_);
  if (tilt_) visitor("tilt", *tilt_);
  if (defects_) visitor("defects", *defects_);
  if (g2_) visitor("g2", *g2_);
  if (msd_) visitor("msd", *msd_);
}

Tick Measurements::next_due(Tick from) const {
  Tick next = kNever;
  visit([&](const char*, const auto& timed) { next = std::min(next, timed.cadence.next(from)); });
  return next;
}

void Measurements::sample(const Snapshot& snapshot) {
  if (measured_.empty()) return sample_rods(snapshot);
  Snapshot rods;
  rods.tick = snapshot.tick;
  rods.time = snapshot.time;
  rods.box_side = snapshot.box_side;
  for (const std::size_t i : measured_) {
    rods.position.push_back(snapshot.position[i]);
    rods.image.push_back(snapshot.image[i]);
    rods.director.push_back(snapshot.director[i]);
    rods.velocity.push_back(snapshot.velocity[i]);
    rods.angular_velocity.push_back(snapshot.angular_velocity[i]);
  }
  sample_rods(rods);
}

void Measurements::sample_rods(const Snapshot& snapshot) {
  const auto due = [&](auto& timed) {
    if (!timed || !timed->cadence.due(snapshot.tick)) return false;
    ++timed->samples;
    return true;
  };
  if (due(order_)) order_->accumulator.accumulate(snapshot.time, snapshot.director);
  if (due(angles_)) angles_->accumulator.accumulate(snapshot.time, snapshot.director);
  if (due(tilt_)) tilt_->accumulator.accumulate(snapshot.time, snapshot.director, snapshot.velocity);
  if (due(defects_)) {
    const analysis::DirectorField field(snapshot.position, snapshot.director, snapshot.box_side,
                                        analysis::grid_nodes(snapshot.box_side, mesh_), smoothing_);
    std::vector<analysis::Defect> defects = analysis::find_defects(field);
    if (walls_) {  // beyond them there are no rods to have any
      std::erase_if(defects, [&](const analysis::Defect& defect) {
        const Vec3 place(defect.position.x(), defect.position.y(), 0);
        return distance_to_walls(*walls_, snapshot.box_side, place) < 0;
      });
    }
    last_defects_ = DefectSample{snapshot.tick, snapshot.time, smoothing_, std::move(defects)};
    defects_->accumulator.accumulate(snapshot.time, last_defects_->defects);
  }
  if (due(g2_)) {
    g2_->accumulator.accumulate(snapshot.time, snapshot.position, snapshot.director, snapshot.box_side);
  }
  if (analysis::is_steady(snapshot.time, steady_.value_or(0.0)) && due(msd_)) {
    std::vector<Vec3> unwrapped = snapshot.position;
    for (std::size_t i = 0; i < unwrapped.size(); ++i) {
      unwrapped[i] += snapshot.box_side * Vec3(snapshot.image[i][0], snapshot.image[i][1], 0);
    }
    msd_->accumulator.accumulate(unwrapped, snapshot.director);
  }
}

double Measurements::order_running_mean() const { return order_ ? order_->accumulator.running_mean() : 0.0; }

Reduction Measurements::reduce(double sim_seconds) const {
  Reduction result;
  Observables& arrays = result.arrays;
  result.t_steady = steady_.value_or(sim_seconds / 2);
  if (order_) {
    const analysis::OrderSeries& series = order_->accumulator;
    result.order = series.reduce(steady_);
    result.t_steady = result.order->t_steady;
    arrays["/order/time_s"] = series.times();
    arrays["/order/order"] = series.orders();
    arrays["/order/director_rad"] = series.directors();
  }
  if (angles_) {
    const analysis::AnglePdf pdf = angles_->accumulator.after(result.t_steady).reduce();
    arrays["/angles/theta_rad"] = pdf.theta;
    arrays["/angles/density_per_rad"] = pdf.density;
  }
  if (tilt_) {
    const analysis::TiltCurve curve = tilt_->accumulator.after(result.t_steady).reduce();
    arrays["/tilt/n_z"] = curve.n_z;
    arrays["/tilt/v_along_mm_s"] = curve.v_along;
    arrays["/tilt/v_along_sem_mm_s"] = curve.v_along_sem;
    arrays["/tilt/v_across_mm_s"] = curve.v_across;
    arrays["/tilt/v_across_sem_mm_s"] = curve.v_across_sem;
    arrays["/tilt/density"] = curve.density;
  }
  if (defects_) {
    const analysis::DefectSeries& series = defects_->accumulator;
    result.defects = series.reduce(result.t_steady);
    arrays["/defects/time_s"] = series.times();
    arrays["/defects/n_plus"] = series.n_plus();
    arrays["/defects/n_minus"] = series.n_minus();
    arrays["/defects/list/time_s"] = series.list().time;
    arrays["/defects/list/x_mm"] = series.list().x;
    arrays["/defects/list/y_mm"] = series.list().y;
    arrays["/defects/list/charge"] = series.list().charge;
    arrays["/defects/list/direction_rad"] = series.list().direction;
  }
  if (g2_) {
    const analysis::OrientationCurve curve = g2_->accumulator.after(result.t_steady).reduce();
    arrays["/g2/r_mm"] = curve.r;
    arrays["/g2/g2"] = curve.g2;
  }
  if (msd_) {
    const analysis::MsdCurve curve = msd_->accumulator.reduce();
    arrays["/msd/lag_s"] = curve.lag;
    arrays["/msd/total_mm2"] = curve.total;
    arrays["/msd/along_mm2"] = curve.along;
    arrays["/msd/across_mm2"] = curve.across;
  }
  return result;
}

std::map<std::string, std::int64_t> Measurements::counts() const {
  std::map<std::string, std::int64_t> counts;
  visit([&](const char* name, const auto& timed) { counts[name] = timed.samples; });
  return counts;
}

std::vector<std::byte> Measurements::save() const {
  StateWriter writer;
  visit([&](const char* name, const auto& timed) {
    writer.tag(name);
    writer.put(timed.samples);
    timed.accumulator.save(writer);
  });
  return writer.bytes();
}

void Measurements::restore(std::span<const std::byte> bytes) {
  StateReader reader(bytes);
  visit([&](const char* name, auto& timed) {
    reader.tag(name);
    timed.samples = reader.integer(0, kNever);
    timed.accumulator.restore(reader);
  });
  reader.end();
}

}  // namespace shaken::run
