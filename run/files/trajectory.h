// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "run/files/provenance.h"
#include "sim/core/bead_row.h"
#include "sim/core/result.h"
#include "sim/snapshot.h"
#include "sim/system.h"

namespace shaken::run {

/// What does not change along a trajectory, and what drawing it needs.
struct TrajectoryHeader {
  int n_rods = 0;
  double box_side = 0;                         ///< [mm]
  double gap = 0;                              ///< [mm]
  double dt = 0;                               ///< [s]
  std::vector<double> bead_offset;             ///< (n_beads) of the first species, along it from its centre [mm]
  std::vector<double> bead_radius;             ///< (n_beads) [mm]
  std::string scene_json;                      ///< the resolved scene
  std::vector<BeadRow> added_beads{};          ///< of the other species
  std::vector<std::uint8_t> species_of_rod{};  ///< (n_rods) species of each rod, from 0; empty if there is one
  std::optional<SideWalls> walls{};            ///< of the arena, if there are any
  Provenance provenance{};                     ///< written, not read back
};

/// One recorded frame: positions wrapped into the box, float32 in the file.
struct TrajectoryFrame {
  Tick tick = 0;
  double time = 0;             ///< [s]
  std::vector<Vec3> position;  ///< [mm]
  std::vector<Vec3> director;  ///< unit vectors
  std::vector<Vec3> velocity;  ///< [mm/s]
  std::vector<std::array<std::int32_t, 2>> image;
};

/// Writes trajectory.h5 in H5MD (de Buyl, Colberg, Hoefling 2014): /particles/trajectory/{position, image, velocity,
/// orientation, box}, where orientation is the unit quaternion (w, x, y, z) that turns z into the director; with
/// several species also H5MD's fixed element `species`, the species of each rod from 0, whose beads stand in
/// /parameters and /parameters/species_2, species_3. Side walls are the attributes of /parameters/walls. Units are
/// those of H5MD's module "units", in the attribute `unit` of each data set (docs/files.md). A frame is
/// with the operating system when `append` returns; a torn last frame is left out by the reader and trimmed on
/// reopening. Chunks carry checksums. No SWMR: a killed SWMR file cannot be opened without repair.
class TrajectoryWriter {
 public:
  static Result<TrajectoryWriter> create(const std::filesystem::path& file, const TrajectoryHeader& header);
  /// Opens an existing file to go on after tick `last`: later frames, and a torn one, are cut off.
  static Result<TrajectoryWriter> reopen(const std::filesystem::path& file, Tick last);
  TrajectoryWriter(TrajectoryWriter&&) noexcept;
  TrajectoryWriter& operator=(TrajectoryWriter&&) noexcept;
  ~TrajectoryWriter();
  Result<void> append(const Snapshot& snapshot);
  std::size_t n_frames() const;

 private:
  struct Impl;
  explicit TrajectoryWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Reads trajectory.h5, also while it is being written.
class TrajectoryReader {
 public:
  static Result<TrajectoryReader> open(const std::filesystem::path& file);
  TrajectoryReader(TrajectoryReader&&) noexcept;
  TrajectoryReader& operator=(TrajectoryReader&&) noexcept;
  ~TrajectoryReader();
  const TrajectoryHeader& header() const;
  std::size_t n_frames() const;
  Result<TrajectoryFrame> frame(std::size_t index) const;

 private:
  struct Impl;
  explicit TrajectoryReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace shaken::run
