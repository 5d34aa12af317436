// `shaken-bench accuracy`: errors of trajectories. They are written as rows, of which python/shaken/plots/accuracy.py
// makes orders.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/case.h"
#include "bench/report.h"
#include "sim/simulation.h"

namespace shaken::bench {

/// One way to treat impacts whose accuracy is measured.
struct Variant {
  const char* name;
  void (*apply)(System& scene);  ///< sets what the variant is about, and nothing else
};

/// All of them; the first is the default of a scene.
const std::vector<Variant>& variants();

/// A start whose future is followed for a time short enough not to be chaos. Its members differ a little, so that their
/// impacts fall anywhere within a tick.
struct StartCase {
  std::string name;
  std::string what;     ///< for people
  double duration = 0;  ///< a whole number of the longest step [s]
  int members = 0;      ///< of the ensemble, by default
  System scene;         ///< at any dt
  std::function<std::vector<Flight>(int member)> rods;
};

/// The longest step that divides every case's duration; the others are its halves [s].
inline constexpr double kLongestStep = 64e-6;

/// One rod, two rods, a dozen, a hundred.
const std::vector<StartCase>& start_cases();

/// The member at tick 0.
Simulation begin(const StartCase& start, const std::vector<Flight>& rods, const Variant& variant, StepperKind stepper,
                 double dt);

/// How far two states of the same rods at the same time are apart: root mean square over the rods of the distance of
/// their unwrapped centres [mm] and of the angle between their directors [rad]; difference of the kinetic energies over
/// that of `truth`.
inline constexpr std::array<const char*, 3> kNormNames{"position", "director", "energy"};
using Errors = std::array<double, kNormNames.size()>;
Errors errors_between(const World& state, const World& truth);

/// How to measure convergence.
struct ConvergenceEffort {
  std::vector<double> steps{};   ///< rising; kLongestStep over powers of 2 [s]
  std::optional<int> members{};  ///< of every ensemble; none: as many as the case says
};

/// {"lower", "median", "upper"} of a sample: linear between neighbours of the sorted values; null of none.
Json quartiles_of(std::vector<double> values);

/// Errors of one case and variant against the step. "rows": at each step the quartiles over the members of "error"
/// against the converged solution, CPU times of a member by either stepper, whether their states are equal, and how
/// many members ended in numerical trouble. "converged": the step of that solution, the "error" of one of twice its
/// step, and, of another variant than the first, "from_first", its distance from that one's.
Json measure_convergence(const StartCase& start, const Variant& variant, const ConvergenceEffort& effort);
Report convergence_report(const std::vector<Json>& measured);

}  // namespace shaken::bench
