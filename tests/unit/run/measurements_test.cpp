#include "run/measure/measurements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "analysis/clusters.h"
#include "analysis/geometry/director_field.h"
#include "analysis/geometry/region.h"
#include "analysis/temperatures.h"
#include "analysis/tilt.h"
#include "scene/keys/observables.h"
#include "sim/world.h"

namespace shaken::run {
namespace {

constexpr double kDt = 1e-5;

scene::RunPlan plan() {
  scene::RunPlan p;
  p.system.dt = kDt;
  p.system.box_side = 20;
  p.steady = 0.0;
  for (const scene::Observable& observable : scene::observables()) {
    observable.block.store(p, true);
    observable.every.store(p, 0.05);
  }
  p.order = scene::MeasureOrder{0.01};
  p.angles = scene::MeasureAngles{0.02, 18};
  p.tilt = scene::MeasureTilt{0.005, 10};
  p.defects = scene::MeasureDefects{0.05, 0, 0, true, 0.02};
  p.g2 = scene::MeasureG2{0.05, 20};
  p.msd = scene::MeasureMsd{0.01};
  p.rotation = scene::MeasureRotation{0.01};
  p.velocity = scene::MeasureVelocity{0.01, 0.03};
  p.rods = scene::MeasureRods{0.005, 3, 0.02};
  p.frank = scene::MeasureFrank{0.02};
  p.pairs = scene::MeasurePairs{0.05, 11, 0};
  p.layers = scene::MeasureLayers{0.02};
  p.mixing = scene::MeasureMixing{0.05, 20, 3};
  p.defect_maps = scene::MeasureDefectMaps{0.01, 7};
  p.density = scene::MeasureDensity{0.01, 0.02};
  p.drift = scene::MeasureDrift{0.01};
  return p;
}

Snapshot random_snapshot(Tick tick) {
  std::mt19937_64 rng(static_cast<std::uint64_t>(tick) + 17);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  Snapshot s;
  s.tick = tick;
  s.time = static_cast<double>(tick) * kDt;
  s.box = 20;
  for (int i = 0; i < 100; ++i) {
    s.position.emplace_back(20 * unit(rng), 20 * unit(rng), 0.6);
    s.director.push_back(Vec3{normal(rng), normal(rng), 0.1 * normal(rng)}.normalized());
    s.velocity.emplace_back(normal(rng), normal(rng), normal(rng));
    s.angular_velocity.emplace_back(0, 0, 0);
    s.image.push_back({0, 0});
  }
  return s;
}

/// The totals of a hundred rods, which meet a thousand times a second.
RunTotals totals_at(Tick tick) {
  const double time = static_cast<double>(tick) * kDt;
  return {{{1000 * time, 300 * time, 200 * time, 0, 5000 * time, 4000 * time, 1000 * time}, 100},
          {{6000, 0, 0, 2000}, {40000 * time, 0, 0, 20000 * time}}};
}

/// What is measured of spheres, of all that can be asked for.
Reduction reduced_spheres() {
  scene::RunPlan spheres = plan();
  spheres.system.rod.n_beads = 1;
  spheres.system.rod.length = spheres.system.rod.mid_diameter;
  Measurements measurements(spheres);
  const auto counts = measurements.counts();
  const std::set<std::string> of_axes{"order",    "angles", "tilt",   "defects", "frank",
                                      "rotation", "pairs",  "layers", "polar",   "defect_maps"};
  for (const scene::Observable& one : scene::observables())
    EXPECT_NE(counts.contains(one.name), of_axes.contains(one.name)) << one.name;
  for (Tick t = measurements.next_due(0); t <= 20000; t = measurements.next_due(t + 1)) {
    measurements.sample(random_snapshot(t));
  }
  EXPECT_TRUE(std::isnan(measurements.order_running_mean()));
  return measurements.reduce(0.2);
}

TEST(Measurements, OfSpheresAreOfNoAxis) {
  const Reduction result = reduced_spheres();
  EXPECT_FALSE(result.order);
  EXPECT_FALSE(result.defects);
  for (const char* there : {"/g2/g", "/g2/g_sem", "/msd/total_mm2", "/velocity/c_v", "/structure/factor",
                            "/temperatures/rotation_pJ", "/scattering/f", "/van_hove/distance_per_mm", "/flow/c"}) {
    EXPECT_TRUE(result.arrays.contains(there)) << there;
  }
  for (const auto& [path, values] : result.arrays) {
    EXPECT_EQ(path.find("along"), std::string::npos) << path;
    EXPECT_EQ(path.find("across"), std::string::npos) << path;
    EXPECT_EQ(path.find("/g2/g2"), std::string::npos) << path;
  }
  EXPECT_TRUE(result.scalars.contains("diffusion_mm2_s"));
  for (const auto& [name, scalar] : result.scalars) {
    EXPECT_EQ(name.find("along"), std::string::npos) << name;
    EXPECT_EQ(name.find("across"), std::string::npos) << name;
  }
}

/// Takes all samples in ticks [from, to].
void measure(Measurements& measurements, Tick from, Tick to) {
  for (Tick t = measurements.next_due(from); t <= to; t = measurements.next_due(t + 1)) {
    measurements.sample(random_snapshot(t), totals_at(t));
  }
}

TEST(Cadence, IsDueAtMultiplesFromZero) {
  const Cadence cadence(0.01, 4e-6);
  EXPECT_EQ(cadence.period(), 2500);
  EXPECT_TRUE(cadence.due(0));
  EXPECT_TRUE(cadence.due(5000));
  EXPECT_FALSE(cadence.due(4999));
  EXPECT_EQ(cadence.next(0), 0);
  EXPECT_EQ(cadence.next(1), 2500);
  EXPECT_EQ(cadence.next(2500), 2500);
  EXPECT_EQ(Cadence(1e-9, 4e-6).period(), 1) << "never more often than every tick";
}

// Samples at multiples of 2 ms see plates of 100 Hz at five phases; spread over their intervals they see all alike.
TEST(Cadence, SpreadOverItsIntervalsMeetsAllPhasesAlike) {
  const Cadence spread = Cadence::spread(0.002, 2e-5, 7);
  constexpr Tick kVibration = 500, kPeriod = 100;
  EXPECT_EQ(spread.period(), kPeriod);
  std::vector<int> at_phase(50);
  Tick last = -1;
  int n = 0;
  for (Tick tick = spread.next(0); tick < 100000 * kPeriod; tick = spread.next(tick + 1), ++n) {
    ASSERT_TRUE(spread.due(tick));
    ASSERT_EQ(tick / kPeriod, n) << "one in each interval";
    ASSERT_GT(tick, last);
    last = tick;
    ++at_phase[static_cast<std::size_t>(tick % kVibration / 10)];
  }
  double chi2 = 0;  // of 49 degrees of freedom
  for (const int count : at_phase) chi2 += (count - 2000.0) * (count - 2000.0) / 2000.0;
  EXPECT_LT(chi2, 86) << "one time in a thousand by chance";
  EXPECT_NE(Cadence::spread(0.002, 2e-5, 8).next(1000), spread.next(1000)) << "each seed has its own";
  for (const Tick tick : {Tick{0}, Tick{12345}, Tick{1} << 40}) {  // from the tick alone: nothing to save for a restart
    EXPECT_EQ(Cadence::spread(0.002, 2e-5, 7).next(tick), spread.next(tick));
  }
  EXPECT_EQ(spread.count(100000 * kPeriod - 1), 100000);
  EXPECT_EQ(Cadence(0.002, 2e-5).count(1000), 11) << "tick 0 included";
  const Cadence every_tick = Cadence::spread(1e-9, 2e-5, 7);
  for (Tick tick = 0; tick < 100; ++tick) EXPECT_TRUE(every_tick.due(tick));
}

TEST(Measurements, EachKeepsItsOwnTime) {
  Measurements measurements(plan());
  measure(measurements, 0, 10000);  // 0.1 s
  const std::map<std::string, std::int64_t> counts = measurements.counts();
  EXPECT_EQ(counts.size(), measurement_kinds().size());
  for (const MeasurementKind& kind : measurement_kinds()) {
    const long whole = std::lround(std::floor(0.1 / *kind.every(plan()) + 1e-9));
    const bool is_spread = scene::observable(kind.name).is_spread(plan());
    EXPECT_EQ(counts.at(std::string(kind.name)), is_spread ? whole : whole + 1) << kind.name;
  }
  EXPECT_EQ(counts.at("tilt"), 20);
  const Reduction reduction = measurements.reduce(0.1);
  EXPECT_EQ(reduction.arrays.at("/order/time_s").size(), 11U);
  EXPECT_EQ(reduction.arrays.at("/defects/time_s").size(), 3U);
  EXPECT_EQ(reduction.arrays.at("/angles/theta_rad").size(), 18U);
  EXPECT_EQ(reduction.arrays.at("/tilt/n_z").size(), 10U);
  EXPECT_EQ(reduction.arrays.at("/g2/g2").size(), 20U);
  EXPECT_EQ(reduction.arrays.at("/g2/r_mm").back(), 9.75);  // bins over [0, L / 2)
  EXPECT_EQ(reduction.arrays.at("/g2/g").size(), 20U);
  EXPECT_EQ(reduction.arrays.at("/order/pdf/density").size(), reduction.arrays.at("/order/pdf/order").size());
  EXPECT_EQ(reduction.arrays.at("/pairs/g").size(), 121U);
  EXPECT_EQ(reduction.arrays.at("/pairs/g2").size(), 121U);
  EXPECT_NEAR(reduction.arrays.at("/pairs/along_mm").back(), 10 * 10.0 / 11, 1e-12);  // half the box: less than 3 rods
  EXPECT_EQ(reduction.arrays.at("/pairs/cut/g2_across").size(), reduction.arrays.at("/pairs/cut/r_mm").size());
  EXPECT_NEAR(reduction.arrays.at("/layers/q_per_mm").front(), 2 * kPi / 20, 1e-12);
  EXPECT_NEAR(reduction.arrays.at("/msd/lag_s").front(), 0.01, 1e-12);
  EXPECT_EQ(reduction.arrays.at("/msd/total_sem_mm2").size(), reduction.arrays.at("/msd/lag_s").size());
  EXPECT_EQ(reduction.arrays.at("/rotation/c2_sem").size(), reduction.arrays.at("/rotation/lag_s").size());
  EXPECT_NEAR(reduction.arrays.at("/rotation/lag_s").back(), 0.1, 1e-12);
  EXPECT_NEAR(reduction.arrays.at("/velocity/lag_s").back(), 0.07, 1e-12) << "the window ends at 0.1 s";
  EXPECT_EQ(reduction.arrays.at("/velocity/c_v").front(), 1.0);
  EXPECT_EQ(reduction.arrays.at("/rods/trace/time_s").size(), 5U) << "for 0.02 s";
  EXPECT_EQ(reduction.arrays.at("/rods/trace/2/theta_rad").size(), 5U);
  EXPECT_EQ(reduction.arrays.at("/defects/list/x_mm").size(), reduction.arrays.at("/defects/list/charge").size());
  EXPECT_DOUBLE_EQ(reduction.arrays.at("/fluctuations/mean_n").at(0), 25);  // of 100 rods in a quarter of the box
}

TEST(Measurements, WhatIsNotInThePlanDoesNotExist) {
  scene::RunPlan nothing;
  nothing.steady = 1.0;
  Measurements measurements(nothing);
  EXPECT_EQ(measurements.next_due(0), kNever);
  measurements.sample(random_snapshot(0));
  const Reduction reduction = measurements.reduce(10);
  EXPECT_TRUE(reduction.arrays.empty());
  EXPECT_FALSE(reduction.order);
  EXPECT_FALSE(reduction.defects);
  EXPECT_EQ(reduction.t_steady, 1.0);
}

// Version 0.1.0 had another order.
TEST(Measurements, AreRestoredFromAStateInAnyOrder) {
  scene::RunPlan both;
  both.system = plan().system;
  both.msd = scene::MeasureMsd{0.01};
  both.rotation = scene::MeasureRotation{0.01};
  scene::RunPlan msd = both, rotation = both;
  msd.rotation.reset();
  rotation.msd.reset();
  const auto state_of = [](const scene::RunPlan& asked) {
    Measurements measurements(asked);
    measure(measurements, 0, 10000);
    return measurements.save();
  };
  std::vector<std::byte> state = state_of(rotation);
  for (const std::byte each : state_of(msd)) state.push_back(each);
  Measurements restored(both);
  ASSERT_TRUE(restored.restore(state));
  EXPECT_EQ(restored.save(), state_of(both));
  state = state_of(msd);
  state.insert(state.end(), state.begin(), state.end());
  EXPECT_FALSE(restored.restore(state)) << "one of them twice";
}

TEST(MeasurementKinds, EachByItself) {
  scene::RunPlan p = plan();
  p.steady = 3.0;
  for (const MeasurementKind& kind : measurement_kinds()) {
    const scene::RunPlan alone = only(p, kind);
    EXPECT_EQ(alone.steady, 0.0);
    for (const MeasurementKind& other : measurement_kinds()) {
      EXPECT_EQ(other.every(alone), other.name == kind.name ? kind.every(p) : std::nullopt) << kind.name << other.name;
    }
  }
}

// Every defect of the list has its place, and the means are those of the list.
TEST(Measurements, DefectsHaveTracksAndAListOnlyIfAskedFor) {
  scene::RunPlan p = plan();
  Measurements measurements(p);
  measure(measurements, 0, 50000);
  const Reduction reduction = measurements.reduce(0.5);
  const auto& arrays = reduction.arrays;
  const std::vector<double>& track = arrays.at("/defects/list/track");
  const std::vector<double>& time = arrays.at("/defects/list/time_s");
  ASSERT_EQ(track.size(), time.size());
  ASSERT_GT(track.size(), 11U);
  // Without a first sample to have lived before: density times area is the mean over the other ten samples.
  const auto later = std::count_if(time.begin(), time.end(), [](double t) { return t > 0.01; });
  EXPECT_NEAR(reduction.scalars.at("defect_density_per_mm2").value * 20 * 20, static_cast<double>(later) / 10, 1e-9);
  EXPECT_EQ(reduction.scalars.at("defect_charge").value, 0);
  EXPECT_GT(reduction.scalars.at("defect_density_per_mm2").value,
            reduction.scalars.at("lasting_defect_density_per_mm2").value);
  EXPECT_EQ(arrays.at("/defects/tracks/span_s").at(2), 4 * 0.05);
  EXPECT_EQ(arrays.at("/defects/tracks/lasting/speed_plus_along_sem_mm_s").size(), 5U);

  p.defects->list = false;
  Measurements without(p);
  measure(without, 0, 50000);
  EXPECT_FALSE(without.reduce(0.5).arrays.contains("/defects/list/track"));
  EXPECT_EQ(without.reduce(0.5).arrays.at("/defects/n_plus"), arrays.at("/defects/n_plus"));
}

// Rods along x in four columns, rigidly turned by a wave along x: power at that wave only, whose floor is not noise.
TEST(Measurements, FluctuationsOfALattice) {
  scene::RunPlan p = plan();
  Measurements measurements(p);
  Snapshot s = random_snapshot(0);
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    s.position[i] = 2.0 * Vec3(static_cast<double>(i % 10) + 0.5, static_cast<double>(i / 10) + 0.5, 0.3);
    const double theta = 0.01 * std::sin(2 * kPi / 20 * s.position[i].x());
    s.director[i] = Vec3(std::cos(theta), std::sin(theta), 0);
  }
  measurements.sample(s);
  const Reduction reduction = measurements.reduce(0);
  EXPECT_EQ(reduction.arrays.at("/fluctuations/std_n").at(0), 0);  // 25 in every quarter
  const std::vector<double>& q = reduction.arrays.at("/frank/q_along_per_mm");
  const std::vector<double>& power = reduction.arrays.at("/frank/power_mm2");
  const auto most = static_cast<std::size_t>(std::max_element(power.begin(), power.end()) - power.begin());
  EXPECT_NEAR(q.at(most), 2 * kPi / 20, 1e-6);
  EXPECT_EQ(reduction.arrays.at("/frank/fit_mm2").size(), q.size());
  EXPECT_TRUE(reduction.scalars.contains("frank_ratio"));
}

TEST(Measurements, WhatCannotBeToldSaysWhy) {
  Measurements measurements(plan());
  measure(measurements, 0, 10000);
  const std::map<std::string, Scalar> scalars = measurements.reduce(0.1).scalars;
  EXPECT_TRUE(std::isnan(scalars.at("fluctuation_exponent").value)) << "a box of four and a half rod lengths";
  EXPECT_EQ(scalars.at("fluctuation_sizes").value, 1);
  EXPECT_NE(scalars.at("fluctuation_exponent").reason.find("eight rod lengths"), std::string::npos);
  EXPECT_TRUE(std::isnan(scalars.at("diffusion_mm2_s").value)) << "eleven samples";
  EXPECT_NE(scalars.at("diffusion_mm2_s").reason.find("too short"), std::string::npos);
  EXPECT_TRUE(scalars.at("velocity_rms_mm_s").reason.empty());
  for (const int n_rods : {1, 2}) {
    scene::RunPlan few = plan();
    few.system.n_rods = n_rods;
    const std::string why = Measurements(few).reduce(0.1).scalars.at("pressure_pJ_mm2").reason;
    EXPECT_EQ(why.starts_with("a single rod"), n_rods == 1) << why;
  }
}

// What is measured of single rods, and where it is to be found.
TEST(Measurements, WaysAndTiltsOfSingleRods) {
  scene::RunPlan p = plan();
  p.velocity = scene::MeasureVelocity{0.01, 0.01};
  Measurements measurements(p);
  // At 30 mm/s to and fro, turning every 0.1 s; tilted to either side for 50 ms.
  const Species rod = make_species(RodShape{});
  const double tilt = analysis::largest_tilt(rod.half_length, rod.end_radius, p.system.gap);
  for (Tick tick = 0; tick <= 200000; tick = measurements.next_due(tick + 1)) {
    Snapshot s = random_snapshot(0);
    s.tick = tick;
    s.time = static_cast<double>(tick) * kDt;
    const double phase = std::remainder(s.time, 0.2);
    for (std::size_t i = 0; i < s.n_rods(); ++i) {
      s.position[i] = Vec3(10 + 30 * std::abs(phase), 10, 0.6);
      const double n_z = (tick / 5000 % 2 == 0 ? 0.6 : -0.6) * tilt;
      s.director[i] = Vec3(std::sqrt(1 - n_z * n_z), 0, n_z);
    }
    measurements.sample(s);
  }
  const Reduction reduction = measurements.reduce(2.0);
  EXPECT_NEAR(reduction.scalars.at("n_z_switching_time_s").value, 0.05, 0.002);
  EXPECT_NEAR(reduction.scalars.at("velocity_variance_along_mm2_s2").value, 900, 1e-6);
  EXPECT_NEAR(reduction.scalars.at("velocity_variance_across_mm2_s2").value, 0, 1e-6);
  EXPECT_NEAR(reduction.arrays.at("/velocity/product_mm2_s2").at(0), 900, 1e-6);
  // <u u'> falls from 1 to -1 in 0.1 s: up to 1/e^2, over 1 - 1/e^2, half of 0.05 (1 + 1/e^2) s, and as much way at 30
  // mm/s.
  const double persistence = 0.025 * (1 + std::exp(-2.0));
  EXPECT_NEAR(reduction.scalars.at("persistence_time_s").value, persistence, 0.001);
  EXPECT_NEAR(reduction.scalars.at("persistence_length_mm").value, 30 * persistence, 0.03);
  EXPECT_EQ(reduction.arrays.at("/velocity/direction").at(0), 1.0);
  for (std::size_t i = 0; i < reduction.arrays.at("/msd/lag_s").size(); ++i) {
    EXPECT_NEAR(reduction.arrays.at("/msd/d_along_mm2_s")[i],
                reduction.arrays.at("/msd/along_mm2")[i] / (2 * reduction.arrays.at("/msd/lag_s")[i]), 1e-9);
  }
}

TEST(Measurements, NumbersAreOfBoxesInsideTheWalls) {
  scene::RunPlan p = plan();
  p.system.walls = SideWalls{Arena::kDisc, 14};
  Measurements measurements(p);
  measurements.sample(random_snapshot(0));
  const std::vector<double> area = measurements.reduce(0).arrays.at("/fluctuations/area_fraction");
  // Of a disc of 14 mm in a box of 20: not the quarters of the box, but its inmost ninth.
  EXPECT_NEAR(area.at(0), std::pow(20.0 / 3, 2) / (kPi * 49), 1e-12);
}

TEST(Measurements, ParallelRodsHaveOrderOneAndNoDefects) {
  Measurements measurements(plan());
  Snapshot s = random_snapshot(0);
  for (Vec3& n : s.director) n = Vec3(std::cos(0.3), std::sin(0.3), 0);
  measurements.sample(s);
  const Reduction reduction = measurements.reduce(0);
  EXPECT_NEAR(reduction.arrays.at("/order/order").at(0), 1, 1e-12);
  EXPECT_NEAR(reduction.arrays.at("/order/director_rad").at(0), 0.3, 1e-12);
  EXPECT_EQ(reduction.arrays.at("/defects/n_plus").at(0), 0);
}

// Stripes at +-theta_m across y, four to the box: every measurement of layers finds them. A square wave has the order
// 4 / pi sin 2 theta_m; G2 across has its maximum at the wavelength.
TEST(Measurements, FindPlantedLayers) {
  constexpr double kThetaM = 15 * kPi / 180, kWavelength = 5;
  scene::RunPlan p = plan();
  p.system.rod.length = 2;  // a layer is wider
  p.angles->bins = 180;
  p.pairs->bins = 41;
  Measurements measurements(p);
  std::mt19937_64 rng(5);
  std::normal_distribution<double> normal;
  for (Tick tick = 0; tick <= 200000; tick = measurements.next_due(tick + 1)) {
    Snapshot s = random_snapshot(tick);
    const double phase = 2 * kPi * static_cast<double>(rng() % 1000) / 1000;
    for (std::size_t i = 0; i < s.n_rods(); ++i) {
      const double wave = std::sin(2 * kPi * s.position[i].y() / kWavelength + phase);
      const double theta = (wave > 0 ? kThetaM : -kThetaM) + 0.08 * normal(rng);
      s.director[i] = Vec3(std::cos(theta), std::sin(theta), 0);
    }
    measurements.sample(s);
  }
  const std::map<std::string, Scalar> scalars = measurements.reduce(2.0).scalars;
  const auto check = [&](const char* name, double expected, double tolerance) {
    const Scalar& scalar = scalars.at(name);
    EXPECT_NEAR(scalar.value, expected, tolerance) << name;
    EXPECT_GT(scalar.sem, 0) << name;
    EXPECT_LT(scalar.sem, 3 * tolerance) << name;
  };
  check("theta_m_deg", 15, 1);
  check("dip", 0, 0.05);
  check("wavelength_mm", kWavelength, 0.2);
  check("layers_per_box", 4, 0.1);
  // Wherever layers would like to be, four or five of them must fit the box.
  EXPECT_NEAR(scalars.at("layers_per_box").sem, 1 / std::sqrt(12), 0.03);
  EXPECT_NEAR(scalars.at("wavelength_mm").sem, 25 / 20.0 / std::sqrt(12), 0.04);
  check("layer_order", 4 / kPi * std::sin(2 * kThetaM), 0.04);
  check("wavelength_g2_mm", kWavelength, 0.5);
  check("binder", 1, 0.01);
  EXPECT_LT(scalars.at("bragg_peak").value, 0.2);
  EXPECT_LT(scalars.at("psi_6").value, 0.2);
  EXPECT_GT(scalars.at("susceptibility").value, 0);
}

// Rods a little off the director at random: a peak there is, but no layers to have a wavelength.
TEST(Measurements, NoLayersHaveNoWavelength) {
  Measurements measurements(plan());
  std::mt19937_64 rng(6);
  std::normal_distribution<double> normal;
  for (Tick tick = 0; tick <= 100000; tick = measurements.next_due(tick + 1)) {
    Snapshot s = random_snapshot(tick);
    for (Vec3& n : s.director) {
      const double theta = 0.2 * normal(rng);
      n = Vec3(std::cos(theta), std::sin(theta), 0);
    }
    measurements.sample(s);
  }
  const std::map<std::string, Scalar> scalars = measurements.reduce(1.0).scalars;
  for (const char* name : {"wavelength_mm", "layers_per_box"}) {
    EXPECT_TRUE(std::isnan(scalars.at(name).value)) << name;
    EXPECT_TRUE(std::isnan(scalars.at(name).sem)) << name;
  }
  EXPECT_NEAR(scalars.at("layer_order").value, 2 * 0.37 / std::sqrt(100), 0.03);
  EXPECT_GT(scalars.at("layer_order").sem, 0);
}

// Those of the director field within the walls, smoothed within them.
TEST(Measurements, DefectsAreThoseWithinTheSideWalls) {
  scene::RunPlan p = plan();
  p.system.walls = SideWalls{Arena::kDisc, 18};
  Snapshot inside = random_snapshot(0);
  for (std::size_t i = 0; i < inside.n_rods(); ++i) {
    inside.position[i] = Vec3(10, 10, 0.6) + 8.9 / 14.2 * (inside.position[i] - Vec3(10, 10, 0.6));
  }
  Measurements measurements(p);
  measurements.sample(inside);
  const std::vector<analysis::Defect>& defects = measurements.last_defects()->defects;
  const double length = p.system.rod.length;
  const analysis::DirectorField field(inside.position, inside.director, analysis::Region(20, p.system.walls),
                                      analysis::Grid(20, length / 8), length / 2);
  EXPECT_EQ(defects.size(), analysis::find_defects(field).size());
  EXPECT_GT(defects.size(), 0U);
  for (const analysis::Defect& defect : defects) EXPECT_LE((defect.position - Vec2(10, 10)).norm(), 9);
}

// No distances through walls: the two rods at opposite walls are not near to each other.
TEST(Measurements, PairsAreThoseWithinTheSideWalls) {
  scene::RunPlan p = plan();
  Snapshot two = random_snapshot(0);
  two.position.resize(2);
  two.director.resize(2);
  two.velocity.resize(2);
  two.angular_velocity.resize(2);
  two.image.resize(2);
  two.position[0] = Vec3(0.5, 10, 0.6);
  two.position[1] = Vec3(19.4, 10, 0.6);
  const auto g_near = [&] {
    Measurements measurements(p);
    measurements.sample(two);
    return measurements.reduce(0).arrays.at("/g2/g").at(2);  // of bins of 0.5 mm the one of 1 mm
  };
  EXPECT_GT(g_near(), 0);
  p.system.walls = SideWalls{Arena::kDisc, 19.5};
  EXPECT_EQ(g_near(), 0);
  // a channel has no walls there
  p.system.walls = SideWalls{Arena::kChannel, 19.5};
  EXPECT_GT(g_near(), 0);
  two.position[0] = Vec3(10, 0.5, 0.6);
  two.position[1] = Vec3(10, 19.4, 0.6);
  EXPECT_EQ(g_near(), 0);
}

TEST(Measurements, DefectsAreNotTrackedThroughSideWalls) {
  scene::RunPlan p;
  p.system = plan().system;
  p.system.walls = SideWalls{Arena::kSquare, 19};
  p.steady = 0.0;
  p.defects = plan().defects;
  Measurements measurements(p);
  const double length = p.system.rod.length;
  analysis::DefectTracks within({{0, 0}, 19 * 19, 0.05, length, 0.02});
  analysis::DefectTracks through({{20, 20}, 19 * 19, 0.05, length, 0.02});
  for (Tick tick = 0; tick <= 500000; tick += 5000) {
    measurements.sample(random_snapshot(tick));
    within.accumulate(static_cast<double>(tick) * kDt, measurements.last_defects()->defects);
    through.accumulate(static_cast<double>(tick) * kDt, measurements.last_defects()->defects);
  }
  const double alone = measurements.reduce(0.5).scalars.at("defect_lone_death_rate_per_mm2_s").value;
  EXPECT_NEAR(alone, within.reduce(0).all.lone_death_rate.value, 1e-12);
  EXPECT_GT(std::abs(alone - through.reduce(0).all.lone_death_rate.value), 1e-6);
}

TEST(Measurements, DisplacementsCountCrossingsOfTheBorderFromTheSteadyTimeOn) {
  scene::RunPlan p = plan();
  p.steady = 0.05;
  Measurements measurements(p);
  // 30 mm/s along x: 0.3 mm per sample, across the border; at rest before the steady time
  for (Tick tick = 0; tick <= 10000; tick += 1000) {
    Snapshot s = random_snapshot(tick);
    const double x = tick < 5000 ? 0.0 : 19.5 + 30 * (s.time - 0.05);
    for (std::size_t i = 0; i < s.n_rods(); ++i) {
      s.position[i] = Vec3(x - 20 * std::floor(x / 20), 10, 0.6);
      s.image[i][0] = static_cast<std::int32_t>(std::floor(x / 20));
      s.director[i] = Vec3(1, 0, 0);
    }
    measurements.sample(s);
  }
  const Reduction reduction = measurements.reduce(0.1);
  for (std::size_t k = 0; k < reduction.arrays.at("/msd/lag_s").size(); ++k) {
    const double path = 30 * reduction.arrays.at("/msd/lag_s")[k];
    EXPECT_NEAR(reduction.arrays.at("/msd/along_mm2")[k], path * path, 1e-9);
    EXPECT_NEAR(reduction.arrays.at("/msd/across_mm2")[k], 0, 1e-9);
  }
  EXPECT_NEAR(reduction.arrays.at("/msd/lag_s").back(), 0.05, 1e-9);
}

// Where the steady state is found only afterwards, curves against lag are of the origins after it all the same: here
// rods stand still up to 2 s, and then go at 30 mm/s and turn at 2 rad/s.
TEST(Measurements, AnAutomaticSteadyStateHoldsForCurvesAgainstLag) {
  scene::RunPlan p = plan();
  p.steady.reset();
  p.order.reset();  // half the run is steady
  p.defects.reset();
  p.g2.reset();
  Measurements measurements(p);
  for (Tick tick = 0; tick <= 400000; tick += 500) {
    Snapshot s = random_snapshot(tick);
    const double moving = std::max(0.0, s.time - 2.0);
    for (std::size_t i = 0; i < s.n_rods(); ++i) {
      s.position[i] = Vec3(30 * moving, 10, 0.6);
      s.director[i] = Vec3(std::cos(2 * moving), std::sin(2 * moving), 0);
    }
    measurements.sample(s);
  }
  const Reduction reduction = measurements.reduce(4.0);
  EXPECT_EQ(reduction.t_steady, 2.0);
  ASSERT_GT(reduction.arrays.at("/msd/lag_s").size(), 20U);
  for (std::size_t k = 0; k < reduction.arrays.at("/msd/lag_s").size(); ++k) {
    const double lag = reduction.arrays.at("/msd/lag_s")[k];
    EXPECT_NEAR(reduction.arrays.at("/msd/total_mm2")[k], 900 * lag * lag, 1e-8);
    EXPECT_NEAR(reduction.arrays.at("/rotation/msad_rad2")[k], 4 * lag * lag, 1e-8);
    EXPECT_NEAR(reduction.arrays.at("/rotation/c2")[k], std::cos(4 * lag), 1e-8);
  }
  EXPECT_NEAR(reduction.scalars.at("velocity_rms_mm_s").value, 30, 1e-8);
  EXPECT_DOUBLE_EQ(reduction.scalars.at("velocity_rms_mm_s").over, p.velocity->window);
  EXPECT_TRUE(std::isnan(reduction.scalars.at("alpha_long").over));
  EXPECT_NEAR(reduction.scalars.at("alpha_long").value, 2, 1e-8);
  EXPECT_EQ(reduction.scalars.at("large_turns").value, 0);
  EXPECT_EQ(reduction.arrays.at("/rods/trace/time_s").front(), 0.0) << "they do not wait";
}

TEST(Measurements, SteadyStateIsGivenFoundOrHalfTheRun) {
  scene::RunPlan p = plan();
  p.steady = 0.05;
  Measurements given(p);
  measure(given, 0, 10000);
  EXPECT_NEAR(given.reduce(0.1).t_steady, 0.05, 1e-12);
  EXPECT_NEAR(given.reduce(0.1).order->t_steady, 0.05, 1e-12);

  p.steady.reset();
  Measurements found(p);
  measure(found, 0, 10000);
  EXPECT_EQ(found.reduce(0.1).t_steady, found.reduce(0.1).order->t_steady);

  p.order.reset();
  Measurements assumed(p);
  measure(assumed, 0, 10000);
  EXPECT_EQ(assumed.reduce(0.1).t_steady, 0.05);
}

void expect_same(double found, double expected, const std::string& what) {
  EXPECT_TRUE(found == expected || (std::isnan(found) && std::isnan(expected)))
      << what << ": " << found << ", not " << expected;
}

TEST(Measurements, GoOnBitwiseAfterASaveAtAnyTime) {
  Measurements straight(plan());
  measure(straight, 0, 20000);
  for (const Tick stop : {0, 1, 500, 4999, 5000, 12345, 20000}) {
    Measurements first(plan());
    measure(first, 0, stop);
    Measurements second(plan());
    ASSERT_TRUE(second.restore(first.save()));
    measure(second, stop + 1, 20000);
    EXPECT_EQ(second.save(), straight.save()) << stop;
    EXPECT_EQ(second.counts(), straight.counts()) << stop;
    // what is not saved is not missed either
    const Reduction whole = straight.reduce(0.2), resumed = second.reduce(0.2);
    for (const auto& [path, values] : whole.arrays) {
      EXPECT_TRUE(std::equal(values.begin(), values.end(), resumed.arrays.at(path).begin(),
                             [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }))
          << path << " after " << stop;
    }
    for (const auto& [name, scalar] : whole.scalars) expect_same(resumed.scalars.at(name).value, scalar.value, name);
  }
}

TEST(Measurements, RefuseTheStateOfAnotherPlan) {
  Measurements full(plan());
  measure(full, 0, 5000);
  scene::RunPlan p = plan();
  p.tilt.reset();
  EXPECT_FALSE(Measurements(p).restore(full.save()));
  using Change = void (*)(scene::RunPlan&);
  const Change changes[] = {
      [](scene::RunPlan& of) { of.angles->bins = 20; },       [](scene::RunPlan& of) { of.tilt->bins = 11; },
      [](scene::RunPlan& of) { of.g2->bins = 21; },           [](scene::RunPlan& of) { of.pairs->bins = 13; },
      [](scene::RunPlan& of) { of.van_hove->bins = 17; },     [](scene::RunPlan& of) { of.flow->bins = 9; },
      [](scene::RunPlan& of) { of.structure->waves = 7; },    [](scene::RunPlan& of) { of.defect_maps->bins = 9; },
      [](scene::RunPlan& of) { of.velocity->window = 0.05; }, [](scene::RunPlan& of) { of.rods->count = 4; },
      [](scene::RunPlan& of) { of.system.box_side = 21; }};
  for (const Change& change : changes) {
    p = plan();
    change(p);
    EXPECT_FALSE(Measurements(p).restore(full.save())) << "change " << &change - changes;
  }
  EXPECT_FALSE(Measurements(plan()).restore({}));
}

/// A mixture of two species of which each is measured; two of five rods are of the other one.
struct Mixture {
  scene::RunPlan plan = run::plan();
  Cell cell{20, 1.2};

  Mixture() {
    plan.of = scene::MeasuredSpecies::kEach;
    plan.mixing.reset();  // which has a test of its own
    plan.system.n_rods = 60;
    plan.system.added[1] = AddedRods{{.length = 2.5, .mid_diameter = 0.8, .end_diameter = 0.5, .n_beads = 9}, 40};
    for (int i = 0; i < 100; ++i) cell.shape_of_rod.push_back(i % 5 < 3 ? 0 : 1);
  }
  /// The same rods, of which only those of one species are there and measured.
  Reduction alone(std::size_t species, Tick end) const {
    scene::RunPlan one = plan;
    one.of = scene::MeasuredSpecies::kFirst;
    one.system.added = {};
    if (species == 1) {
      one.system.rod = plan.system.added[1]->rod;
      one.system.n_rods = 40;
      one.collisions.reset();  // those of all rods are with the first species
    }
    Measurements measurements(one);
    for (Tick t = measurements.next_due(0); t <= end; t = measurements.next_due(t + 1)) {
      const Snapshot all = random_snapshot(t);
      Snapshot some{all.tick, all.time, all.box, {}, {}, {}, {}, {}};
      for (std::size_t i = 0; i < 100; ++i) {
        if (cell.shape_of_rod[i] != species) continue;
        some.position.push_back(all.position[i]);
        some.image.push_back(all.image[i]);
        some.director.push_back(all.director[i]);
        some.velocity.push_back(all.velocity[i]);
        some.angular_velocity.push_back(all.angular_velocity[i]);
      }
      measurements.sample(some, totals_at(t));
    }
    return measurements.reduce(0.2);
  }
};

// Each rod with its own mass, inertia and length, whichever of two species is measured.
TEST(Measurements, OfRodsThatDifferAreThoseOfEachRodsOwnSize) {
  Mixture mixture;
  mixture.plan.system.rod.spread = {.length = 0.2, .end_diameter = 0.1};
  mixture.plan.system.added[1]->rod.spread.length = 0.15;
  const World world = empty_world(mixture.plan.system);
  const Cell cell = world.cell();
  ASSERT_EQ(cell.n_species(), 2U);
  Measurements measurements(mixture.plan, cell);
  measure(measurements, 0, 20000);
  const Reduction result = measurements.reduce(0.2);
  for (const std::size_t species : {0U, 1U}) {
    const std::string prefix = species == 0 ? "" : "/rods_3";
    std::vector<analysis::RodInertia> inertias;
    std::vector<analysis::RodAxis> axes;
    for (std::size_t i = 0; i < 100; ++i) {
      if (cell.species_of(i) != species) continue;
      const Species& rod = world.species_of(i);
      inertias.push_back({rod.mass, rod.inertia_perp, rod.inertia_par});
      axes.push_back({rod.tail.length, rod.head.length});
    }
    // at the first sample of each observable
    const auto sampled = [&](const std::string& observable) {
      const double time = result.arrays.at(prefix + observable + "/time_s").at(0);
      return random_snapshot(std::lround(time / kDt));
    };
    const auto theirs = [&](const auto& values) { return cell.of_species(species, values); };
    Snapshot now = sampled("/temperatures");
    const auto found = analysis::granular_temperatures(theirs(now.director), theirs(now.velocity),
                                                       theirs(now.angular_velocity), inertias);
    EXPECT_EQ(result.arrays.at(prefix + "/temperatures/vertical_pJ").at(0), found[1]);
    now = sampled("/clusters");
    const analysis::ClusterRule rule{mixture.plan.clusters->distance_for(mixture.plan.system.rod.mid_diameter),
                                     mixture.plan.clusters->angle * kPi / 180};
    const auto sizes =
        analysis::cluster_sizes(theirs(now.position), theirs(now.director), axes, analysis::Region(now.box), rule);
    EXPECT_EQ(result.arrays.at(prefix + "/clusters/largest").at(0),
              static_cast<double>(sizes.front()) / static_cast<double>(axes.size()));
  }
}

TEST(Measurements, OfEachSpeciesAreThoseOfItsRodsAlone) {
  Mixture mixture;
  mixture.plan.stress.reset();  // which counts all rods, as the next test has it
  Measurements measurements(mixture.plan, mixture.cell);
  measure(measurements, 0, 20000);
  const Reduction both = measurements.reduce(0.2);
  std::size_t n_arrays = 0, n_scalars = 0;
  for (const std::size_t species : {0, 1}) {
    const Reduction alone = mixture.alone(species, 20000);
    for (const auto& [path, values] : alone.arrays) {
      const auto found = both.arrays.find((species == 0 ? "" : "/rods_3") + path);
      ASSERT_NE(found, both.arrays.end()) << path;
      ASSERT_EQ(found->second.size(), values.size()) << path;
      for (std::size_t k = 0; k < values.size(); ++k) expect_same(found->second[k], values[k], path);
      ++n_arrays;
    }
    for (const auto& [name, scalar] : alone.scalars) {
      const auto found = both.scalars.find((species == 0 ? "" : "rods_3.") + name);
      ASSERT_NE(found, both.scalars.end()) << name;
      expect_same(found->second.value, scalar.value, name);
      expect_same(found->second.sem, scalar.sem, name);
      EXPECT_EQ(found->second.reason, scalar.reason) << name;
      ++n_scalars;
    }
    const analysis::SteadySummary& order = *alone.order;
    const Scalar S = species == 0 ? Scalar{{both.order->mean, both.order->sem}} : both.scalars.at("rods_3.S");
    expect_same(S.value, order.mean, "S");
    expect_same(S.sem, order.sem, "its error");
    EXPECT_EQ(S.reason, "");
  }
  EXPECT_EQ(both.arrays.size(), n_arrays) << "nothing else is there";
  EXPECT_EQ(both.scalars.size(), n_scalars + 1) << "but S of the other species";
  EXPECT_EQ(Measurements(mixture.plan, mixture.cell).reduce(0.2).scalars.at("rods_3.S").reason,
            "no sample of the steady state");
}

TEST(Measurements, CollisionsAreThoseOfAllRods) {
  const Mixture mixture;
  Measurements measurements(mixture.plan, mixture.cell);
  measure(measurements, 0, 20000);
  const auto numbers = measurements.reduce(0.2).scalars;
  EXPECT_NEAR(numbers.at("impacts_rods_Hz").value, 20, 1e-9);  // each is one of two rods
  EXPECT_NEAR(numbers.at("mean_free_time_s").value, 0.05, 1e-12);
  EXPECT_NEAR(numbers.at("impacts_base_Hz").value, 3, 1e-9);
  EXPECT_NEAR(numbers.at("power_lost_rods_pJ_s").value, 40, 1e-9);
  EXPECT_FALSE(numbers.contains("rods_3.impacts_rods_Hz"));
  // kinetic (15 + 5) / 2 of 100 rods, collisional (100 + 50) / 2 in a box of 20 mm
  EXPECT_NEAR(numbers.at("pressure_pJ_mm2").value, 10 * 100 / 99.0 + 75, 1e-9);
  EXPECT_NEAR(numbers.at("pressure_collisional_pJ_mm2").value, 75, 1e-9);
  EXPECT_NEAR(numbers.at("pressure_along_pJ_mm2").value + numbers.at("pressure_across_pJ_mm2").value,
              20 * 100 / 99.0 + 150, 1e-9);
  EXPECT_FALSE(numbers.contains("rods_3.pressure_pJ_mm2"));
}

// 60 rods and 40 of the third species at random places are mixed.
TEST(Measurements, MixingIsOfAllRodsByTheirSpecies) {
  Mixture mixture;
  mixture.plan.mixing = scene::MeasureMixing{0.01, 10, 4};
  for (const auto of : {scene::MeasuredSpecies::kFirst, scene::MeasuredSpecies::kEach}) {
    mixture.plan.of = of;
    Measurements measurements(mixture.plan, mixture.cell);
    measure(measurements, 0, 20000);
    const Reduction result = measurements.reduce(0.2);
    for (const char* there : {"/mixing/r_mm", "/mixing/g_11", "/mixing/g_13", "/mixing/g_33_sem"})
      EXPECT_TRUE(result.arrays.contains(there)) << there;
    for (const char* none : {"/mixing/g_12", "/mixing/g_22", "/rods_3/mixing/g_11"})
      EXPECT_FALSE(result.arrays.contains(none)) << none;
    for (const double g : result.arrays.at("/mixing/g_13")) EXPECT_NEAR(g, 1, 0.4);
    const Scalar segregation = result.scalars.at("segregation_13");
    EXPECT_NEAR(segregation.value, 0, 0.05);
    EXPECT_GT(segregation.sem, 0);
    EXPECT_LT(segregation.sem, 0.05);
  }
}

TEST(Measurements, OfEachSpeciesGoOnBitwiseAfterASave) {
  Mixture mixture;
  mixture.plan.mixing = scene::MeasureMixing{0.01, 10, 4};
  Measurements straight(mixture.plan, mixture.cell), first(mixture.plan, mixture.cell);
  measure(straight, 0, 9000);
  measure(first, 0, 5000);
  Measurements second(mixture.plan, mixture.cell);
  ASSERT_TRUE(second.restore(first.save()));
  measure(second, 5001, 9000);
  EXPECT_EQ(second.save(), straight.save());
  scene::RunPlan of_first = mixture.plan;
  of_first.of = scene::MeasuredSpecies::kFirst;
  EXPECT_FALSE(Measurements(of_first, mixture.cell).restore(first.save()));
  EXPECT_EQ(straight.counts().at("order"), 20) << "ten samples of each";
}

TEST(Measurements, OfSpheresAmongRodsAreOfNoAxis) {
  Mixture mixture;
  RodShape& sphere = mixture.plan.system.added[1]->rod;
  sphere.n_beads = 1;
  sphere.length = sphere.mid_diameter = 0.8;
  Measurements measurements(mixture.plan, mixture.cell);
  measure(measurements, 0, 9000);
  const Reduction result = measurements.reduce(0.09);
  EXPECT_TRUE(result.order);
  EXPECT_TRUE(result.scalars.contains("rods_3.diffusion_mm2_s"));
  EXPECT_FALSE(result.scalars.contains("rods_3.S"));
  EXPECT_FALSE(result.scalars.contains("rods_3.diffusion_along_mm2_s"));
  EXPECT_FALSE(result.arrays.contains("/rods_3/g2/g2"));
  EXPECT_TRUE(result.arrays.contains("/rods_3/g2/g"));
}

}  // namespace
}  // namespace shaken::run
