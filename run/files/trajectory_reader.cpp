#include <string>

#include "base/files.h"
#include "run/files/content_hash.h"
#include "run/files/hdf5.h"
#include "run/files/trajectory.h"
#include "run/files/trajectory_layout.h"

namespace shaken::run {
namespace {

using trajectory_layout::DataSets;

std::vector<double> read_doubles(hid_t where, const char* name) {
  return hdf5::read_vector<double>(hdf5::open_dataset(where, name), H5T_NATIVE_DOUBLE);
}

SideWalls read_walls(hid_t file) {
  const hdf5::Id group = hdf5::open_group(file, trajectory_layout::kWalls);
  const std::string name = hdf5::read_text_attribute(group, "arena");
  const std::optional<Arena> known = arena_of(name);
  if (!known) throw hdf5::Failure("there is no arena '" + name + "'");
  SideWalls walls;
  walls.arena = *known;
  hdf5::read_attribute(group, "size_mm", H5T_NATIVE_DOUBLE, &walls.size);
  if (walls.arena == Arena::kAnnulus) hdf5::read_attribute(group, "inner_mm", H5T_NATIVE_DOUBLE, &walls.inner);
  if (walls.has_length()) hdf5::read_attribute(group, "length_mm", H5T_NATIVE_DOUBLE, &walls.length);
  if (walls.arena == Arena::kWedge) hdf5::read_attribute(group, "narrow_mm", H5T_NATIVE_DOUBLE, &walls.narrow);
  hdf5::read_attribute(group, "friction", H5T_NATIVE_DOUBLE, &walls.contact.friction);
  hdf5::read_attribute(group, "restitution", H5T_NATIVE_DOUBLE, &walls.contact.restitution);
  return walls;
}

StandingPosts read_posts(hid_t file) {
  const hdf5::Id group = hdf5::open_group(file, trajectory_layout::kPosts);
  StandingPosts posts;
  hdf5::read_attribute(group, "diameter_mm", H5T_NATIVE_DOUBLE, &posts.diameter);
  const std::vector<double> x = read_doubles(group, "x_mm"), y = read_doubles(group, "y_mm");
  if (x.size() != y.size()) throw hdf5::Failure("not as many y as x of posts");
  for (std::size_t k = 0; k < x.size(); ++k) posts.centres.emplace_back(x[k], y[k]);
  return posts;
}

TrajectoryHeader read_header(hid_t file) {
  const hdf5::Id parameters = hdf5::open_group(file, "/parameters");
  TrajectoryHeader header;
  Cell& cell = header.cell;
  hdf5::read_attribute(parameters, "n_rods", H5T_NATIVE_INT, &header.n_rods);
  double x = 0;
  hdf5::read_attribute(parameters, "box_side_mm", H5T_NATIVE_DOUBLE, &x);
  double y = x;
  if (hdf5::has_attribute(parameters, "box_side_y_mm")) {
    hdf5::read_attribute(parameters, "box_side_y_mm", H5T_NATIVE_DOUBLE, &y);
  }
  cell.box = Box(x, y);
  hdf5::read_attribute(parameters, "gap_mm", H5T_NATIVE_DOUBLE, &cell.gap);
  hdf5::read_attribute(parameters, "dt_s", H5T_NATIVE_DOUBLE, &header.dt);
  header.scene_json = hdf5::read_string(parameters, "scene_json");
  header.provenance = hdf5::read_provenance(file);
  if (hdf5::exists(parameters, trajectory_layout::kLacking))
    header.lacking = hdf5::read_string(parameters, trajectory_layout::kLacking);
  const auto bytes = [file](const char* name) {
    return hdf5::read_vector<std::uint8_t>(hdf5::open_dataset(file, name), H5T_NATIVE_UINT8);
  };
  const bool has_sizes = hdf5::exists(file, trajectory_layout::kSpeciesOfShape);
  if (has_sizes) cell.species_of_shape = bytes(trajectory_layout::kSpeciesOfShape);
  const auto group_of = [&](std::size_t k) {
    return has_sizes ? trajectory_layout::shape(k) : trajectory_layout::beads_of(k);
  };
  for (std::size_t k = 0; k == 0 || hdf5::exists(file, group_of(k)); ++k) {
    const hdf5::Id group = hdf5::open_group(file, group_of(k).c_str());
    cell.shapes.push_back({read_doubles(group, "bead_offset_mm"), read_doubles(group, "bead_radius_mm")});
  }
  if (cell.shapes.size() > 1)
    cell.shape_of_rod = bytes(has_sizes ? trajectory_layout::kShape : trajectory_layout::kSpecies);
  if (hdf5::exists(file, trajectory_layout::kWalls)) cell.walls = read_walls(file);
  if (hdf5::exists(file, trajectory_layout::kPosts)) cell.posts = read_posts(file);
  if (auto done = check(header); !done) throw hdf5::Failure(done.error().message);
  return header;
}

class Hdf5Frames final : public RecordedFrames {
 public:
  /// Throws an hdf5::Failure.
  explicit Hdf5Frames(const std::filesystem::path& path)
      : path_(path), file_(hdf5::open_file(path, false)), header_(read_header(file_)), sets_(DataSets::open(file_)) {
    sets_.check_shapes(static_cast<std::size_t>(header_.n_rods));
    n_frames_ = sets_.n_rows();
  }

  const TrajectoryHeader& header() const override { return header_; }
  std::size_t n_frames() const override { return n_frames_; }
  Result<RecordedFrame> frame(std::size_t index) const override {
    const auto n_rods = static_cast<std::size_t>(header_.n_rods);
    RecordedFrame frame;
    frame.position.resize(3 * n_rods);
    frame.velocity.resize(3 * n_rods);
    frame.orientation.resize(4 * n_rods);
    frame.image.resize(3 * n_rods);
    try {
      hdf5::read_row(sets_.step, H5T_NATIVE_INT64, index, &frame.tick);
      hdf5::read_row(sets_.time, H5T_NATIVE_DOUBLE, index, &frame.time);
      hdf5::read_row(sets_.position, H5T_NATIVE_FLOAT, index, frame.position.data());
      hdf5::read_row(sets_.image, H5T_NATIVE_INT32, index, frame.image.data());
      hdf5::read_row(sets_.velocity, H5T_NATIVE_FLOAT, index, frame.velocity.data());
      hdf5::read_row(sets_.orientation, H5T_NATIVE_FLOAT, index, frame.orientation.data());
    } catch (const hdf5::Failure& failure) {
      return Error{path_.string() + ": frame " + std::to_string(index) + ": " + failure.what()};
    }
    return frame;
  }

 private:
  std::filesystem::path path_;
  hdf5::Id file_;
  TrajectoryHeader header_;
  DataSets sets_;
  std::size_t n_frames_ = 0;
};

}  // namespace

bool is_trajectory(const std::filesystem::path& file) {
  const Result<std::string> head = read_part(file, 0, 8);
  const Result<bool> is_log = is_frame_log(file);
  return (is_log && *is_log) || (head && *head == "\x89HDF\r\n\x1a\n");
}

Result<TrajectoryReader> TrajectoryReader::open(const std::filesystem::path& file) {
  const bool is_log = SHAKEN_TRY(is_frame_log(file));
  if (is_log) {
    return TrajectoryReader(file, SHAKEN_TRY(open_frame_log(file)));
  }
  SHAKEN_TRY(check_content(file));
  hdf5::initialize();
  try {
    return TrajectoryReader(file, std::make_unique<Hdf5Frames>(file));
  } catch (const hdf5::Failure& failure) {
    return Error{file.string() + ": " + failure.what()};
  }
}

Result<Snapshot> TrajectoryReader::frame(std::size_t index) const {
  if (index >= n_frames()) {
    return Error{path_.string() + " has no frame " + std::to_string(index) + "; it has " + std::to_string(n_frames())};
  }
  Result<Snapshot> frame = decode(SHAKEN_TRY(frames_->frame(index)), header().cell.box, !header().lacking.empty());
  if (!frame) return Error{path_.string() + ": frame " + std::to_string(index) + ": " + frame.error().message};
  return frame;
}

}  // namespace shaken::run
