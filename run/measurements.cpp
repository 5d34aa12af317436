// SPDX-License-Identifier: MIT
#include "run/measurements.h"

#include <algorithm>
#include <limits>
#include <regex>
#include <set>
#include <string>
#include <utility>

namespace shaken::run {
namespace {

/// Takes out what measurements of spheres say of axes (MeasurementKind::of_axis), with its errors.
void leave_out_axes(Reduction& result) {
  static const std::regex kError("_sem");
  for (const MeasurementKind& kind : measurement_kinds()) {
    for (const std::string_view name : kind.of_axis) {
      result.scalars.erase(std::string(name));
      std::string path("/");
      path.append(kind.name).append("/").append(name);
      std::erase_if(result.arrays,
                    [&](const auto& array) { return std::regex_replace(array.first, kError, "") == path; });
    }
  }
}

}  // namespace

Measurements::Measurements(const scene::RunPlan& plan, Cell cell)
    : cell_(std::move(cell)), steady_(plan.steady), has_axis_(plan.system.rod.has_axis()) {
  const double dt = plan.system.dt;
  const Species species = make_species(plan.system.rod);
  for (const MeasurementKind& kind : measurement_kinds()) {
    const std::optional<Cadence> cadence = kind.cadence(plan);
    if (!cadence) continue;
    timed_.push_back(
        {std::string(kind.name), *cadence, kind.make({plan, species, static_cast<double>(cadence->period()) * dt}), 0});
    const Measurement* made = timed_.back().measurement.get();
    if (const auto* order = dynamic_cast<const MeasuredOrder*>(made)) order_ = order;
    if (const auto* defects = dynamic_cast<const MeasuredDefects*>(made)) defects_ = defects;
  }
}

Tick Measurements::next_due(Tick from) const {
  Tick next = kNever;
  for (const Timed& timed : timed_) next = std::min(next, timed.cadence.next(from));
  return next;
}

void Measurements::sample(const Snapshot& snapshot) {
  const auto first = [&](const auto& values) { return cell_.of_species(0, values); };
  std::optional<Snapshot> measured;
  if (!cell_.species_of_rod.empty()) {
    measured = {snapshot.tick,
                snapshot.time,
                snapshot.box_side,
                first(snapshot.position),
                first(snapshot.image),
                first(snapshot.director),
                first(snapshot.velocity),
                first(snapshot.angular_velocity)};
  }
  const Sample sample(measured ? *measured : snapshot);
  for (Timed& timed : timed_) {
    if (!timed.cadence.due(snapshot.tick)) continue;
    timed.measurement->sample(sample);
    ++timed.samples;
  }
}

double Measurements::order_running_mean() const {
  return order_ != nullptr ? order_->series().running_mean() : std::numeric_limits<double>::quiet_NaN();
}

const DefectSample* Measurements::last_defects() const {
  return defects_ != nullptr && defects_->last() ? &*defects_->last() : nullptr;
}

Reduction Measurements::reduce(double sim_seconds) const {
  Reduction result;
  result.t_steady = steady_.value_or(sim_seconds / 2);
  if (order_ != nullptr) {
    result.order = order_->series().reduce(steady_);
    result.t_steady = result.order->t_steady;
  }
  for (const Timed& timed : timed_) timed.measurement->reduce(result);
  if (!has_axis_) leave_out_axes(result);
  for (const MeasurementKind& kind : measurement_kinds()) {
    for (const Output& number : kind.numbers) {
      const auto scalar = result.scalars.find(std::string(number.name));
      if (scalar == result.scalars.end() || is_known(scalar->second) || !scalar->second.reason.empty()) continue;
      scalar->second.reason = number.if_none;
    }
  }
  return result;
}

std::map<std::string, std::int64_t> Measurements::counts() const {
  std::map<std::string, std::int64_t> counts;
  for (const Timed& timed : timed_) counts[timed.name] = timed.samples;
  return counts;
}

std::vector<std::byte> Measurements::save() const {
  const auto save_to = [this](StateWriter writer) {
    for (const Timed& timed : timed_) {
      writer.tag(timed.name);
      writer.put(timed.samples);
      timed.measurement->save(writer);
    }
    return writer;
  };
  return save_to(StateWriter(save_to(StateWriter::counting()).size())).take();
}

Result<void> Measurements::restore(std::span<const std::byte> bytes) {
  try {
    StateReader reader(bytes);
    std::set<std::string> restored;
    while (restored.size() < timed_.size()) {
      // their order may be that of another version
      const std::span<const std::byte> tag = reader.bytes();
      const std::string name(reinterpret_cast<const char*>(tag.data()), tag.size());
      const auto timed = std::find_if(timed_.begin(), timed_.end(), [&](const Timed& one) { return one.name == name; });
      if (timed == timed_.end() || !restored.insert(name).second) {
        throw StateError("no state of a measurement '" + name + "' was expected");
      }
      timed->samples = reader.integer(0, kNever);
      timed->measurement->restore(reader);
    }
    reader.end();
    return {};
  } catch (const StateError& problem) {
    return Error{problem.what()};
  }
}

}  // namespace shaken::run
