// SPDX-License-Identifier: MIT
#include "run/export/xyz_comment.h"

#include <fmt/format.h>

#include <cctype>
#include <nlohmann/json.hpp>

#include "scene/load.h"
#include "sim/motion/plates.h"

namespace shaken::run {
namespace {

/// Which borders are periodic: not those before which side walls stand, nor the plates.
std::string pbc_of(const Cell& cell) {
  const auto letter = [](double period) { return period > 0 ? 'T' : 'F'; };
  return fmt::format("{} {} F", letter(cell.period().x()), letter(cell.period().y()));
}

}  // namespace

double swept_height(const TrajectoryHeader& header) {
  const auto plan = scene::load_scene(header.scene_json, "the scene");
  return plan ? PlateMotion::without_ticks(plan->system).highest_lid() : header.cell.gap;
}

XyzComment::XyzComment(const TrajectoryHeader& header, const std::string& properties)
    : before_time_(fmt::format(R"(Lattice="{} 0 0 0 {} 0 0 0 {}" Properties={} pbc="{}")", header.cell.box.x(),
                               header.cell.box.y(), swept_height(header), properties, pbc_of(header.cell))),
      after_time_(R"(units="mm s")") {
  std::string run_id = header.provenance.run_id;
  // a damaged one must not end the line or the quotes
  std::erase_if(run_id, [](unsigned char character) { return std::isalnum(character) == 0; });
  if (!run_id.empty()) {
    // in words: readers would take some ids for numbers
    after_time_ += fmt::format(R"( source="Shaken run {} seed {}")", run_id, header.provenance.seed);
  }
  if (!header.cell.walls) return;
  after_time_ += fmt::format(" arena={} arena_size={}", name_of(header.cell.walls->arena), header.cell.walls->size);
  if (header.cell.walls->arena == Arena::kAnnulus)
    after_time_ += fmt::format(" arena_inner={}", header.cell.walls->inner);
  if (header.cell.walls->arena == Arena::kStadium)
    after_time_ += fmt::format(" arena_length={}", header.cell.walls->length);
}

std::string XyzComment::of(const RecordedFrame& frame) const {
  return fmt::format("{} Time={} Step={} {}", before_time_, frame.time, frame.tick, after_time_);
}

}  // namespace shaken::run
