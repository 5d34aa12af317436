#include "scene/load.h"

#include <array>
#include <random>

#include "scene/canonical.h"
#include "scene/sweeps/sweep.h"
#include "sim/rod/species.h"
#include "tests/support/effort.h"
#include "tests/unit/scene/mutated.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

TEST(LoadScene, AnEmptyObjectIsThePapersSystem) {
  const RunPlan plan = plan_of("{}");
  const System& system = plan.system;
  EXPECT_EQ(system.rod,
            (RodShape{.length = 4.5, .mid_diameter = 0.8, .end_diameter = 0.4, .n_beads = 15, .density = 8.5}));
  EXPECT_EQ(system.box_side, 83.73);
  EXPECT_EQ(system.gap, 1.2);
  EXPECT_EQ(system.frequency, 200);
  EXPECT_EQ(system.gravity, 9810);
  EXPECT_NEAR(system.amplitude, 0.043486, 1e-6);  // Gamma = 7
  EXPECT_EQ(system.rod_rod, (Contacts{0.05, 0.3}));
  EXPECT_EQ(system.rod_base, (Contacts{0.01, 0.3}));
  EXPECT_EQ(system.rod_lid, (Contacts{0.01, 0.3}));
  EXPECT_EQ(system.dt, 4e-6);
  EXPECT_EQ(system.start, Start::kAligned);
  EXPECT_EQ(system.seed, 1u);
  EXPECT_NEAR(system.n_rods, 0.75 * 83.73 * 83.73 / make_species(system.rod).area, 0.5);
  EXPECT_EQ(plan.steady, std::nullopt);
  EXPECT_EQ(plan.measure_time, 10);
  EXPECT_EQ(plan.order, MeasureOrder{0.01});
  EXPECT_EQ(plan.stream, Stream{20});
  EXPECT_FALSE(plan.angles || plan.tilt || plan.defects || plan.g2 || plan.msd || plan.trajectory || plan.movie);
  EXPECT_FALSE(plan.pairs || plan.layers || plan.lattice);
}

// Sharma & Soni 2024: 2,500 to 4,400 rods of 2.5 mm and 1,400 to 2,400 of 4.5 mm for area fractions 0.50 to 0.85.
TEST(LoadScene, NumbersOfRodsAreThePapers) {
  const auto count = [](std::string length, std::string fraction) {
    return plan_of("{}", {"rods.length=" + length, "rods.area_fraction=" + fraction}).system.n_rods;
  };
  EXPECT_NEAR(count("2.5", "0.50"), 2500, 75);
  EXPECT_NEAR(count("2.5", "0.85"), 4400, 75);
  EXPECT_NEAR(count("4.5", "0.50"), 1400, 50);
  EXPECT_NEAR(count("4.5", "0.85"), 2400, 50);
  EXPECT_EQ(plan_of("{}", {"rods.length=2.5"}).system.rod.n_beads, 9);
}

TEST(LoadScene, ReadsEveryKey) {
  const RunPlan plan = plan_of(R"({
    "rods":  { "length": "3.5 mm", "mid_diameter": 0.9, "end_diameter": "300 um", "beads": 11, "density": "2.7 g/cm^3",
               "count": 40, "start": "random" },
    "box":   { "side": "4 cm", "gap": "1.4 mm" },
    "plates":{ "amplitude": "50 um", "frequency": "0.15 kHz" },
    "gravity": "1.62 m/s^2",
    "contacts": { "rod_rod":  { "friction": 0.5, "restitution": 0.6 }, "rod_base": { "friction": 0.2 },
                  "rod_lid":  { "restitution": 1 }, "law": "newton", "sweeps": 3 },
    "time": { "step": "2 us", "engine": "reference", "steady": "3 min", "measure": "1 h", "seed": 77 },
    "measure": { "order": {"every": "20 ms"}, "angles": {"every": "30 ms", "bins": 90}, "tilt": {"bins": 20},
                 "defects": {"every": "1 s", "smoothing": "2 mm", "grid": "0.5 mm", "list": true,
                             "min_lifetime": "2 s"}, "g2": {"bins": 50, "every": 0.2},
                 "msd": {"every": "5 ms"}, "rotation": {"every": "2 ms"}, "velocity": {"every": "50 ms", "window": "1 s"},
                 "rods": {"every": "20 ms", "count": 7, "duration": "1 min"},
                 "fluctuations": {"every": "3 s"}, "frank": {"every": "0.3 s"},
                 "pairs": {"every": "0.4 s", "bins": 41, "range": "9 mm"}, "layers": {"every": "0.3 s"},
                 "lattice": {"every": "2 s"} },
    "trajectory": {"every": "40 ms"}, "stream": {"rate": "5 Hz"}, "movie": {"every": "25 ms", "size": [640, 480]} })");
  RunPlan want;
  want.system.rod = {.length = 3.5, .mid_diameter = 0.9, .end_diameter = 0.3, .n_beads = 11, .density = 2.7};
  want.system.n_rods = 40;
  want.system.start = Start::kRandom;
  want.system.box_side = 40;
  want.system.gap = 1.4;
  want.system.amplitude = 0.05;
  want.system.frequency = 150;
  want.system.gravity = 1620;
  want.system.rod_rod = {0.5, 0.6};
  want.system.rod_base = {0.2, 0.3};
  want.system.rod_lid = {0.01, 1};
  want.system.solver_sweeps = 3;
  want.system.dt = 2e-6;
  want.system.stepper = StepperKind::kReference;
  want.system.seed = 77;
  want.steady = 180;
  want.measure_time = 3600;
  want.order = MeasureOrder{0.02};
  want.angles = MeasureAngles{0.03, 90};
  want.tilt = MeasureTilt{0.001, 20};
  want.defects = MeasureDefects{1, 2, 0.5, true, 2};
  want.g2 = MeasureG2{0.2, 50};
  want.msd = MeasureMsd{0.005};
  want.rotation = MeasureRotation{0.002};
  want.velocity = MeasureVelocity{0.05, 1};
  want.rods = MeasureRods{0.02, 7, 60};
  want.fluctuations = MeasureFluctuations{3};
  want.frank = MeasureFrank{0.3};
  want.pairs = MeasurePairs{0.4, 41, 9};
  want.layers = MeasureLayers{0.3};
  want.lattice = MeasureLattice{2};
  want.trajectory = Trajectory{0.04};
  want.stream = Stream{5};
  want.movie = Movie{0.025, 640, 480};
  EXPECT_EQ(plan, want);
}

TEST(LoadScene, BlocksAreOffWhenAbsentAndExactlyThoseNamedAreOn) {
  const RunPlan plan = plan_of(R"({"measure": {"tilt": {}, "msd": true, "g2": false}, "movie": {}, "stream": null})");
  EXPECT_EQ(plan.tilt, MeasureTilt{});
  EXPECT_EQ(plan.msd, MeasureMsd{});
  EXPECT_EQ(plan.movie, Movie{});
  EXPECT_FALSE(plan.order || plan.g2 || plan.stream || plan.trajectory || plan.angles || plan.defects);
  EXPECT_FALSE(plan.fluctuations || plan.frank);
  EXPECT_FALSE(plan_of(R"({"stream": false})").stream);
  EXPECT_FALSE(plan_of(R"({"measure": {}})").order);
  EXPECT_FALSE(plan_of(R"({"measure": null})").order);
}

TEST(LoadScene, DefectFieldFollowsTheRodsLength) {
  const RunPlan plan = plan_of(R"({"rods": {"length": 3}, "measure": {"defects": {}}})");
  EXPECT_EQ(plan.defects, (MeasureDefects{0.1, 1.5, 0.375}));
}

TEST(LoadScene, DefectMapsFollowTheRodsLengthAndTheBox) {
  EXPECT_EQ(plan_of(R"({"rods": {"length": 3}, "measure": {"defect_maps": {}}})").defect_maps,
            (MeasureDefectMaps{0.2, 31, 6, 3, 1.5, 0.375}));
  EXPECT_EQ(plan_of(R"({"box": {"side": 16}, "measure": {"defect_maps": {}}})").defect_maps->range, 8);
}

TEST(LoadScene, DensityMapsFollowTheRodsLength) {
  EXPECT_EQ(plan_of(R"({"rods": {"length": 3}, "measure": {"density": {}}})").density, (MeasureDensity{0.1, 1, 3}));
}

TEST(LoadScene, PairMapFollowsTheRodsLengthAndTheBox) {
  EXPECT_EQ(plan_of(R"({"rods": {"length": 3}, "measure": {"pairs": {}}})").pairs, (MeasurePairs{0.5, 81, 9}));
  EXPECT_EQ(plan_of(R"({"box": {"side": 20}, "measure": {"pairs": {}}})").pairs, (MeasurePairs{0.5, 81, 10}));
}

TEST(LoadScene, LengthsOfObservablesFollowTheRods) {
  const RunPlan plan = plan_of(R"({"rods": {"length": 3, "mid_diameter": 0.6},
                                   "measure": {"scattering": {}, "van_hove": {}, "clusters": {}}})");
  EXPECT_EQ(plan.scattering, (MeasureScattering{0.01, 3}));
  EXPECT_EQ(plan.van_hove, (MeasureVanHove{0.01, 1, 40, 3}));
  EXPECT_EQ(plan.clusters, (MeasureClusters{0.1, 0.75, 90}));
  EXPECT_EQ(plan_of(R"({"measure": {"scattering": {"wavelength": 1.5}}})").scattering->wavelength, 1.5);
}

TEST(LoadScene, NullIsAsIfTheKeyWereNotThere) {
  EXPECT_EQ(plan_of(R"({"rods": {"length": null, "beads": null}, "box": null})"), plan_of("{}"));
}

TEST(LoadScene, ASphereIsOneBead) {
  const RunPlan plan = plan_of(R"({"rods": {"beads": 1, "length": 0.8, "area_fraction": 0.4}, "box": {"side": 10}})");
  EXPECT_EQ(plan.system.rod.n_beads, 1);
  EXPECT_EQ(plan.system.n_rods, 80);  // 0.4 * 100 / (pi 0.16) = 79.6
}

// Whatever is written: an answer, never a crash, and either a plan that can be written and read again or a problem.

void check(const std::string& text) {
  const Loaded<RunPlan> scene = load_scene(text, "f");
  ASSERT_TRUE(scene || !scene.error().empty()) << text;
  if (scene) {
    const Loaded<RunPlan> again = load_scene(to_json(*scene).dump(), "f");
    ASSERT_TRUE(again) << text << "\n" << to_string(again.error());
    ASSERT_EQ(*again, *scene) << text;
  }
  const Loaded<Sweep> sweep = load_sweep(text, "f");
  ASSERT_TRUE(sweep || !sweep.error().empty()) << text;
  ASSERT_TRUE(!sweep || !sweep->points.empty()) << text;
}

TEST(Mutation, TheOriginalsAreValid) {
  EXPECT_TRUE(load_scene(kScene, "f")) << to_string(load_scene(kScene, "f").error());
  for (const std::string_view sweep : {kSweep, kSweeps}) {
    EXPECT_TRUE(load_sweep(sweep, "f")) << to_string(load_sweep(sweep, "f").error());
  }
}

TEST(Mutation, NothingCrashes) {
  std::mt19937_64 random(20240801);
  for (int i = 0; i < test::draws(30000); ++i) {
    const std::string text = mutated(std::array{kScene, kSweep, kSweeps}[static_cast<std::size_t>(i % 3)], random);
    ASSERT_NO_THROW(check(text)) << text;
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(Mutation, SettingsNeitherCrash) {
  std::mt19937_64 random(20240802);
  constexpr auto kSettings =
      std::to_array<std::string_view>({"rods.length=2.5,3.5", "measure={\"order\":{}}", "box.gap=1.2:1.4:0.1 mm",
                                       "movie.size=[640,480]", "stream=null"});
  for (int i = 0; i < test::draws(5000); ++i) {
    const std::vector<std::string> settings{mutated(kSettings[random() % kSettings.size()], random)};
    ASSERT_NO_THROW({
      const auto scene = load_scene("{}", "f", settings);
      ASSERT_TRUE(scene || !scene.error().empty()) << settings[0];
      const auto sweep = load_sweep(kSweep, "f", settings);
      ASSERT_TRUE(sweep || !sweep.error().empty()) << settings[0];
    }) << settings[0];
  }
}

}  // namespace
}  // namespace shaken::scene
