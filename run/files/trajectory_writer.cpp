// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>

#include "run/files/hdf5.h"
#include "run/files/quaternion.h"
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

void write_beads(hid_t where, const std::vector<double>& offset, const std::vector<double>& radius) {
  for (const auto& [name, values] : {std::pair{"bead_offset_mm", &offset}, {"bead_radius_mm", &radius}}) {
    hdf5::write_dataset(where, name, H5T_NATIVE_DOUBLE, {values->size()}, values->data());
    hdf5::write_unit(hdf5::open_dataset(where, name), "mm");
  }
}

void write_walls(hid_t file, const SideWalls& walls) {
  const hdf5::Id group = hdf5::create_group(file, trajectory_layout::kWalls);
  hdf5::write_attribute(group, "arena", name_of(walls.arena));
  hdf5::write_attribute(group, "size_mm", H5T_NATIVE_DOUBLE, {}, &walls.size);
  if (walls.arena == Arena::kAnnulus) hdf5::write_attribute(group, "inner_mm", H5T_NATIVE_DOUBLE, {}, &walls.inner);
  hdf5::write_attribute(group, "friction", H5T_NATIVE_DOUBLE, {}, &walls.contact.friction);
  hdf5::write_attribute(group, "restitution", H5T_NATIVE_DOUBLE, {}, &walls.contact.restitution);
}

void write_parameters(hid_t file, const TrajectoryHeader& header) {
  const hdf5::Id parameters = hdf5::create_group(file, "parameters");
  hdf5::write_attribute(parameters, "n_rods", H5T_NATIVE_INT, {}, &header.n_rods);
  hdf5::write_attribute(parameters, "box_side_mm", H5T_NATIVE_DOUBLE, {}, &header.box_side);
  hdf5::write_attribute(parameters, "gap_mm", H5T_NATIVE_DOUBLE, {}, &header.gap);
  hdf5::write_attribute(parameters, "dt_s", H5T_NATIVE_DOUBLE, {}, &header.dt);
  write_beads(parameters, header.bead_offset, header.bead_radius);
  hdf5::write_string(parameters, "scene_json", header.scene_json);
  for (std::size_t k = 0; k < header.added_beads.size(); ++k) {
    const hdf5::Id group = hdf5::create_group(file, trajectory_layout::added_beads(k));
    write_beads(group, header.added_beads[k].offset, header.added_beads[k].radius);
  }
  if (header.walls) write_walls(file, *header.walls);
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
  hdf5::write_attribute(box, "boundary", {"periodic", "periodic", "none"});

  const auto n_rods = static_cast<hsize_t>(header.n_rods);
  if (!header.added_beads.empty()) {
    hdf5::write_dataset(file, trajectory_layout::kSpecies, H5T_NATIVE_UINT8, {header.species_of_rod.size()},
                        header.species_of_rod.data());
  }
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

int descriptor(hid_t file) {
  void* handle = nullptr;
  hdf5::check(H5Fget_vfd_handle(file, H5P_DEFAULT, &handle), "look at the file");
  return *static_cast<const int*>(handle);
}

off_t end_of_content(hid_t file) {
  haddr_t end = 0;
  hdf5::check(H5Fget_eoa(file, &end), "look at the file");
  return static_cast<off_t>(end);
}

/// Makes the file system set `bytes` aside behind the content, or throws. A flush that fails halfway for want of space
/// can leave a file that HDF5 does not open again; with this, a full disk is met before anything is written.
void reserve(hid_t file, std::size_t bytes) {
  const int reason = posix_fallocate(descriptor(file), end_of_content(file), static_cast<off_t>(bytes));
  if (reason != 0) throw hdf5::Failure(std::string("no room for another frame: ") + std::strerror(reason));
}

/// Gives back what was reserved and not used.
void release(hid_t file) {
  if (ftruncate(descriptor(file), end_of_content(file)) != 0) {
    throw hdf5::Failure(std::string("cannot set the file's size: ") + std::strerror(errno));
  }
}

/// Rounds to float without leaving [0, side): 83.7299999999 must not become 83.73.
float wrapped_float(double x, double side) {
  auto rounded = static_cast<float>(x);
  while (rounded > 0 && static_cast<double>(rounded) >= side) rounded = std::nextafterf(rounded, 0.0F);
  return rounded;
}

}  // namespace

struct TrajectoryWriter::Impl {
  std::filesystem::path path;
  hdf5::Id file;
  DataSets sets;
  std::size_t n_rods = 0;
  double box_side = 0;
  double gap = 0;
  std::size_t n_frames = 0;

  /// More than a frame can take: its arrays uncompressed, and what HDF5 needs to find them again.
  std::size_t most_bytes_per_frame() const {
    constexpr std::size_t kIndexBytes = 1 << 16;
    return n_rods * (3 + 3 + 3 + 4) * sizeof(float) * 9 / 8 + kIndexBytes;
  }

  void append(const Snapshot& snapshot) {
    std::vector<float> position, velocity, orientation;
    std::vector<std::int32_t> image;
    for (std::size_t i = 0; i < n_rods; ++i) {
      const Vec3& x = snapshot.position[i];
      const Vec3& v = snapshot.velocity[i];
      position.insert(position.end(),
                      {wrapped_float(x.x(), box_side), wrapped_float(x.y(), box_side), static_cast<float>(x.z())});
      velocity.insert(velocity.end(),
                      {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())});
      for (const double q : quaternion_of_director(snapshot.director[i])) orientation.push_back(static_cast<float>(q));
      image.insert(image.end(), {snapshot.image[i][0], snapshot.image[i][1], 0});
    }
    reserve(file, most_bytes_per_frame());
    const std::array<double, 9> edges{box_side, 0, 0, 0, box_side, 0, 0, 0, gap};
    hdf5::append_row(sets.position, H5T_NATIVE_FLOAT, position.data());
    hdf5::append_row(sets.image, H5T_NATIVE_INT32, image.data());
    hdf5::append_row(sets.velocity, H5T_NATIVE_FLOAT, velocity.data());
    hdf5::append_row(sets.orientation, H5T_NATIVE_FLOAT, orientation.data());
    hdf5::append_row(sets.edges, H5T_NATIVE_DOUBLE, edges.data());
    hdf5::append_row(sets.time, H5T_NATIVE_DOUBLE, &snapshot.time);
    hdf5::append_row(sets.step, H5T_NATIVE_INT64, &snapshot.tick);
    hdf5::check(H5Fflush(file, H5F_SCOPE_GLOBAL), "write a frame");
    release(file);
    ++n_frames;
  }
};

Result<TrajectoryWriter> TrajectoryWriter::create(const std::filesystem::path& file, const TrajectoryHeader& header) {
  hdf5::be_quiet();
  try {
    hdf5::Id out = hdf5::create_file(file);
    hdf5::write_provenance(out, header.provenance);
    write_h5md_group(out);
    write_parameters(out, header);
    write_particles(out, header);
    hdf5::check(H5Fflush(out, H5F_SCOPE_GLOBAL), "write the header");
    DataSets sets = DataSets::open(out);
    return TrajectoryWriter(
        std::make_unique<Impl>(Impl{file, std::move(out), std::move(sets), static_cast<std::size_t>(header.n_rods),
                                    header.box_side, header.gap, 0}));
  } catch (const hdf5::Failure& failure) {
    return Error{file.string() + ": " + failure.what()};
  }
}

Result<TrajectoryWriter> TrajectoryWriter::reopen(const std::filesystem::path& file, Tick last) {
  TrajectoryHeader header;
  std::size_t n_whole = 0;
  {
    // The reader knows which frames are whole. It must be gone before the file is opened for writing.
    const Result<TrajectoryReader> reader = TrajectoryReader::open(file);
    if (!reader) return reader.error();
    header = reader->header();
    n_whole = reader->n_frames();
  }
  try {
    hdf5::Id out = hdf5::open_file(file, true);
    DataSets sets = DataSets::open(out);
    std::vector<Tick> ticks = hdf5::read_vector<Tick>(sets.step, H5T_NATIVE_INT64);
    ticks.resize(std::min(ticks.size(), n_whole));
    const auto n_kept = static_cast<std::size_t>(std::upper_bound(ticks.begin(), ticks.end(), last) - ticks.begin());
    for (const hid_t dataset : sets.all()) hdf5::resize_rows(dataset, n_kept);
    hdf5::check(H5Fflush(out, H5F_SCOPE_GLOBAL), "trim the file");
    return TrajectoryWriter(
        std::make_unique<Impl>(Impl{file, std::move(out), std::move(sets), static_cast<std::size_t>(header.n_rods),
                                    header.box_side, header.gap, n_kept}));
  } catch (const hdf5::Failure& failure) {
    return Error{file.string() + ": " + failure.what()};
  }
}

TrajectoryWriter::TrajectoryWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TrajectoryWriter::TrajectoryWriter(TrajectoryWriter&&) noexcept = default;
TrajectoryWriter& TrajectoryWriter::operator=(TrajectoryWriter&&) noexcept = default;
TrajectoryWriter::~TrajectoryWriter() = default;

std::size_t TrajectoryWriter::n_frames() const { return impl_->n_frames; }

Result<void> TrajectoryWriter::append(const Snapshot& snapshot) {
  if (snapshot.n_rods() != impl_->n_rods) {
    return Error{impl_->path.string() + " holds " + std::to_string(impl_->n_rods) + " rods, the frame has " +
                 std::to_string(snapshot.n_rods())};
  }
  try {
    impl_->append(snapshot);
    return {};
  } catch (const hdf5::Failure& failure) {
    return Error{impl_->path.string() + ": " + failure.what()};
  }
}

}  // namespace shaken::run
