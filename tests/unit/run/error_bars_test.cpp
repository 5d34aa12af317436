// Every error bar of the product by one test: rods that are made up are put through the real measurements in many
// replicas, and the scatter of each number between replicas is held against the error that it claims. What a
// measurement adds later is found and tested of itself.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "run/measure/measurement_kinds.h"
#include "run/measure/measurements.h"
#include "scene/keys/observables.h"
#include "tests/unit/analysis/analysis_samples.h"

namespace shaken::run {
namespace {

using analysis::Draw;

constexpr double kBox = 20, kEvery = 0.1;  // [mm], [s]
constexpr double kDt = 1e-3;
constexpr int kRods = 80;

scene::RunPlan plan() {
  scene::RunPlan p;
  p.system.dt = kDt;
  p.system.box_side = kBox;
  p.system.n_rods = kRods;
  p.steady = 0.0;
  p.order.reset();
  p.angles.reset();
  p.tilt.reset();
  p.defects.reset();
  p.g2.reset();
  return p;
}

/// Rods of which a share is drawn anew from sample to sample, so that all there is of them is correlated over
/// 1 / share samples; all of them: independent samples.
class Redrawn {
 public:
  using Rod = std::function<void(Draw&, Snapshot&, std::size_t)>;
  Redrawn(std::uint64_t seed, double share, Rod rod) : draw_(seed), share_(share), rod_(std::move(rod)) {
    rods_.position.resize(kRods);
    rods_.image.resize(kRods);
    rods_.director.resize(kRods);
    rods_.velocity.resize(kRods);
    rods_.angular_velocity.resize(kRods, Vec3::Zero());
    for (std::size_t i = 0; i < kRods; ++i) rod_(draw_, rods_, i);
  }
  const Snapshot& at(Tick tick) {
    rods_.tick = tick;
    rods_.time = static_cast<double>(tick) * kDt;
    rods_.box = kBox;
    for (std::size_t i = 0; i < kRods; ++i) {
      if (draw_.uniform(0, 1) < share_) rod_(draw_, rods_, i);
    }
    return rods_;
  }

 private:
  Draw draw_;
  double share_;
  Rod rod_;
  Snapshot rods_;
};

/// A rod anywhere: layered four to the box at +-15 degrees, tilted, and drifting by a law of its tilt that changes
/// sign.
void layered(Draw& draw, Snapshot& rods, std::size_t i) {
  const double y = draw.uniform(0, kBox);
  const double theta = (std::sin(2 * kPi * y / 5) > 0 ? 0.26 : -0.26) + 0.1 * draw.normal();
  const double n_z = draw.uniform(-0.2, 0.2);
  rods.position[i] = Vec3(draw.uniform(0, kBox), y, 0.6);
  rods.director[i] = analysis::axis(theta, n_z);
  const double largest = std::abs(n_z) < 0.12 ? 2.0 : 1.0;
  const double v = -largest * std::sin(kPi * n_z / 0.12) + draw.normal();
  rods.velocity[i] = v * analysis::axis(theta) + draw.normal() * analysis::axis(theta + kPi / 2);
  rods.velocity[i].z() = draw.normal();
  rods.angular_velocity[i] = Vec3(draw.normal(), draw.normal(), draw.normal());
}

/// A rod anywhere, in any direction: what makes many defects.
void isotropic(Draw& draw, Snapshot& rods, std::size_t i) {
  rods.position[i] = Vec3{draw.uniform(0, kBox), draw.uniform(0, kBox), 0.6};
  rods.director[i] = analysis::axis(draw.uniform(-kPi, kPi));
  rods.velocity[i] = Vec3::Zero();
}

/// Rods anywhere, at rest, whose director field is made of the longest waves of the box, of a nematic of K1 = K3; the
/// amplitudes forget themselves over 1 / share samples.
class Waves {
 public:
  Waves(std::uint64_t seed, double share) : draw_(seed), keeps_(1 - share) {
    for (std::size_t i = 0; i < kRods; ++i) {
      rods_.position.push_back(Vec3{draw_.uniform(0, kBox), draw_.uniform(0, kBox), 0.6});
      rods_.director.push_back(Vec3(1, 0, 0));
    }
    rods_.image.resize(kRods);
    rods_.velocity.resize(kRods, Vec3::Zero());
    rods_.angular_velocity.resize(kRods, Vec3::Zero());
    for (Wave& wave : waves_) wave.cosine = draw_.normal(), wave.sine = draw_.normal();
  }
  const Snapshot& at(Tick tick) {
    rods_.tick = tick;
    rods_.time = static_cast<double>(tick) * kDt;
    rods_.box = kBox;
    const double fresh = std::sqrt(1 - keeps_ * keeps_);
    for (Wave& wave : waves_) {
      wave.cosine = keeps_ * wave.cosine + fresh * draw_.normal();
      wave.sine = keeps_ * wave.sine + fresh * draw_.normal();
    }
    for (std::size_t i = 0; i < kRods; ++i) {
      // Rods that stay where they are would see the waves through one pattern of places, which no error in time knows.
      if (draw_.uniform(0, 1) >= keeps_) rods_.position[i] = Vec3{draw_.uniform(0, kBox), draw_.uniform(0, kBox), 0.6};
      double theta = 0.05 * draw_.normal();
      for (const Wave& wave : waves_) {
        const double phase = 2 * kPi / kBox * (wave.m * rods_.position[i].x() + wave.n * rods_.position[i].y());
        theta += 0.15 / std::hypot(wave.m, wave.n) * (wave.cosine * std::cos(phase) + wave.sine * std::sin(phase));
      }
      rods_.director[i] = analysis::axis(theta);
    }
    return rods_;
  }

 private:
  struct Wave {
    int m, n;
    double cosine = 0, sine = 0;
  };
  std::vector<Wave> waves_{{1, 0}, {0, 1}, {1, 1}, {1, -1}, {2, 0}, {0, 2}, {2, 1}, {1, 2}, {2, -1}, {1, -2}};
  Draw draw_;
  double keeps_;
  Snapshot rods_;
};

struct Claim {
  double value = 0, sem = 0;
};

/// What all replicas claim, by the name of a number or by path and place in an array.
using Claims = std::map<std::string, std::vector<Claim>>;

void collect(const Reduction& reduction, Claims& claims) {
  const auto add = [&](const std::string& name, double value, double sem) {
    if (std::isfinite(value) && std::isfinite(sem)) claims[name].push_back({value, sem});
  };
  for (const auto& [name, scalar] : reduction.scalars) add(name, scalar.value, scalar.sem);
  if (reduction.order) add("order", reduction.order->mean, reduction.order->sem);
  for (const auto& [path, errors] : reduction.arrays) {
    const std::size_t at = path.find("_sem");
    if (at == std::string::npos) continue;
    const std::string of = path.substr(0, at) + path.substr(at + 4);
    const std::vector<double>& values = reduction.arrays.at(of);
    for (std::size_t i = 0; i < errors.size(); ++i) add(of + " " + std::to_string(i), values[i], errors[i]);
  }
}

/// Mean square of (estimate - mean of all replicas) / error, of each number and of all of an array, if nearly all
/// replicas claim an error.
std::map<std::string, double> mean_squares(const Claims& claims, std::size_t replicas) {
  std::map<std::string, double> sums, counts;
  for (const auto& [name, all] : claims) {
    if (all.size() < 0.9 * static_cast<double>(replicas)) continue;
    const auto n = static_cast<double>(all.size());
    double mean = 0, squares = 0;
    for (const Claim& claim : all) mean += claim.value / n;
    for (const Claim& claim : all) squares += std::pow((claim.value - mean) / claim.sem, 2) / (n - 1);
    const std::string whole = name.substr(0, name.find(' '));
    sums[whole] += squares;
    counts[whole] += 1;
  }
  for (auto& [name, sum] : sums) sum /= counts[name];
  return sums;
}

/// Made-up rods by their seed.
using Maker = std::function<std::function<const Snapshot&(Tick)>(std::uint64_t seed)>;

template <class Rods, class... Settings>
Maker made_of(const Settings&... settings) {
  return [=](std::uint64_t seed) {
    const auto rods = std::make_shared<Rods>(seed, settings...);
    return [rods](Tick tick) -> const Snapshot& { return rods->at(tick); };
  };
}

struct ErrorCase {
  const char* name;
  scene::RunPlan plan;
  Maker rods;
  int samples;
  std::set<std::string> must;  // numbers that must be among those found
  bool is_correlated = false;
};

// The mean square is 1 within sqrt(2 / replicas) by chance, allowed three and a half times, as there are a hundred.
void expect_honest_errors(const ErrorCase& test, int replicas = 400) {
  const double chance = 3.5 * std::sqrt(2.0 / replicas);
  Claims claims;
  for (int replica = 0; replica < replicas; ++replica) {
    Measurements measurements(test.plan);
    const auto rods = test.rods(1000 + static_cast<std::uint64_t>(replica));
    const auto period = static_cast<Tick>(std::lround(kEvery / kDt));
    for (int i = 0; i < test.samples; ++i) measurements.sample(rods(i * period));
    collect(measurements.reduce(test.samples * kEvery), claims);
  }
  const std::map<std::string, double> found = mean_squares(claims, static_cast<std::size_t>(replicas));
  for (const auto& [name, square] : found) {
    std::printf("%s %s %.2f\n", test.name, name.c_str(), square);
    // Their errors hold what a step between waves, or bins, leaves open; the scatter is less.
    const bool by_steps = name == "wavelength_mm" || name == "layers_per_box" || name == "tilt_fastest_n_z";
    // A ratio over few deaths, of which the jackknife makes too much.
    const bool over_few = name == "lasting_defect_lifetime_s";
    // Of a variance, from 44 independent samples here: a fifth too small, since the error scatters with the number.
    const bool of_variance = test.is_correlated && (name == "binder" || name.ends_with("susceptibility"));
    EXPECT_GT(square, by_steps || over_few ? 0.0 : 1 - chance) << test.name << ": " << name;
    EXPECT_LT(square, (of_variance ? 1.5 : 1.0) + chance) << test.name << ": " << name;
  }
  for (const std::string& name : test.must) EXPECT_TRUE(found.contains(name)) << test.name << ": no error of " << name;
}

/// All that is measured of rods as they lie at one instant; the other cases are of the rest.
ErrorCase of_layers(const char* name, double share, int samples) {
  const std::set<std::string> elsewhere{"defects",  "msd",    "fluctuations", "frank",      "rotation",
                                        "velocity", "rods",   "pairs",        "scattering", "collisions",
                                        "stress",   "mixing", "defect_maps",  "density",    "drift"};
  scene::RunPlan p = plan();
  for (const scene::Observable& observable : scene::observables()) {
    if (elsewhere.contains(observable.name)) continue;
    observable.block.store(p, true);
    observable.every.store(p, kEvery);
  }
  p.tilt = scene::MeasureTilt{kEvery, 10, scene::SamplePhases::kLocked};
  p.structure->waves = 6;
  p.polar->phases = p.temperatures->phases = scene::SamplePhases::kLocked;
  p.angles->bins = 90;
  p.clusters->distance = 0.8;
  p.flow->bins = 8;
  p.van_hove = scene::MeasureVanHove{kEvery, kEvery, 8, 16};
  std::set<std::string> must{"order"};
  for (const MeasurementKind& kind : measurement_kinds()) {
    if (!kind.every(p)) continue;
    for (const Output& number : kind.numbers) must.emplace(number.name);
    for (const Output& array : kind.arrays) {
      if (array.has_error) must.insert("/" + std::string(kind.name) + "/" + std::string(array.name));
    }
  }
  must.erase("tilt_reversal_sigmas");  // an error itself
  return {name, p, made_of<Redrawn>(share, Redrawn::Rod(layered)), samples, must};
}

TEST(ErrorBars, OfIndependentSamples) { expect_honest_errors(of_layers("independent", 1.0, 130), 200); }
TEST(ErrorBars, OfCorrelatedSamples) {
  ErrorCase test = of_layers("correlated", 0.2, 400);
  test.is_correlated = true;
  expect_honest_errors(test, 200);
}

/// Rods so short that the box is eight of them wide and an exponent can be fitted.
ErrorCase of_numbers(const char* name, double share, int samples) {
  scene::RunPlan p = plan();
  p.system.rod.length = 2;
  p.fluctuations = scene::MeasureFluctuations{kEvery};
  return {name,
          p,
          made_of<Redrawn>(share, Redrawn::Rod(layered)),
          samples,
          {"fluctuation_exponent", "fluctuation_exponent_without_map", "/fluctuations/std_n"}};
}
TEST(ErrorBars, OfNumbersOfIndependentSamples) { expect_honest_errors(of_numbers("numbers", 1.0, 130)); }
TEST(ErrorBars, OfNumbersOfCorrelatedSamples) { expect_honest_errors(of_numbers("correlated numbers", 0.2, 400)); }

ErrorCase of_waves(const char* name, double share, int samples) {
  scene::RunPlan p = plan();
  p.frank = scene::MeasureFrank{kEvery};
  return {name, p, made_of<Waves>(share), samples, {"frank_ratio", "frank_splay", "frank_bend", "/frank/power_mm2"}};
}
TEST(ErrorBars, OfWavesOfIndependentSamples) { expect_honest_errors(of_waves("waves", 1.0, 130)); }
TEST(ErrorBars, OfWavesOfCorrelatedSamples) { expect_honest_errors(of_waves("correlated waves", 0.2, 400)); }

ErrorCase of_pairs(const char* name, double share, int samples) {
  scene::RunPlan p = plan();
  p.pairs = scene::MeasurePairs{kEvery, 41, 0};
  p.system.rod.length = 2;  // a layer is no narrower
  return {name, p, made_of<Redrawn>(share, Redrawn::Rod(layered)), samples, {"wavelength_g2_mm"}};
}
TEST(ErrorBars, OfPairsOfIndependentSamples) { expect_honest_errors(of_pairs("pairs", 1.0, 200)); }
TEST(ErrorBars, OfPairsOfCorrelatedSamples) { expect_honest_errors(of_pairs("correlated pairs", 0.2, 600)); }

TEST(ErrorBars, OfDefects) {
  scene::RunPlan p = plan();
  p.defects = scene::MeasureDefects{kEvery, 1.5, 1.0, false, 0.3};
  expect_honest_errors({"defects",
                        p,
                        made_of<Redrawn>(0.1, Redrawn::Rod(isotropic)),
                        300,
                        {"defect_density_per_mm2", "defect_creation_rate_per_mm2_s",
                         "defect_annihilation_rate_per_mm2_s", "defect_lifetime_s", "defect_speed_plus_mm_s"}});
}

}  // namespace
}  // namespace shaken::run
