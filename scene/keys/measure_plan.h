#pragma once

#include <algorithm>
#include <optional>

namespace shaken::scene {

// The settings of each observable, with their defaults: the block "measure.NAME" of a scene. Their keys, ranges and
// descriptions are in scene/keys/observables.cpp.

/// When to sample the in-plane nematic order S(t).
struct MeasureOrder {
  double every = 0.01;  ///< [s]
  friend bool operator==(const MeasureOrder&, const MeasureOrder&) = default;
};
/// Distribution of the angle to the director.
struct MeasureAngles {
  double every = 0.01;  ///< [s]
  int bins = 180;       ///< over [-pi/2, pi/2)
  friend bool operator==(const MeasureAngles&, const MeasureAngles&) = default;
};
/// At which phases of the plates' vibration samples are taken of what depends on them.
enum class SamplePhases {
  kSpread,  ///< at an instant of each interval between samples that is drawn from the seed: at all phases alike
  kLocked,  ///< at whole multiples of the interval: at few phases, where that is a simple multiple of the period
};
/// Mean velocity along and across the rod against its tilt n_z.
struct MeasureTilt {
  double every = 0.001;  ///< [s]
  int bins = 40;         ///< over [-1, 1] in n_z times the largest tilt that the gap allows
  SamplePhases phases = SamplePhases::kSpread;
  friend bool operator==(const MeasureTilt&, const MeasureTilt&) = default;
};
/// Topological defects of the smoothed director field.
struct MeasureDefects {
  double every = 0.1;         ///< [s]
  double smoothing = 0.0;     ///< standard deviation of the Gaussian [mm]; 0: what smoothing_for() says
  double grid = 0.0;          ///< mesh width [mm]; 0: what grid_for() says
  bool list = false;          ///< whether every defect found is kept, which takes memory in proportion to the run
  double min_lifetime = 0.5;  ///< of tracks that count as lasting [s]
  double smoothing_for(double rod_length) const { return smoothing > 0 ? smoothing : rod_length / 2; }
  double grid_for(double rod_length) const { return grid > 0 ? grid : rod_length / 8; }
  friend bool operator==(const MeasureDefects&, const MeasureDefects&) = default;
};
/// Orientational correlation G2(r) and pair distribution g(r).
struct MeasureG2 {
  double every = 0.1;  ///< [s]
  int bins = 100;      ///< over [0, L/2)
  friend bool operator==(const MeasureG2&, const MeasureG2&) = default;
};
/// Mean square displacement against lag.
struct MeasureMsd {
  double every = 0.01;  ///< [s]
  friend bool operator==(const MeasureMsd&, const MeasureMsd&) = default;
};
/// Rotation in the plane against lag.
struct MeasureRotation {
  double every = 0.01;  ///< [s]
  friend bool operator==(const MeasureRotation&, const MeasureRotation&) = default;
};
/// Autocorrelation of velocities averaged over a window.
struct MeasureVelocity {
  double every = 0.1;   ///< [s]
  double window = 0.4;  ///< [s]
  friend bool operator==(const MeasureVelocity&, const MeasureVelocity&) = default;
};
/// The ways of single rods.
struct MeasureRods {
  double every = 0.01;   ///< [s]
  int count = 4;         ///< of rods
  double duration = 30;  ///< [s]
  friend bool operator==(const MeasureRods&, const MeasureRods&) = default;
};
/// Giant number fluctuations.
struct MeasureFluctuations {
  double every = 0.5;  ///< [s]
  friend bool operator==(const MeasureFluctuations&, const MeasureFluctuations&) = default;
};
/// The director's fluctuations in q-space and the Frank constants' ratio.
struct MeasureFrank {
  double every = 0.1;  ///< [s]
  friend bool operator==(const MeasureFrank&, const MeasureFrank&) = default;
};
/// Maps of g and G2 in the frame of the director.
struct MeasurePairs {
  double every = 0.5;  ///< [s]
  int bins = 81;       ///< each way
  double range = 0.0;  ///< half the map's width [mm]; 0: what range_for() says
  /// In a box whose shorter side is `box_side`.
  double range_for(double rod_length, double box_side) const {
    return range > 0 ? range : std::min(3 * rod_length, box_side / 2);
  }
  friend bool operator==(const MeasurePairs&, const MeasurePairs&) = default;
};
/// Spectrum, wavelength and order of layers.
struct MeasureLayers {
  double every = 0.1;  ///< [s]
  friend bool operator==(const MeasureLayers&, const MeasureLayers&) = default;
};
/// psi_6 and the largest Bragg peak.
struct MeasureLattice {
  double every = 1.0;  ///< [s]
  friend bool operator==(const MeasureLattice&, const MeasureLattice&) = default;
};
/// Structure factor of the rods' centres.
struct MeasureStructure {
  double every = 1.0;  ///< [s]
  int waves = 64;      ///< wave numbers, 2 pi k / L for k = 1 .. waves
  friend bool operator==(const MeasureStructure&, const MeasureStructure&) = default;
};
/// Polar order P(t), and how rods move by the direction of their heads.
struct MeasurePolar {
  double every = 0.01;  ///< [s]
  SamplePhases phases = SamplePhases::kSpread;
  friend bool operator==(const MeasurePolar&, const MeasurePolar&) = default;
};
/// Granular temperatures by degree of freedom.
struct MeasureTemperatures {
  double every = 0.01;  ///< [s]
  SamplePhases phases = SamplePhases::kSpread;
  friend bool operator==(const MeasureTemperatures&, const MeasureTemperatures&) = default;
};
/// Self-intermediate scattering function and non-Gaussian parameter against lag.
struct MeasureScattering {
  double every = 0.01;      ///< [s]
  double wavelength = 0.0;  ///< the longest [mm]; 0: what wavelength_for() says
  double wavelength_for(double rod_length) const { return wavelength > 0 ? wavelength : rod_length; }
  friend bool operator==(const MeasureScattering&, const MeasureScattering&) = default;
};
/// Distribution of displacements at some lags.
struct MeasureVanHove {
  double every = 0.01;  ///< [s]
  double lag = 1.0;     ///< the longest [s]
  int bins = 40;        ///< over [0, range)
  double range = 0.0;   ///< of displacements at the longest lag [mm]; 0: what range_for() says
  double range_for(double rod_length) const { return range > 0 ? range : rod_length; }
  friend bool operator==(const MeasureVanHove&, const MeasureVanHove&) = default;
};
/// Correlation of the velocities of two rods against their distance.
struct MeasureFlow {
  double every = 0.4;  ///< the time over which displacements are velocities, too [s]
  int bins = 40;       ///< over [0, L/2)
  friend bool operator==(const MeasureFlow&, const MeasureFlow&) = default;
};
/// Clusters of rods whose axes are near each other.
struct MeasureClusters {
  double every = 0.1;     ///< [s]
  double distance = 0.0;  ///< below which axes make one cluster [mm]; 0: what distance_for() says
  double angle = 90.0;    ///< up to which they do [degrees]
  double distance_for(double mid_diameter) const { return distance > 0 ? distance : 1.25 * mid_diameter; }
  friend bool operator==(const MeasureClusters&, const MeasureClusters&) = default;
};
/// How often rods are hit, and the energy that this moves.
struct MeasureCollisions {
  double every = 0.1;  ///< [s]
  friend bool operator==(const MeasureCollisions&, const MeasureCollisions&) = default;
};
/// The pressure tensor in the plane.
struct MeasureStress {
  double every = 0.1;  ///< [s]
  SamplePhases phases = SamplePhases::kSpread;
  friend bool operator==(const MeasureStress&, const MeasureStress&) = default;
};
/// Pair distributions between species, and how far these keep apart.
struct MeasureMixing {
  double every = 0.1;     ///< [s]
  int bins = 40;          ///< over [0, L/2)
  double distance = 0.0;  ///< of the centres of neighbours [mm]; 0: what distance_for() says
  double distance_for(double rod_length, double box_side) const {
    return distance > 0 ? distance : std::min(rod_length, box_side / 2);
  }
  friend bool operator==(const MeasureMixing&, const MeasureMixing&) = default;
};
/// Maps about topological defects, in the frame of each.
struct MeasureDefectMaps {
  double every = 0.2;       ///< half the time over which displacements are velocities, too [s]
  int bins = 31;            ///< each way
  double range = 0.0;       ///< radius of the maps [mm]; 0: what range_for() says
  double separation = 0.0;  ///< of a defect from all others, at least [mm]; 0: what separation_for() says
  double smoothing = 0.0;   ///< as of MeasureDefects
  double grid = 0.0;        ///< as of MeasureDefects
  /// In a box whose shorter side is `box_side`.
  double range_for(double rod_length, double box_side) const {
    return range > 0 ? range : std::min(2 * rod_length, box_side / 2);
  }
  double separation_for(double rod_length) const { return separation > 0 ? separation : rod_length; }
  double smoothing_for(double rod_length) const {
    return MeasureDefects{.smoothing = smoothing}.smoothing_for(rod_length);
  }
  double grid_for(double rod_length) const { return MeasureDefects{.grid = grid}.grid_for(rod_length); }
  friend bool operator==(const MeasureDefectMaps&, const MeasureDefectMaps&) = default;
};
/// Maps of the density against time.
struct MeasureDensity {
  double every = 0.1;     ///< [s]
  double duration = 1.0;  ///< over which one map is averaged [s]
  double grid = 0.0;      ///< mesh width [mm]; 0: what grid_for() says
  double grid_for(double rod_length) const { return grid > 0 ? grid : rod_length; }
  friend bool operator==(const MeasureDensity&, const MeasureDensity&) = default;
};
/// The common drift of the measured rods.
struct MeasureDrift {
  double every = 0.01;  ///< [s]
  friend bool operator==(const MeasureDrift&, const MeasureDrift&) = default;
};

// clang-format off
/// Every observable by its name and settings, in the order in which it stands in canonical scenes, samples and is
/// saved. A further one goes to the end. All that there is one of for each observable is made from this list.
#define SHAKEN_OBSERVABLES(X) \
  X(order, MeasureOrder) \
  X(angles, MeasureAngles) \
  X(tilt, MeasureTilt) \
  X(defects, MeasureDefects) \
  X(g2, MeasureG2) \
  X(msd, MeasureMsd) \
  X(fluctuations, MeasureFluctuations) \
  X(frank, MeasureFrank) \
  X(rotation, MeasureRotation) \
  X(velocity, MeasureVelocity) \
  X(rods, MeasureRods) \
  X(pairs, MeasurePairs) \
  X(layers, MeasureLayers) \
  X(lattice, MeasureLattice) \
  X(structure, MeasureStructure) \
  X(polar, MeasurePolar) \
  X(temperatures, MeasureTemperatures) \
  X(scattering, MeasureScattering) \
  X(van_hove, MeasureVanHove) \
  X(flow, MeasureFlow) \
  X(clusters, MeasureClusters) \
  X(collisions, MeasureCollisions) \
  X(stress, MeasureStress) \
  X(mixing, MeasureMixing) \
  X(defect_maps, MeasureDefectMaps) \
  X(density, MeasureDensity) \
  X(drift, MeasureDrift)
// clang-format on

/// Whose observables are measured.
enum class MeasuredSpecies {
  kFirst,  ///< those of the first species
  kEach,   ///< those of each species, by itself
};

/// What a run measures. An absent observable is not measured and costs nothing.
struct MeasurePlan {
  MeasuredSpecies of = MeasuredSpecies::kFirst;
#define SHAKEN_MEMBER(name, Settings) std::optional<Settings> name;
  SHAKEN_OBSERVABLES(SHAKEN_MEMBER)
#undef SHAKEN_MEMBER
  friend bool operator==(const MeasurePlan&, const MeasurePlan&) = default;
};

}  // namespace shaken::scene
