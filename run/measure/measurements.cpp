#include "run/measure/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "analysis/errors/steady.h"
#include "run/files/unit_of_name.h"
#include "scene/keys/derived.h"
#include "scene/keys/measured_species.h"

namespace shaken::run {
namespace {

/// Takes out what measurements of spheres say of axes, with its errors.
void leave_out_axes(Reduction& result) {
  for (const MeasurementKind& kind : measurement_kinds()) {
    for (const Output& number : kind.numbers) {
      if (number.needs_axis) result.scalars.erase(std::string(number.name));
    }
    for (const Output& array : kind.arrays) {
      const std::string path = fmt::format("/{}/{}", kind.name, array.name);
      if (!array.needs_axis) continue;
      result.arrays.erase(path);
      result.arrays.erase(with_sem(path));
    }
  }
}

/// The mean of S as a number like any other.
Scalar mean_order(const analysis::SteadySummary& order) {
  Scalar mean;
  mean.value = order.n_effective > 0 ? order.mean : mean.value;
  mean.sem = order.sem;
  mean.n_effective = order.n_effective;
  mean.steady = order.steady;
  mean.drift = order.drift.value;
  mean.drift_sem = order.drift.sem;
  if (!is_known(mean)) mean.reason = "no sample of the steady state";
  return mean;
}

}  // namespace

Measurements::Measurements(const scene::RunPlan& plan, Cell cell) : cell_(std::move(cell)), steady_(plan.steady) {
  for (const scene::MeasuredRods& rods : scene::measured_species(plan)) {
    OfSpecies measured{rods.species, rods.prefix, rods.plan.system.rod.has_axis()};
    const std::vector<Species> sizes = scene::sizes_of_species(rods.plan.system.rod);
    for (const MeasurementKind& kind : measurement_kinds()) {
      const std::optional<Cadence> cadence = kind.cadence(rods.plan);
      if (!cadence) continue;
      const double interval = static_cast<double>(cadence->period()) * plan.system.dt;
      for (const Output& number : kind.numbers) over_[number.name] = kind.time_over(number, plan, interval);
      measured.timed.push_back(
          {&kind, *cadence, kind.make({rods.plan, plan, sizes.front(), cell_, interval, rods.species, sizes}), 0});
      const Measurement* made = measured.timed.back().measurement.get();
      if (const auto* order = dynamic_cast<const MeasuredOrder*>(made)) measured.order = order;
      if (const auto* defects = dynamic_cast<const MeasuredDefects*>(made)) measured.defects = defects;
    }
    species_.push_back(std::move(measured));
  }
}

Tick Measurements::next_due(Tick from) const {
  Tick next = kNever;
  for (const OfSpecies& rods : species_) {
    for (const Timed& timed : rods.timed) next = std::min(next, timed.cadence.next(from));
  }
  return next;
}

void Measurements::sample(const Snapshot& snapshot, const RunTotals& totals) {
  for (OfSpecies& rods : species_) {
    const auto is_due = [&](const Timed& timed) { return timed.cadence.due(snapshot.tick); };
    if (std::ranges::none_of(rods.timed, is_due)) continue;
    const auto theirs = [&](const auto& values) { return cell_.of_species(rods.species, values); };
    std::optional<Snapshot> measured;
    if (!cell_.has_one_species()) {
      measured = {snapshot.tick,
                  snapshot.time,
                  snapshot.box,
                  theirs(snapshot.position),
                  theirs(snapshot.image),
                  theirs(snapshot.director),
                  theirs(snapshot.velocity),
                  theirs(snapshot.angular_velocity)};
    }
    const Sample sample(measured ? *measured : snapshot, snapshot, totals);
    for (Timed& timed : rods.timed) {
      if (!is_due(timed)) continue;
      const bool is_early = timed.kind->only_steady && !analysis::is_steady(sample->time, steady_.value_or(0.0));
      if (!is_early) timed.measurement->sample(sample);
      ++timed.samples;
    }
  }
}

double Measurements::order_running_mean() const {
  const MeasuredOrder* order = species_.front().order;
  return order != nullptr ? order->series().running_mean() : std::numeric_limits<double>::quiet_NaN();
}

const DefectSample* Measurements::last_defects() const {
  const MeasuredDefects* defects = species_.front().defects;
  return defects != nullptr && defects->last() ? &*defects->last() : nullptr;
}

Reduction Measurements::reduce(double sim_seconds) const {
  Reduction result = reduce(species_.front(), steady_, sim_seconds);
  for (const OfSpecies& rods : species_) {
    if (rods.prefix.empty()) continue;
    // all averages of a run begin at the same time
    Reduction of_others = reduce(rods, result.t_steady, sim_seconds);
    if (of_others.order) of_others.scalars["S"] = mean_order(*of_others.order);
    for (auto& [path, values] : of_others.arrays) result.arrays["/" + rods.prefix + path] = std::move(values);
    for (auto& [name, scalar] : of_others.scalars) result.scalars[rods.prefix + "." + name] = std::move(scalar);
  }
  return result;
}

Reduction Measurements::reduce(const OfSpecies& rods, std::optional<double> t_steady, double sim_seconds) const {
  Reduction result;
  result.t_steady = t_steady.value_or(sim_seconds / 2);
  if (rods.order != nullptr) {
    result.order = rods.order->series().reduce(t_steady);
    result.t_steady = result.order->t_steady;
  }
  for (const Timed& timed : rods.timed) timed.measurement->reduce(result);
  if (!rods.has_axis) leave_out_axes(result);
  for (const MeasurementKind& kind : measurement_kinds()) {
    for (const Output& number : kind.numbers) {
      const auto scalar = result.scalars.find(std::string(number.name));
      if (scalar == result.scalars.end()) continue;
      scalar->second.over = over_.at(number.name);
      if (!is_known(scalar->second) && scalar->second.reason.empty()) scalar->second.reason = number.if_none;
    }
  }
  return result;
}

std::map<std::string, std::int64_t> Measurements::counts() const {
  std::map<std::string, std::int64_t> counts;
  for (const OfSpecies& rods : species_) {
    for (const Timed& timed : rods.timed) counts[std::string(timed.kind->name)] += timed.samples;
  }
  return counts;
}

std::vector<std::byte> Measurements::save() const {
  const auto save_to = [this](StateWriter writer) {
    for (const OfSpecies& rods : species_) {
      for (const Timed& timed : rods.timed) {
        writer.tag(tag(rods, timed));
        writer.put(timed.samples);
        timed.measurement->save(writer);
      }
    }
    return writer;
  };
  return save_to(StateWriter(save_to(StateWriter::counting()).size())).take();
}

std::string Measurements::tag(const OfSpecies& rods, const Timed& timed) {
  return rods.prefix.empty() ? std::string(timed.kind->name) : fmt::format("{}/{}", rods.prefix, timed.kind->name);
}

Result<void> Measurements::restore(std::span<const std::byte> bytes) {
  try {
    std::map<std::string, Timed*> expected;
    for (OfSpecies& rods : species_) {
      for (Timed& timed : rods.timed) expected[tag(rods, timed)] = &timed;
    }
    StateReader reader(bytes);
    while (!expected.empty()) {
      // their order may be that of another version
      const std::span<const std::byte> read = reader.bytes();
      const std::string name(reinterpret_cast<const char*>(read.data()), read.size());
      const auto timed = expected.find(name);
      if (timed == expected.end()) throw StateError("no state of a measurement '" + name + "' was expected");
      timed->second->samples = reader.integer(0, kNever);
      timed->second->measurement->restore(reader);
      expected.erase(timed);
    }
    reader.end();
    return {};
  } catch (const StateError& problem) {
    return Error{problem.what()};
  }
}

}  // namespace shaken::run
