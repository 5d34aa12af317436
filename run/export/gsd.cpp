// The file layer of GSD 2 (https://gsd.readthedocs.io, "File layer"): a header of 256 bytes that says where the list of
// names and the index stand; an entry of 32 bytes in the index for each named array of each frame, sorted by frame and
// name, and one of zeros at its end; and the arrays themselves. The sizes of all arrays are known beforehand, so names
// and index can stand before the first array, and the file is written from its beginning to its end.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>

#include "base/core/check.h"
#include "base/core/state_io.h"
#include "run/export/frame_format.h"
#include "run/export/rod_angles.h"
#include "run/export/xyz_comment.h"
#include "run/files/version.h"

namespace shaken::run {
namespace {

constexpr std::uint64_t kGsdMagic = 0x65DF65DF65DF65DF;
constexpr std::uint32_t kLayerVersion = 2U << 16;
constexpr std::uint32_t kSchemaVersion = 1U << 16 | 4;
constexpr std::size_t kHeaderBytes = 256;
constexpr std::size_t kTextBytes = 64;  ///< of a name in the header; the list of names takes a multiple of it
constexpr std::size_t kReservedBytes = 80;
constexpr std::size_t kEntryBytes = 32;
constexpr std::size_t kEntriesAtOnce = 4096;

/// Types of numbers, as an entry of the index names them.
enum class Number : std::uint8_t { kUint32 = 3, kUint64 = 4, kInt8 = 5, kInt32 = 7, kFloat = 9, kDouble = 10 };

constexpr std::uint64_t bytes_of(Number number) {
  switch (number) {
    case Number::kInt8:
      return 1;
    case Number::kUint32:
    case Number::kInt32:
    case Number::kFloat:
      return 4;
    case Number::kUint64:
    case Number::kDouble:
      return 8;
  }
  return 0;
}

/// A named array of every frame, or of the first one, whose values then hold for all.
struct Chunk {
  const char* name;
  Number number;
  std::uint64_t rows;
  std::uint32_t columns;
  bool only_first;

  std::uint64_t bytes() const { return rows * columns * bytes_of(number); }
};

/// One row of zero-terminated text for each of `lines`, all of one length.
std::string text_rows(const std::vector<std::string>& lines) {
  std::size_t width = 0;
  for (const std::string& line : lines) width = std::max(width, line.size() + 1);
  std::string rows;
  for (const std::string& line : lines) rows += line + std::string(width - line.size(), '\0');
  return rows;
}

/// What OVITO draws for a species: its beads along z, which the orientation turns into the rod's axis.
std::string shape_of(const BeadRow& beads) {
  auto shape = nlohmann::json{{"type", "SphereUnion"}, {"diameters", nlohmann::json::array()}};
  shape["centers"] = nlohmann::json::array();
  for (std::size_t b = 0; b < beads.radius.size(); ++b) {
    shape["diameters"].push_back(2 * beads.radius[b]);
    shape["centers"].push_back({0, 0, beads.offset[b]});
  }
  return shape.dump();
}

/// A coordinate in [0, side), seen from the middle of the box: in [-side / 2, side / 2) after rounding, too.
float from_middle(float x, double side) {
  const float half = static_cast<float>(side) / 2;
  const auto centred = static_cast<float>(x - side / 2);
  return centred < half ? centred : std::nextafter(half, 0.0F);
}

void append_text(StateWriter& bytes, std::string_view text) { bytes.append(std::as_bytes(std::span(text))); }

/// `text` and zeros up to a length.
void append_padded(StateWriter& bytes, std::string_view text, std::size_t length) {
  append_text(bytes, text.substr(0, length - 1));
  append_text(bytes, std::string(length - std::min(text.size(), length - 1), '\0'));
}

template <class Value>
void append_all(StateWriter& bytes, const std::vector<Value>& values) {
  bytes.append(std::as_bytes(std::span(values)));
}

Result<void> hand_over(const StateWriter& bytes, const Sink& sink) {
  return sink({reinterpret_cast<const char*>(bytes.bytes().data()), bytes.bytes().size()});
}

/// "A" of a species, "A1" to "A9" of its sizes.
std::string name_of_type(const Cell& cell, std::size_t shape) {
  if (cell.species_of_shape.empty()) return letter_of(shape);
  const std::size_t species = cell.species_of_shape[shape];
  return fmt::format("{}{}", letter_of(species), shape - cell.first_shape_of(species) + 1);
}

class Gsd final : public FrameFormat {
 public:
  Gsd(const TrajectoryHeader& header, std::size_t n_frames)
      : header_(header), height_(swept_height(header)), n_frames_(n_frames) {
    const std::size_t n_types = header.cell.shapes.size();  // each size of a species is one
    std::vector<std::string> names;
    std::vector<std::string> shapes;
    for (std::size_t k = 0; k < n_types; ++k) {
      names.push_back(name_of_type(header.cell, k));
      shapes.push_back(shape_of(header.cell.shapes[k]));
    }
    types_ = text_rows(names);
    shapes_ = text_rows(shapes);
    const auto n_rods = static_cast<std::uint64_t>(header.n_rods);
    const auto width = [&](const std::string& rows) { return static_cast<std::uint32_t>(rows.size() / n_types); };
    chunks_ = {{"configuration/step", Number::kUint64, 1, 1, false},
               {"configuration/box", Number::kFloat, 6, 1, true},
               {"particles/N", Number::kUint32, 1, 1, true},
               {"particles/types", Number::kInt8, n_types, width(types_), true},
               {"particles/typeid", Number::kUint32, n_rods, 1, true},
               {"particles/type_shapes", Number::kInt8, n_types, width(shapes_), true},
               {"particles/position", Number::kFloat, n_rods, 3, false},
               {"particles/orientation", Number::kFloat, n_rods, 4, false},
               {"particles/velocity", Number::kFloat, n_rods, 3, false},
               {"particles/image", Number::kInt32, n_rods, 3, false},
               {"log/particles/theta", Number::kFloat, n_rods, 1, false},
               {"log/time_s", Number::kDouble, 1, 1, false}};
  }

  Result<void> begin(const Sink& sink) override {
    std::string names;
    for (const Chunk& chunk : chunks_) names += std::string(chunk.name) + '\0';
    names.resize((names.size() / kTextBytes + 1) * kTextBytes);  // ends in a zero of its own
    std::uint64_t n_entries = 1;                                 // the one of zeros
    for (const Chunk& chunk : chunks_) n_entries += chunk.only_first ? 1 : n_frames_;

    StateWriter bytes;
    bytes.put(kGsdMagic);
    bytes.put(static_cast<std::uint64_t>(kHeaderBytes + names.size()));  // where the index stands
    bytes.put(n_entries);
    bytes.put(static_cast<std::uint64_t>(kHeaderBytes));  // where the names stand
    bytes.put(static_cast<std::uint64_t>(names.size() / kTextBytes));
    bytes.put(kSchemaVersion);
    bytes.put(kLayerVersion);
    append_padded(bytes, fmt::format("Shaken {}", version()), kTextBytes);
    append_padded(bytes, "hoomd", kTextBytes);
    append_padded(bytes, "", kReservedBytes);
    SHAKEN_CHECK(bytes.bytes().size() == kHeaderBytes, "the header of GSD has another length");
    append_text(bytes, names);
    if (auto done = hand_over(bytes, sink); !done) return done;
    return write_index(kHeaderBytes + names.size() + n_entries * kEntryBytes, sink);
  }

  Result<void> write(const RecordedFrame& frame, const Sink& sink) override {
    StateWriter bytes;
    std::uint64_t due = 0;
    for (const Chunk& chunk : chunks_) due += n_written_ == 0 || !chunk.only_first ? chunk.bytes() : 0;
    bytes.put(static_cast<std::uint64_t>(frame.tick));
    if (n_written_ == 0) append_first(bytes);
    append_all(bytes, positions(frame));
    append_all(bytes, frame.orientation);
    append_all(bytes, frame.velocity);
    append_all(bytes, frame.image);
    append_all(bytes, rod_angles(header_, frame));
    bytes.put(frame.time);
    SHAKEN_CHECK(bytes.bytes().size() == due, "a frame is not what the index of GSD says");
    ++n_written_;
    return hand_over(bytes, sink);
  }

 private:
  /// The entries of all frames; their arrays stand behind each other from `location` on.
  Result<void> write_index(std::uint64_t location, const Sink& sink) const {
    StateWriter bytes;
    for (std::uint64_t frame = 0; frame < n_frames_; ++frame) {
      for (std::size_t id = 0; id < chunks_.size(); ++id) {
        const Chunk& chunk = chunks_[id];
        if (frame > 0 && chunk.only_first) continue;
        bytes.put(frame);
        bytes.put(chunk.rows);
        bytes.put(static_cast<std::int64_t>(location));
        bytes.put(chunk.columns);
        bytes.put(static_cast<std::uint16_t>(id));
        bytes.put(static_cast<std::uint8_t>(chunk.number));
        bytes.put(std::uint8_t{0});  // flags
        location += chunk.bytes();
      }
      if (bytes.bytes().size() < kEntriesAtOnce * kEntryBytes) continue;
      if (auto done = hand_over(bytes, sink); !done) return done;
      bytes = {};
    }
    append_text(bytes, std::string(kEntryBytes, '\0'));
    return hand_over(bytes, sink);
  }

  /// What the first frame says for all.
  void append_first(StateWriter& bytes) const {
    const Eigen::Vector2f sides = header_.cell.box.sides().cast<float>();
    append_all(bytes, std::vector<float>{sides.x(), sides.y(), static_cast<float>(height_), 0, 0, 0});
    bytes.put(static_cast<std::uint32_t>(header_.n_rods));
    append_text(bytes, types_);
    for (std::size_t i = 0; i < static_cast<std::size_t>(header_.n_rods); ++i) {
      bytes.put(static_cast<std::uint32_t>(header_.cell.shape_of(i)));
    }
    append_text(bytes, shapes_);
  }

  std::vector<float> positions(const RecordedFrame& frame) const {
    std::vector<float> centred = frame.position;
    for (std::size_t i = 0; i < centred.size(); i += 3) {
      centred[i] = from_middle(centred[i], header_.cell.box.x());
      centred[i + 1] = from_middle(centred[i + 1], header_.cell.box.y());
      centred[i + 2] = static_cast<float>(centred[i + 2] - height_ / 2);
    }
    return centred;
  }

  TrajectoryHeader header_;
  double height_;  ///< of the box [mm]
  std::uint64_t n_frames_;
  std::uint64_t n_written_ = 0;
  std::string types_;   ///< rows of text
  std::string shapes_;  ///< rows of text
  std::vector<Chunk> chunks_;
};

}  // namespace

std::unique_ptr<FrameFormat> make_gsd(const TrajectoryHeader& header, std::size_t n_frames) {
  return std::make_unique<Gsd>(header, n_frames);
}

}  // namespace shaken::run
