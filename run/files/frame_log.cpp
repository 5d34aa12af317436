#include "run/files/frame_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <utility>

#include "base/core/state_io.h"
#include "base/files.h"
#include "run/files/hashed_bytes.h"
#include "scene/keys/cell_limits.h"

namespace shaken::run {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kFramesMagic = "SHKNFRAM";
constexpr std::uint32_t kFramesVersion = 1;
constexpr std::size_t kHashBytes = sizeof(std::uint64_t);
/// Bytes of magic, version and length.
constexpr std::size_t kPrefixBytes = kFramesMagic.size() + 2 * sizeof(std::uint32_t);
/// A header has one byte a rod and a scene; more is no header of ours.
constexpr std::uint32_t kMostHeaderBytes = 1U << 28;

template <class Value>
void append(StateWriter& writer, const std::vector<Value>& values) {
  writer.append(std::as_bytes(std::span(values)));
}

template <class Value>
void take(StateReader& reader, std::size_t n, std::vector<Value>& values) {
  values.resize(n);
  const std::span<const std::byte> bytes = reader.bytes(n * sizeof(Value));
  if (n > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
}

StateWriter record_of(const RecordedFrame& frame) {
  StateWriter record;
  record.put(static_cast<std::int64_t>(frame.tick));
  record.put(frame.time);
  append(record, frame.position);
  append(record, frame.velocity);
  append(record, frame.orientation);
  append(record, frame.image);
  record.put(hash_of(record.bytes()));
  return record;
}

/// None if the hash is not that of the rest. `record` has the length of a frame.
std::optional<RecordedFrame> frame_of(std::string_view record, std::size_t n_rods) {
  StateReader reader(bytes_of(record));
  const std::uint64_t hash = hash_of(bytes_of(record.substr(0, record.size() - kHashBytes)));
  RecordedFrame frame;
  std::int64_t tick = 0;
  std::uint64_t stored = 0;
  reader.get(tick);
  frame.tick = tick;
  reader.get(frame.time);
  take(reader, 3 * n_rods, frame.position);
  take(reader, 3 * n_rods, frame.velocity);
  take(reader, 4 * n_rods, frame.orientation);
  take(reader, 3 * n_rods, frame.image);
  reader.get(stored);
  return stored == hash ? std::optional(std::move(frame)) : std::nullopt;
}

Json json_of(const TrajectoryHeader& header) {
  const Cell& cell = header.cell;
  Json json{{"n_rods", header.n_rods},
            {"box_side_mm", cell.box.x()},
            {"gap_mm", cell.gap},
            {"dt_s", header.dt},
            {"species_of_rod", cell.shape_of_rod},
            {"scene", header.scene_json},
            {"run_id", header.provenance.run_id},
            {"seed", header.provenance.seed}};
  if (cell.box.y() != cell.box.x()) json["box_side_y_mm"] = cell.box.y();
  if (!cell.species_of_shape.empty()) json["species_of_shape"] = cell.species_of_shape;
  for (const BeadRow& row : cell.shapes)
    json["beads"].push_back({{"offset_mm", row.offset}, {"radius_mm", row.radius}});
  if (cell.walls) {
    json["walls"] = {{"arena", name_of(cell.walls->arena)},
                     {"size_mm", cell.walls->size},
                     {"inner_mm", cell.walls->inner},
                     {"friction", cell.walls->contact.friction},
                     {"restitution", cell.walls->contact.restitution}};
    if (cell.walls->has_length()) json["walls"]["length_mm"] = cell.walls->length;
    if (cell.walls->arena == Arena::kWedge) json["walls"]["narrow_mm"] = cell.walls->narrow;
  }
  if (!cell.posts.centres.empty()) {
    json["posts"] = {{"diameter_mm", cell.posts.diameter}, {"centres_mm", Json::array()}};
    for (const Vec2& centre : cell.posts.centres) json["posts"]["centres_mm"].push_back({centre.x(), centre.y()});
  }
  return json;
}

Box box_of(const Json& json) {
  const double x = json.at("box_side_mm");
  return {x, json.value("box_side_y_mm", x)};
}

/// Throws what the JSON library throws if something is missing.
TrajectoryHeader header_of(const Json& json) {
  TrajectoryHeader header{.n_rods = json.at("n_rods"),
                          .cell = {.box = box_of(json),
                                   .gap = json.at("gap_mm"),
                                   .shape_of_rod = json.at("species_of_rod").get<std::vector<std::uint8_t>>()},
                          .dt = json.at("dt_s"),
                          .scene_json = json.at("scene"),
                          .provenance = {json.at("run_id"), json.at("seed")}};
  for (const Json& row : json.at("beads")) header.cell.shapes.push_back({row.at("offset_mm"), row.at("radius_mm")});
  if (json.contains("species_of_shape"))
    header.cell.species_of_shape = json.at("species_of_shape").get<std::vector<std::uint8_t>>();
  if (json.contains("walls")) {
    const Json& from = json.at("walls");
    header.cell.walls = SideWalls{.arena = arena_of(from.at("arena").get<std::string>()).value(),
                                  .size = from.at("size_mm"),
                                  .inner = from.at("inner_mm"),
                                  .contact = {from.at("friction"), from.at("restitution")}};
    if (header.cell.walls->has_length()) header.cell.walls->length = from.at("length_mm");
    if (header.cell.walls->arena == Arena::kWedge) header.cell.walls->narrow = from.at("narrow_mm");
  }
  if (json.contains("posts")) {
    header.cell.posts.diameter = json.at("posts").at("diameter_mm");
    for (const Json& centre : json.at("posts").at("centres_mm"))
      header.cell.posts.centres.emplace_back(centre.at(0).get<double>(), centre.at(1).get<double>());
  }
  return header;
}

/// `size` bytes from `offset` on; fewer where the file ends.
Result<std::string> read_at(int fd, std::size_t offset, std::size_t size) {
  std::string bytes(size, '\0');
  std::size_t n = 0;
  while (n < size) {
    const ssize_t got = ::pread(fd, bytes.data() + n, size - n, static_cast<off_t>(offset + n));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_error("cannot read");
    if (got == 0) break;
    n += static_cast<std::size_t>(got);
  }
  bytes.resize(n);
  return bytes;
}

bool write_at(int fd, std::size_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::size_t>(written);
  }
  return true;
}

class LoggedFrames final : public RecordedFrames {
 public:
  static Result<std::unique_ptr<LoggedFrames>> open(const std::filesystem::path& path) {
    const auto refuse = [&](const std::string& why) { return Error{path.string() + " " + why}; };
    Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file) return system_error("cannot open " + path.string());
    const Result<std::string> prefix = read_at(file.value(), 0, kPrefixBytes);
    if (!prefix) return Error{path.string() + ": " + prefix.error().message, prefix.error().code};
    if (prefix->size() < kPrefixBytes || !prefix->starts_with(kFramesMagic)) return refuse("holds no recorded frames");
    StateReader numbers(bytes_of(*prefix).subspan(kFramesMagic.size()));
    std::uint32_t version = 0, length = 0;
    numbers.get(version);
    numbers.get(length);
    if (version != kFramesVersion) {
      return refuse("is of version " + std::to_string(version) + ", which this program cannot read");
    }
    if (length > kMostHeaderBytes) return refuse("is damaged");
    const Result<std::string> text = read_at(file.value(), kPrefixBytes, length + kHashBytes);
    if (!text) return Error{path.string() + ": " + text.error().message, text.error().code};
    if (text->size() < length + kHashBytes) return refuse("is damaged");
    std::uint64_t hash = 0;
    StateReader(bytes_of(*text).subspan(length)).get(hash);
    if (hash != hash_of(bytes_of(*text).first(length))) return refuse("is damaged");
    TrajectoryHeader header;
    try {
      header = header_of(Json::parse(text->substr(0, length)));
    } catch (const std::bad_alloc&) {
      throw;  // the header may be whole
    } catch (const std::exception& problem) {
      return refuse(std::string("has a header that cannot be read: ") + problem.what());
    }
    if (auto done = check(header); !done) return refuse("is damaged: " + done.error().message);
    std::unique_ptr<LoggedFrames> frames(
        new LoggedFrames(path, std::move(file), kPrefixBytes + length + kHashBytes, std::move(header)));
    SHAKEN_TRY(frames->count());
    return frames;
  }

  const TrajectoryHeader& header() const override { return header_; }
  std::size_t n_frames() const override { return n_frames_; }
  Result<RecordedFrame> frame(std::size_t index) const override {
    std::optional<RecordedFrame> frame = SHAKEN_TRY(read(index));
    if (!frame) return Error{path_.string() + ": frame " + std::to_string(index) + " is damaged"};
    return *std::move(frame);
  }
  std::size_t begin() const { return begin_; }
  std::size_t n_rods() const { return static_cast<std::size_t>(header_.n_rods); }

 private:
  LoggedFrames(std::filesystem::path path, Descriptor file, std::size_t begin, TrajectoryHeader header)
      : path_(std::move(path)), file_(std::move(file)), begin_(begin), header_(std::move(header)) {}

  /// A frame; none where the record is not whole. That it cannot be read is another matter.
  Result<std::optional<RecordedFrame>> read(std::size_t index) const {
    const std::size_t size = frame_bytes(n_rods());
    const Result<std::string> record = read_at(file_.value(), begin_ + index * size, size);
    if (!record) return Error{path_.string() + ": " + record.error().message, record.error().code};
    return record->size() == size ? frame_of(*record, n_rods()) : std::nullopt;
  }

  Result<void> count() {
    struct stat about {};
    if (::fstat(file_.value(), &about) != 0) return system_error("cannot tell the size of " + path_.string());
    const auto size = static_cast<std::size_t>(about.st_size);
    if (size > begin_) n_frames_ = (size - begin_) / frame_bytes(n_rods());
    if (n_frames_ == 0) return {};
    // The last one may be on its way to the file just now, or have been when its writer was killed.
    if (!SHAKEN_TRY(read(n_frames_ - 1))) --n_frames_;
    return {};
  }

  std::filesystem::path path_;
  Descriptor file_;
  std::size_t begin_;
  TrajectoryHeader header_;
  std::size_t n_frames_ = 0;
};

}  // namespace

std::size_t frame_bytes(std::size_t n_rods) {
  return sizeof(std::int64_t) + sizeof(double) + n_rods * (10 * sizeof(float) + 3 * sizeof(std::int32_t)) + kHashBytes;
}

Result<void> check(const TrajectoryHeader& header) {
  if (header.n_rods < 0) return Error{"n_rods is negative"};
  return scene::check_cell(header.cell, static_cast<std::size_t>(header.n_rods));
}

FrameLog::FrameLog(std::filesystem::path path, Descriptor file, std::size_t begin, std::size_t n_rods,
                   std::size_t n_frames)
    : path_(std::move(path)), file_(std::move(file)), begin_(begin), n_rods_(n_rods), n_frames_(n_frames) {}

Result<FrameLog> FrameLog::create(const std::filesystem::path& file, const TrajectoryHeader& header) {
  const std::string text = json_of(header).dump(-1, ' ', false, Json::error_handler_t::replace);
  StateWriter content;
  content.append(bytes_of(kFramesMagic));
  content.put(kFramesVersion);
  content.put(static_cast<std::uint32_t>(text.size()));
  content.append(bytes_of(text));
  content.put(hash_of(bytes_of(text)));
  SHAKEN_TRY(write_file_atomically(file, text_of(content.bytes())));
  return reopen(file, 0);
}

Result<FrameLog> FrameLog::reopen(const std::filesystem::path& file, std::size_t n_frames) {
  const auto frames = SHAKEN_TRY(LoggedFrames::open(file));
  if (frames->n_frames() < n_frames) {
    return Error{file.string() + " has " + std::to_string(frames->n_frames()) + " whole frames instead of " +
                 std::to_string(n_frames)};
  }
  for (std::size_t i = 0; i < n_frames; ++i) {
    if (const auto frame = frames->frame(i); !frame) return frame.error();
  }
  FrameLog log(file, Descriptor(::open(file.c_str(), O_RDWR | O_CLOEXEC)), frames->begin(), frames->n_rods(), n_frames);
  if (!log.file_ || ::ftruncate(log.file_.value(), static_cast<off_t>(log.end())) != 0) {
    return system_error("cannot write " + file.string());
  }
  return log;
}

std::size_t FrameLog::end() const { return begin_ + n_frames_ * frame_bytes(n_rods_); }

Result<void> FrameLog::append(const RecordedFrame& frame) {
  if (frame.position.size() != 3 * n_rods_) {
    return Error{path_.string() + " holds " + std::to_string(n_rods_) + " rods, the frame has " +
                 std::to_string(frame.position.size() / 3)};
  }
  if (!write_at(file_.value(), end(), text_of(record_of(frame).bytes()))) {
    const Error error = system_error("cannot write a frame to " + path_.string());
    // Room for others; a reader leaves half a frame out anyway.
    static_cast<void>(::ftruncate(file_.value(), static_cast<off_t>(end())) == 0);
    return error;
  }
  ++n_frames_;
  return {};
}

Result<void> FrameLog::sync() const {
  if (::fsync(file_.value()) != 0) return system_error("cannot bring to the disk " + path_.string());
  return {};
}

Result<std::unique_ptr<RecordedFrames>> open_frame_log(const std::filesystem::path& file) {
  return std::unique_ptr<RecordedFrames>(SHAKEN_TRY(LoggedFrames::open(file)));
}

Result<bool> is_frame_log(const std::filesystem::path& file) {
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!opened) {
    const Error error = system_error("cannot open " + file.string());
    return may_pass(error) ? Result<bool>(error) : false;
  }
  const Result<std::string> begin = read_at(opened.value(), 0, kFramesMagic.size());
  if (!begin && may_pass(begin.error())) return Error{file.string() + ": " + begin.error().message, begin.error().code};
  return begin && *begin == kFramesMagic;
}

}  // namespace shaken::run
