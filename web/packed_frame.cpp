#include "web/packed_frame.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

namespace shaken::web {
namespace {

void append(std::string& bytes, std::uint16_t value) {
  bytes += static_cast<char>(value & 0xFF);
  bytes += static_cast<char>(value >> 8);
}

void append(std::string& bytes, const std::vector<std::int16_t>& values) {
  for (const std::int16_t value : values) append(bytes, static_cast<std::uint16_t>(value));
}

/// From half a gap below the base to half a gap above the lid; what is beyond is put there.
std::uint16_t packed_height(double height, double gap) {
  const double part = std::clamp(height / gap - 0.5, -1.0, 1.0);
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(32767 * part)));
}

nlohmann::ordered_json head_of(const client::RodFrame& frame) {
  nlohmann::ordered_json outlines = nlohmann::ordered_json::array();
  for (const client::RodOutline& outline : frame.outlines) {
    outlines.push_back({outline.half_length, outline.middle, outline.end});
  }
  nlohmann::ordered_json walls;
  if (frame.cell.walls) {
    walls = {{"arena", name_of(frame.cell.walls->arena)},
             {"size_mm", frame.cell.walls->size},
             {"inner_mm", frame.cell.walls->inner}};
    if (frame.cell.walls->has_length()) walls["length_mm"] = frame.cell.walls->length;
    if (frame.cell.walls->arena == Arena::kWedge) walls["narrow_mm"] = frame.cell.walls->narrow;
  }
  nlohmann::ordered_json posts;
  if (!frame.cell.posts.centres.empty()) {
    posts = {{"diameter_mm", frame.cell.posts.diameter}, {"centres_mm", nlohmann::ordered_json::array()}};
    for (const Vec2& centre : frame.cell.posts.centres) posts["centres_mm"].push_back({centre.x(), centre.y()});
  }
  return {{"time_s", frame.time},
          {"box_mm", {frame.cell.box.x(), frame.cell.box.y()}},
          {"order", frame.order},
          {"director_rad", frame.director},
          {"n_rods", frame.rods.size()},
          {"outlines", outlines},
          {"species_of_outline", frame.cell.species_of_shape},
          {"gap_mm", frame.cell.gap},
          {"has_heights", !frame.heights.empty()},
          {"walls", walls},
          {"posts", posts}};
}

}  // namespace

std::string packed(const client::RodFrame& frame) {
  std::string head = head_of(frame).dump();
  head.resize((head.size() + 3) / 4 * 4, ' ');
  std::string bytes;
  bytes.reserve(4 + head.size() + 9 * frame.rods.size());
  append(bytes, static_cast<std::uint16_t>(head.size() & 0xFFFF));
  append(bytes, static_cast<std::uint16_t>(head.size() >> 16));
  bytes += head;
  // One way of rounding for all that is sent.
  proto::Frame plain;
  plain.box = frame.cell.box;
  plain.rods = frame.rods;
  const std::vector<frame_t> chunks = proto::encode_frame(plain);
  for (const auto array : {&frame_t::x, &frame_t::y, &frame_t::heading, &frame_t::n_z}) {
    for (const frame_t& chunk : chunks) append(bytes, chunk.*array);
  }
  for (const double height : frame.heights) append(bytes, packed_height(height, frame.cell.gap));
  bytes.append(frame.cell.shape_of_rod.begin(), frame.cell.shape_of_rod.end());
  return bytes;
}

}  // namespace shaken::web
