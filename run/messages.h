// SPDX-License-Identifier: MIT
#pragma once

#include <shaken/defects_t.hpp>
#include <shaken/frame_static_t.hpp>
#include <shaken/observables_t.hpp>
#include <span>
#include <string>

#include "analysis/order.h"
#include "proto/frame_codec.h"
#include "run/files/progress.h"
#include "run/measurements.h"
#include "sim/world.h"

namespace shaken::run {

/// Species of each rod; empty if there is but one species.
std::span<const std::uint8_t> species_if_several(const World& world);

/// Whether the first species, which order is about, has an axis: spheres have none.
bool has_axis(const World& world);

/// S and the director of the rods of the first species: all that is live says the same of a mixture. NaN and 0 where
/// these are spheres.
analysis::NematicOrder order_of(const World& world, const Snapshot& snapshot);
/// Those of bodies that have an axis. `species_of_rod` (n_rods) is empty if there is no other species.
analysis::NematicOrder order_of(const Snapshot& snapshot, std::span<const std::uint8_t> species_of_rod = {});

/// State into wire messages. Head fields (utime, sequence, job_id) are left to the sender. Order and director are those
/// of the rods of the first species, as in the measurements.
proto::Frame make_frame(const World& world, const Snapshot& snapshot);
proto::Frame make_frame(const Snapshot& snapshot, const analysis::NematicOrder& order);
observables_t make_observables(const World& world, const Snapshot& snapshot, const Progress& progress);
defects_t make_defects(const DefectSample& sample);
frame_static_t make_frame_static(const World& world, const std::string& label);

}  // namespace shaken::run
