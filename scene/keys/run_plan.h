#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "scene/keys/measure_plan.h"
#include "sim/system.h"

namespace shaken::scene {

/// Rod positions and directions into trajectory.h5.
struct Trajectory {
  double every = 0.1;  ///< [s]
  friend bool operator==(const Trajectory&, const Trajectory&) = default;
};
/// Live state over LCM.
struct Stream {
  double rate = 20.0;  ///< frames per wall-clock second, at most
  friend bool operator==(const Stream&, const Stream&) = default;
};
/// A movie of the finished run.
struct Movie {
  double every = 0.05;  ///< simulated seconds between frames
  int width = 1280;     ///< [pixels]
  int height = 720;     ///< [pixels]
  friend bool operator==(const Movie&, const Movie&) = default;
};

/// Where another run has left the rods, in place of rods placed anew.
struct StartState {
  std::string run;  ///< its id
  double time = 0;  ///< of its simulated time, at which it ended [s]
  friend bool operator==(const StartState&, const StartState&) = default;
};

/// A run that goes on beyond `time.measure` until it is accurate enough.
struct Until {
  double order_sem = 0.005;  ///< the largest standard error of the mean of S
  double at_most = 3600.0;   ///< simulated seconds after `steady`, whatever the error
  friend bool operator==(const Until&, const Until&) = default;
};

/// A resolved scene: the system, how long it runs, and what is measured, recorded, streamed and drawn.
/// An absent optional is work that is not done.
struct RunPlan : MeasurePlan {
  System system;

  std::optional<StartState> start;  ///< none: the rods are placed (System::start)

  std::optional<double> steady;  ///< simulated seconds before measuring; none: found from S(t) afterwards ("auto")
  double measure_time = 10.0;    ///< simulated seconds of the run after `steady`

  std::optional<Until> until;

  std::optional<Trajectory> trajectory;
  std::optional<Stream> stream;
  std::optional<Movie> movie;

  /// Simulated seconds from start to end; with `until`, at least.
  double total_time() const { return steady.value_or(0.0) + measure_time; }
  /// The same, at most.
  double longest_time() const { return steady.value_or(0.0) + (until ? until->at_most : measure_time); }
  /// Simulated seconds between recorded frames: the finer of what `trajectory` and `movie` ask for; none if neither is
  /// there, and nothing is recorded.
  std::optional<double> recording_every() const {
    if (!trajectory || !movie)
      return trajectory ? std::optional(trajectory->every) : movie ? std::optional(movie->every) : std::nullopt;
    return std::min(trajectory->every, movie->every);
  }

  friend bool operator==(const RunPlan&, const RunPlan&) = default;
};

}  // namespace shaken::scene
