#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "run/files/hdf5.h"

/// What writer and reader of trajectory.h5 both know of the file. The shape of it follows what readers in use accept:
/// MDAnalysis 2.4 wants time-dependent (frames, 3, 3) box edges and an explicit step array; it knows no millimetre
/// until it is told (docs/files.md).
namespace shaken::run::trajectory_layout {

inline constexpr const char* kGroup = "/particles/trajectory";
inline constexpr std::array<const char*, 5> kElements{"position", "image", "velocity", "orientation", "box/edges"};
inline constexpr const char* kStep = "/particles/trajectory/position/step";
inline constexpr const char* kTime = "/particles/trajectory/position/time";

/// (n_rods) species of each rod, from 0; only where there are several.
inline constexpr const char* kSpecies = "/particles/trajectory/species";
/// (n_rods) shape of each rod, and (n_shapes) the species of each shape; only where rods of a species differ in size.
inline constexpr const char* kShape = "/particles/trajectory/shape";
inline constexpr const char* kSpeciesOfShape = "/parameters/species_of_shape";
inline constexpr const char* kLacking = "lacking";  ///< in /parameters
inline constexpr const char* kWalls = "/parameters/walls";
inline constexpr const char* kPosts = "/parameters/posts";
/// Where the beads of species k are: they are counted from 1, as the scene's rods, rods_2 are.
inline std::string beads_of(std::size_t k) {
  return "/parameters" + (k == 0 ? "" : "/species_" + std::to_string(k + 1));
}

/// Where, in place of that, the beads of shape k are.
inline std::string shape(std::size_t k) { return "/parameters" + (k == 0 ? "" : "/shape_" + std::to_string(k + 1)); }

inline std::string values_of(const char* element) { return std::string(kGroup).append("/").append(element) + "/value"; }

/// The data sets that grow by one row with each frame.
struct DataSets {
  hdf5::Id step, time, position, image, velocity, orientation, edges;

  static DataSets open(hid_t file) {
    return {hdf5::open_dataset(file, kStep),
            hdf5::open_dataset(file, kTime),
            hdf5::open_dataset(file, values_of("position")),
            hdf5::open_dataset(file, values_of("image")),
            hdf5::open_dataset(file, values_of("velocity")),
            hdf5::open_dataset(file, values_of("orientation")),
            hdf5::open_dataset(file, values_of("box/edges"))};
  }
  std::array<hid_t, 7> all() const { return {step, time, position, image, velocity, orientation, edges}; }

  /// Frames that every data set has.
  std::size_t n_rows() const {
    hsize_t n = H5S_UNLIMITED;
    for (const hid_t dataset : all()) n = std::min(n, hdf5::shape(dataset).at(0));
    return n;
  }
  /// Throws unless position, image, velocity and orientation have the shapes of `n_rods` rods.
  void check_shapes(std::size_t n_rods) const {
    const auto expect = [&](hid_t dataset, hsize_t columns, const char* name) {
      const hdf5::Shape extent = hdf5::shape(dataset);
      if (extent.size() != 3 || extent[1] != n_rods || extent[2] != columns) {
        throw hdf5::Failure(std::string(name) + " does not have the shape (frames, n_rods, " + std::to_string(columns) +
                            ")");
      }
    };
    expect(position, 3, "position");
    expect(image, 3, "image");
    expect(velocity, 3, "velocity");
    expect(orientation, 4, "orientation");
  }
};

}  // namespace shaken::run::trajectory_layout
