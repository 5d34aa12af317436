// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "sim/scene.h"

namespace shaken::scene {

/// When to sample the in-plane nematic order S(t).
struct MeasureOrder {
  double every = 0.01;  ///< [s]
};
/// Distribution of the angle to the director.
struct MeasureAngles {
  double every = 0.01;  ///< [s]
  int bins = 180;       ///< over [-pi/2, pi/2)
};
/// Mean velocity along and across the rod against its tilt n_z.
struct MeasureTilt {
  double every = 0.001;  ///< [s]
  int bins = 40;         ///< over [-1, 1] in n_z times the largest tilt that the gap allows
};
/// Topological defects of the smoothed director field.
struct MeasureDefects {
  double every = 0.1;      ///< [s]
  double smoothing = 0.0;  ///< standard deviation of the Gaussian [mm]; 0 stands for half a rod length
  double grid = 0.0;       ///< mesh width [mm]; 0 stands for an eighth of a rod length
};
/// Rod positions and directions into trajectory.h5.
struct Trajectory {
  double every = 0.1;  ///< [s]
};
/// Live state over LCM.
struct Stream {
  double rate = 20.0;  ///< frames per wall-clock second, at most
};
/// A movie of the finished run.
struct Movie {
  double every = 0.05;  ///< simulated seconds between frames
  int width = 1280;     ///< [pixels]
  int height = 720;     ///< [pixels]
};

/// A resolved scene: the system, how long it runs, and what is measured, recorded, streamed and drawn.
/// An absent optional is work that is not done.
struct RunPlan {
  Scene system;

  std::optional<double> steady;  ///< simulated seconds before measuring; none: found from S(t) afterwards ("auto")
  double measure_time = 10.0;    ///< simulated seconds of the run after `steady`

  std::optional<MeasureOrder> order;
  std::optional<MeasureAngles> angles;
  std::optional<MeasureTilt> tilt;
  std::optional<MeasureDefects> defects;
  std::optional<Trajectory> trajectory;
  std::optional<Stream> stream;
  std::optional<Movie> movie;

  /// Simulated seconds from start to end.
  double total_time() const { return steady.value_or(0.0) + measure_time; }
};

}  // namespace shaken::scene
