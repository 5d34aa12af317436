// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "run/files/hdf5.h"
#include "run/files/quaternion.h"
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
  hdf5::read_attribute(group, "friction", H5T_NATIVE_DOUBLE, &walls.contact.friction);
  hdf5::read_attribute(group, "restitution", H5T_NATIVE_DOUBLE, &walls.contact.restitution);
  return walls;
}

/// The other species, and which rod is of which.
void read_species(hid_t file, TrajectoryHeader& header) {
  for (std::size_t k = 0; hdf5::exists(file, trajectory_layout::added_beads(k)); ++k) {
    const hdf5::Id group = hdf5::open_group(file, trajectory_layout::added_beads(k));
    header.added_beads.push_back({read_doubles(group, "bead_offset_mm"), read_doubles(group, "bead_radius_mm")});
  }
  if (header.added_beads.empty()) return;
  header.species_of_rod =
      hdf5::read_vector<std::uint8_t>(hdf5::open_dataset(file, trajectory_layout::kSpecies), H5T_NATIVE_UINT8);
  if (header.species_of_rod.size() != static_cast<std::size_t>(header.n_rods)) {
    throw hdf5::Failure("species does not have the shape (n_rods)");
  }
  if (std::any_of(header.species_of_rod.begin(), header.species_of_rod.end(),
                  [&](std::uint8_t kind) { return kind > header.added_beads.size(); })) {
    throw hdf5::Failure("species names a species whose beads are not there");
  }
}

TrajectoryHeader read_header(hid_t file) {
  const hdf5::Id parameters = hdf5::open_group(file, "/parameters");
  TrajectoryHeader header;
  hdf5::read_attribute(parameters, "n_rods", H5T_NATIVE_INT, &header.n_rods);
  hdf5::read_attribute(parameters, "box_side_mm", H5T_NATIVE_DOUBLE, &header.box_side);
  hdf5::read_attribute(parameters, "gap_mm", H5T_NATIVE_DOUBLE, &header.gap);
  hdf5::read_attribute(parameters, "dt_s", H5T_NATIVE_DOUBLE, &header.dt);
  header.bead_offset = read_doubles(parameters, "bead_offset_mm");
  header.bead_radius = read_doubles(parameters, "bead_radius_mm");
  header.scene_json = hdf5::read_string(parameters, "scene_json");
  if (header.n_rods < 0) throw hdf5::Failure("n_rods is negative");
  read_species(file, header);
  if (hdf5::exists(file, trajectory_layout::kWalls)) header.walls = read_walls(file);
  return header;
}

/// Throws if a row cannot be read, or was not written to its end.
TrajectoryFrame read_frame(const DataSets& sets, std::size_t n_rods, std::size_t index) {
  std::vector<float> position(3 * n_rods), velocity(3 * n_rods), orientation(4 * n_rods);
  std::vector<std::int32_t> image(3 * n_rods);
  TrajectoryFrame frame;
  hdf5::read_row(sets.step, H5T_NATIVE_INT64, index, &frame.tick);
  hdf5::read_row(sets.time, H5T_NATIVE_DOUBLE, index, &frame.time);
  hdf5::read_row(sets.position, H5T_NATIVE_FLOAT, index, position.data());
  hdf5::read_row(sets.image, H5T_NATIVE_INT32, index, image.data());
  hdf5::read_row(sets.velocity, H5T_NATIVE_FLOAT, index, velocity.data());
  hdf5::read_row(sets.orientation, H5T_NATIVE_FLOAT, index, orientation.data());
  for (std::size_t i = 0; i < n_rods; ++i) {
    const std::array<double, 4> q{orientation[4 * i], orientation[4 * i + 1], orientation[4 * i + 2],
                                  orientation[4 * i + 3]};
    const double norm2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    // A chunk that never reached the file reads as zeros.
    if (!(std::abs(norm2 - 1) < 1e-3)) throw hdf5::Failure("a direction is not of unit length: the frame is torn");
    frame.position.emplace_back(position[3 * i], position[3 * i + 1], position[3 * i + 2]);
    frame.velocity.emplace_back(velocity[3 * i], velocity[3 * i + 1], velocity[3 * i + 2]);
    frame.director.push_back(director_of_quaternion(q));
    frame.image.push_back({image[3 * i], image[3 * i + 1]});
  }
  return frame;
}

bool readable(const DataSets& sets, std::size_t n_rods, std::size_t index) {
  try {
    read_frame(sets, n_rods, index);
    return true;
  } catch (const hdf5::Failure&) {
    return false;
  }
}

}  // namespace

struct TrajectoryReader::Impl {
  std::filesystem::path path;
  hdf5::Id file;
  TrajectoryHeader header;
  DataSets sets;
  std::size_t n_frames = 0;

  explicit Impl(const std::filesystem::path& where)
      : path(where), file(hdf5::open_file(where, false)), header(read_header(file)), sets(DataSets::open(file)) {
    const auto n_rods = static_cast<std::size_t>(header.n_rods);
    sets.check_shapes(n_rods);
    n_frames = sets.n_rows();
    // Frames are written one after the other, so only the last can be torn.
    if (n_frames > 0 && !readable(sets, n_rods, n_frames - 1)) --n_frames;
  }
};

Result<TrajectoryReader> TrajectoryReader::open(const std::filesystem::path& file) {
  hdf5::be_quiet();
  // A writer may be halfway through a flush at this instant: its file is whole again within milliseconds.
  constexpr int kAttempts = 5;
  constexpr std::chrono::milliseconds kPause{50};
  for (int attempt = 1;; ++attempt) {
    try {
      return TrajectoryReader(std::make_unique<Impl>(file));
    } catch (const hdf5::Failure& failure) {
      if (attempt == kAttempts || !std::filesystem::exists(file)) return Error{file.string() + ": " + failure.what()};
      std::this_thread::sleep_for(kPause);
    }
  }
}

TrajectoryReader::TrajectoryReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TrajectoryReader::TrajectoryReader(TrajectoryReader&&) noexcept = default;
TrajectoryReader& TrajectoryReader::operator=(TrajectoryReader&&) noexcept = default;
TrajectoryReader::~TrajectoryReader() = default;

const TrajectoryHeader& TrajectoryReader::header() const { return impl_->header; }
std::size_t TrajectoryReader::n_frames() const { return impl_->n_frames; }

Result<TrajectoryFrame> TrajectoryReader::frame(std::size_t index) const {
  if (index >= impl_->n_frames) {
    return Error{impl_->path.string() + " has no frame " + std::to_string(index) + "; it has " +
                 std::to_string(impl_->n_frames)};
  }
  try {
    return read_frame(impl_->sets, static_cast<std::size_t>(impl_->header.n_rods), index);
  } catch (const hdf5::Failure& failure) {
    return Error{impl_->path.string() + ": frame " + std::to_string(index) + ": " + failure.what()};
  }
}

}  // namespace shaken::run
