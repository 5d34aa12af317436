#include <array>
#include <utility>

#include "base/files.h"
#include "run/files/hdf5.h"
#include "run/files/trajectory.h"
#include "run/files/trajectory_layout.h"
#include "run/files/version.h"

namespace shaken::run {
namespace {

using trajectory_layout::DataSets;

/// Rows of step, time and box edges in one chunk; the large arrays have one frame per chunk.
constexpr hsize_t kSmallRows = 256;

void write_h5md_group(hid_t file) {
  const hdf5::Id h5md = hdf5::create_group(file, "h5md");
  const std::array<int, 2> format{1, 1};
  hdf5::write_attribute(h5md, "version", H5T_NATIVE_INT, {2}, format.data());
  hdf5::write_attribute(hdf5::create_group(h5md, "author"), "name", "unknown");
  const hdf5::Id creator = hdf5::create_group(h5md, "creator");
  hdf5::write_attribute(creator, "name", "Shaken");
  hdf5::write_attribute(creator, "version", version());
  const hdf5::Id units = hdf5::create_group(hdf5::create_group(h5md, "modules"), "units");
  const std::array<int, 2> units_version{1, 0};
  hdf5::write_attribute(units, "version", H5T_NATIVE_INT, {2}, units_version.data());
  hdf5::write_attribute(units, "system", "SI");
}

void write_beads(hid_t where, const BeadRow& beads) {
  for (const auto& [name, values] : {std::pair{"bead_offset_mm", &beads.offset}, {"bead_radius_mm", &beads.radius}}) {
    hdf5::write_dataset(where, name, H5T_NATIVE_DOUBLE, {values->size()}, values->data());
    hdf5::write_unit(hdf5::open_dataset(where, name), "mm");
  }
}

void write_walls(hid_t file, const SideWalls& walls) {
  const hdf5::Id group = hdf5::create_group(file, trajectory_layout::kWalls);
  hdf5::write_attribute(group, "arena", name_of(walls.arena));
  hdf5::write_attribute(group, "size_mm", H5T_NATIVE_DOUBLE, {}, &walls.size);
  if (walls.arena == Arena::kAnnulus) hdf5::write_attribute(group, "inner_mm", H5T_NATIVE_DOUBLE, {}, &walls.inner);
  if (walls.has_length()) hdf5::write_attribute(group, "length_mm", H5T_NATIVE_DOUBLE, {}, &walls.length);
  if (walls.arena == Arena::kWedge) hdf5::write_attribute(group, "narrow_mm", H5T_NATIVE_DOUBLE, {}, &walls.narrow);
  hdf5::write_attribute(group, "friction", H5T_NATIVE_DOUBLE, {}, &walls.contact.friction);
  hdf5::write_attribute(group, "restitution", H5T_NATIVE_DOUBLE, {}, &walls.contact.restitution);
}

void write_posts(hid_t file, const StandingPosts& posts) {
  const hdf5::Id group = hdf5::create_group(file, trajectory_layout::kPosts);
  hdf5::write_attribute(group, "diameter_mm", H5T_NATIVE_DOUBLE, {}, &posts.diameter);
  for (const auto& [name, axis] : {std::pair{"x_mm", 0}, {"y_mm", 1}}) {
    std::vector<double> places;
    for (const Vec2& centre : posts.centres) places.push_back(centre[axis]);
    hdf5::write_dataset(group, name, H5T_NATIVE_DOUBLE, {places.size()}, places.data());
    hdf5::write_unit(hdf5::open_dataset(group, name), "mm");
  }
}

void write_parameters(hid_t file, const TrajectoryHeader& header) {
  const hdf5::Id parameters = hdf5::create_group(file, "parameters");
  hdf5::write_attribute(parameters, "n_rods", H5T_NATIVE_INT, {}, &header.n_rods);
  const double x = header.cell.box.x(), y = header.cell.box.y();
  hdf5::write_attribute(parameters, "box_side_mm", H5T_NATIVE_DOUBLE, {}, &x);
  if (y != x) hdf5::write_attribute(parameters, "box_side_y_mm", H5T_NATIVE_DOUBLE, {}, &y);
  hdf5::write_attribute(parameters, "gap_mm", H5T_NATIVE_DOUBLE, {}, &header.cell.gap);
  hdf5::write_attribute(parameters, "dt_s", H5T_NATIVE_DOUBLE, {}, &header.dt);
  write_beads(parameters, header.cell.shapes.at(0));
  hdf5::write_string(parameters, "scene_json", header.scene_json);
  if (!header.lacking.empty()) hdf5::write_string(parameters, trajectory_layout::kLacking, header.lacking);
  const auto& species_of_shape = header.cell.species_of_shape;
  for (std::size_t k = 1; k < header.cell.shapes.size(); ++k) {
    const std::string group = species_of_shape.empty() ? trajectory_layout::beads_of(k) : trajectory_layout::shape(k);
    write_beads(hdf5::create_group(file, group), header.cell.shapes[k]);
  }
  if (!species_of_shape.empty()) {
    hdf5::write_dataset(file, trajectory_layout::kSpeciesOfShape, H5T_NATIVE_UINT8, {species_of_shape.size()},
                        species_of_shape.data());
  }
  if (header.cell.walls) write_walls(file, *header.cell.walls);
  if (!header.cell.posts.centres.empty()) write_posts(file, header.cell.posts);
}

void hard_link(hid_t file, const std::string& existing, const std::string& name) {
  hdf5::check(H5Lcreate_hard(file, existing.c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), "link " + name);
}

void write_particles(hid_t file, const TrajectoryHeader& header) {
  const hdf5::Id particles = hdf5::create_group(file, "particles");
  const hdf5::Id trajectory = hdf5::create_group(particles, "trajectory");
  const hdf5::Id box = hdf5::create_group(trajectory, "box");
  const int dimension = 3;
  hdf5::write_attribute(box, "dimension", H5T_NATIVE_INT, {}, &dimension);
  const auto word = [](double period) { return period > 0 ? "periodic" : "none"; };
  hdf5::write_attribute(box, "boundary", {word(header.cell.period().x()), word(header.cell.period().y()), "none"});

  const auto n_rods = static_cast<hsize_t>(header.n_rods);
  const auto write_of_rods = [&](const char* name, const std::vector<std::uint8_t>& values) {
    hdf5::write_dataset(file, name, H5T_NATIVE_UINT8, {values.size()}, values.data());
  };
  if (header.cell.n_species() > 1) write_of_rods(trajectory_layout::kSpecies, header.cell.species_of_rods());
  if (!header.cell.species_of_shape.empty()) write_of_rods(trajectory_layout::kShape, header.cell.shape_of_rod);
  for (const char* element : trajectory_layout::kElements) hdf5::create_group(trajectory, element);
  const hdf5::Id position = hdf5::open_group(trajectory, "position");
  hdf5::create_growing(position, "step", H5T_NATIVE_INT64, {}, kSmallRows, false);
  hdf5::create_growing(position, "time", H5T_NATIVE_DOUBLE, {}, kSmallRows, false);
  hdf5::create_growing(trajectory, "position/value", H5T_NATIVE_FLOAT, {n_rods, 3}, 1, true);
  hdf5::create_growing(trajectory, "image/value", H5T_NATIVE_INT32, {n_rods, 3}, 1, true);
  hdf5::create_growing(trajectory, "velocity/value", H5T_NATIVE_FLOAT, {n_rods, 3}, 1, true);
  hdf5::create_growing(trajectory, "orientation/value", H5T_NATIVE_FLOAT, {n_rods, 4}, 1, true);
  hdf5::create_growing(trajectory, "box/edges/value", H5T_NATIVE_DOUBLE, {3, 3}, kSmallRows, false);
  for (const auto& [dataset, unit] : {std::pair{"position/time", "s"},
                                      {"position/value", "mm"},
                                      {"velocity/value", "mm s-1"},
                                      {"box/edges/value", "mm"}}) {
    hdf5::write_unit(hdf5::open_dataset(trajectory, dataset), unit);
  }
  for (const char* element : trajectory_layout::kElements) {
    const std::string group = std::string(trajectory_layout::kGroup) + "/" + element;
    if (group + "/step" == trajectory_layout::kStep) continue;
    hard_link(file, trajectory_layout::kStep, group + "/step");
    hard_link(file, trajectory_layout::kTime, group + "/time");
  }
}

/// Adds one row to each data set.
void append(const DataSets& sets, const TrajectoryHeader& header, const RecordedFrame& frame) {
  const std::array<double, 9> edges{header.cell.box.x(), 0, 0, 0, header.cell.box.y(), 0, 0, 0, header.cell.gap};
  hdf5::append_row(sets.position, H5T_NATIVE_FLOAT, frame.position.data());
  hdf5::append_row(sets.image, H5T_NATIVE_INT32, frame.image.data());
  hdf5::append_row(sets.velocity, H5T_NATIVE_FLOAT, frame.velocity.data());
  hdf5::append_row(sets.orientation, H5T_NATIVE_FLOAT, frame.orientation.data());
  hdf5::append_row(sets.edges, H5T_NATIVE_DOUBLE, edges.data());
  hdf5::append_row(sets.time, H5T_NATIVE_DOUBLE, &frame.time);
  hdf5::append_row(sets.step, H5T_NATIVE_INT64, &frame.tick);
}

/// Throws an hdf5::Failure.
void write_file(const std::filesystem::path& path, const TrajectoryHeader& header, const RecordedFrames& frames) {
  hdf5::Id file = hdf5::create_file(path);
  hdf5::write_provenance(file, header.provenance);
  write_h5md_group(file);
  write_parameters(file, header);
  write_particles(file, header);
  {
    const DataSets sets = DataSets::open(file);
    for (std::size_t i = 0; i < frames.n_frames(); ++i) {
      const Result<RecordedFrame> frame = frames.frame(i);
      if (!frame) throw hdf5::Failure(frame.error().message);
      append(sets, header, *frame);
    }
    // Here, for data sets that are closed with their last chunks unwritten have no way to say so.
    hdf5::check(H5Fflush(file, H5F_SCOPE_GLOBAL), "write frames");
  }
  file.close("write the file");
}

}  // namespace

Result<void> write_trajectory(const std::filesystem::path& file, const RecordedFrames& frames) {
  return write_trajectory(file, frames.header(), frames);
}

Result<void> write_trajectory(const std::filesystem::path& file, const TrajectoryHeader& header,
                              const RecordedFrames& frames) {
  hdf5::initialize();
  UnfinishedFile unfinished(file);
  try {
    write_file(unfinished.path(), header, frames);
  } catch (const hdf5::Failure& failure) {
    return Error{file.string() + ": " + failure.what()};
  }
  return unfinished.replace();
}

Result<FrameLog> reopen_frames(const RunDirectory& directory, std::size_t n_frames) {
  const bool is_logged = SHAKEN_TRY(file_exists(directory.frames()));
  const bool is_written = SHAKEN_TRY(file_exists(directory.trajectory()));
  if (is_logged || !is_written) {
    return FrameLog::reopen(directory.frames(), n_frames);
  }
  const TrajectoryReader trajectory = SHAKEN_TRY(TrajectoryReader::open(directory.trajectory()));
  if (trajectory.n_frames() < n_frames) {
    return Error{directory.trajectory().string() + " has " + std::to_string(trajectory.n_frames()) +
                 " frames instead of " + std::to_string(n_frames)};
  }
  UnfinishedFile unfinished(directory.frames());
  FrameLog log = SHAKEN_TRY(FrameLog::create(unfinished.path(), trajectory.header()));
  for (std::size_t i = 0; i < n_frames; ++i) {
    const RecordedFrame frame = SHAKEN_TRY(trajectory.recorded().frame(i));
    SHAKEN_TRY(log.append(frame));
  }
  SHAKEN_TRY(unfinished.replace());
  return FrameLog::reopen(directory.frames(), n_frames);
}

}  // namespace shaken::run
