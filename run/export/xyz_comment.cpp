#include "run/export/xyz_comment.h"

#include <fmt/format.h>

#include <cctype>
#include <nlohmann/json.hpp>

namespace shaken::run {
namespace {

/// Which borders are periodic: not those before which side walls stand, nor the plates.
std::string pbc_of(const Cell& cell) {
  const auto letter = [](double period) { return period > 0 ? 'T' : 'F'; };
  return fmt::format("{} {} F", letter(cell.period().x()), letter(cell.period().y()));
}

}  // namespace

double swept_height(const TrajectoryHeader& header) {
  const auto scene = nlohmann::json::parse(header.scene_json, nullptr, false);
  const auto amplitude = [&](const char* path) -> std::optional<double> {
    const nlohmann::json::json_pointer at(path);
    if (scene.is_discarded() || !scene.contains(at) || !scene[at].is_number()) return std::nullopt;
    return scene[at].get<double>();
  };
  const double base = amplitude("/plates/amplitude").value_or(0) + amplitude("/plates/second/amplitude").value_or(0);
  const double lid = amplitude("/plates/lid_motion/amplitude").value_or(base);
  return header.cell.gap + (base + lid);  // from the base's lowest height, 0, to the lid's highest
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
  if (header.cell.walls->has_length()) after_time_ += fmt::format(" arena_length={}", header.cell.walls->length);
  if (header.cell.walls->arena == Arena::kWedge)
    after_time_ += fmt::format(" arena_narrow={}", header.cell.walls->narrow);
}

std::string XyzComment::of(const RecordedFrame& frame) const {
  return fmt::format("{} Time={} Step={} {}", before_time_, frame.time, frame.tick, after_time_);
}

}  // namespace shaken::run
