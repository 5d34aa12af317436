#pragma once

#include <cstddef>
#include <optional>
#include <shaken/frame_static_t.hpp>
#include <shaken/posts_t.hpp>
#include <shaken/sizes_t.hpp>
#include <string>

#include "sim/cell.h"

namespace shaken::proto {

/// What does not change during a run, without posts and sizes, as a message. Its head (utime, ..., job_id) is left to
/// the sender.
frame_static_t encode_cell(const Cell& cell, std::size_t n_rods, const std::string& label);

/// None where counts of beads contradict each other. What the numbers may be says scene/keys/cell_limits.h.
std::optional<Cell> decode_cell(const frame_static_t& message);

/// Posts as a message of their own, which former receivers do not know; its head is left to the sender.
posts_t encode_posts(const StandingPosts& posts);
StandingPosts decode_posts(const posts_t& message);

/// Which shapes are sizes of one species (Cell::species_of_shape, (n_shapes)) likewise.
sizes_t encode_sizes(const std::vector<std::uint8_t>& species_of_shape);

}  // namespace shaken::proto
