#include "scene/canonical.h"

#include <rapidcheck.h>

#include <nlohmann/json.hpp>

#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

/// A scene within the allowed ranges, most keys left out at random; whole digits of doubles, not only round numbers.
nlohmann::json random_scene() {
  nlohmann::json scene = nlohmann::json::object();
  const auto maybe = [] { return *rc::gen::arbitrary<bool>(); };
  const auto between = [](double low, double high) {
    return low + (high - low) * *rc::gen::inRange<std::int64_t>(0, 1'000'000'007) / 1'000'000'006.0;
  };
  auto& rods = scene["rods"] = nlohmann::json::object();
  if (maybe()) rods["length"] = between(2, 8);
  if (maybe()) rods["mid_diameter"] = between(0.6, 1.0);
  if (maybe()) rods["end_diameter"] = between(0.4, 1.0);
  if (maybe()) rods["bead_pitch"] = between(0.1, 0.4);
  if (maybe()) rods["density"] = between(1, 20);
  if (maybe()) rods["start"] = "aligned";
  if (maybe()) rods["length_spread"] = between(0, 0.1);
  if (maybe()) rods["end_diameter_spread"] = between(0, 0.1);
  const bool fraction = maybe();
  if (fraction) rods["area_fraction"] = between(0.01, 0.85);
  if (maybe()) rods["count"] = *rc::gen::inRange(40, 100);
  if (maybe() && !(fraction && rods.contains("count"))) scene["box"]["side"] = between(50, 150);
  if (maybe()) scene["box"]["gap"] = between(1.1, 3);
  const bool gamma = maybe();
  if (gamma) scene["plates"]["gamma"] = between(1, 20);
  const bool amplitude = maybe();
  if (amplitude) scene["plates"]["amplitude"] = between(0.01, 0.2);
  if (maybe() && !(gamma && amplitude)) scene["plates"]["frequency"] = between(50, 400);
  if (maybe()) scene["gravity"] = between(1000, 20000);
  for (const char* pair : {"rod_rod", "rod_base", "rod_lid"}) {
    if (maybe()) scene["contacts"][pair]["friction"] = between(0, 1);
    if (maybe()) scene["contacts"][pair]["restitution"] = between(0, 1);
  }
  if (maybe()) scene["contacts"]["sweeps"] = *rc::gen::inRange(1, 20);
  if (maybe()) scene["time"]["step"] = between(1e-6, 1e-5);
  if (maybe()) scene["time"]["steady"] = between(0, 100);
  if (maybe()) scene["time"]["measure"] = between(0.01, 6000);
  if (maybe()) scene["time"]["seed"] = *rc::gen::inRange<std::int64_t>(0, 9007199254740992);
  if (maybe()) {
    auto& measure = scene["measure"] = nlohmann::json::object();
    for (const char* what : {"order", "angles", "tilt", "defects", "g2", "msd", "rotation", "rods"}) {
      if (maybe()) measure[what]["every"] = between(1e-5, 1);
    }
    if (maybe()) measure["velocity"] = {{"every", between(1e-5, 0.3)}, {"window", between(0.3, 2)}};
    if (maybe()) measure["rods"]["count"] = *rc::gen::inRange(1, 20);
    if (maybe()) measure["defects"]["smoothing"] = between(0.5, 5);
    if (maybe()) measure["tilt"]["bins"] = *rc::gen::inRange(2, 200);
  }
  if (maybe()) scene["trajectory"]["every"] = between(1e-4, 1);
  if (maybe())
    scene["rods_2"] = {{"length", between(1.5, 4)}, {"profile", "polar"}, {"area_fraction", between(1e-3, 0.01)}};
  if (maybe())
    scene["rods_3"] = {{"beads", 1}, {"mid_diameter", between(0.1, 0.9)}, {"count", *rc::gen::inRange(1, 20)}};
  if (!rods.contains("count") && !(scene.contains("box") && scene["box"].contains("side")) && maybe()) {
    scene["walls"] = {{"arena", "disc"}};
    if (maybe()) scene["walls"]["size"] = between(40, 120);
    if (maybe()) scene["walls"]["arena"] = maybe() ? "stadium" : "channel";
    if (maybe()) scene["walls"]["arena"] = maybe() ? "ellipse" : "wedge";
    if (maybe() && scene["walls"]["arena"] == "stadium") scene["walls"]["length"] = between(0, 120);
    if (maybe() && scene["walls"]["arena"] == "ellipse") scene["walls"]["length"] = between(120, 240);
    if (maybe() && scene["walls"]["arena"] == "wedge") scene["walls"]["narrow"] = between(0, 20);
    if (maybe() && scene["walls"]["arena"] == "channel") scene["box"]["aspect"] = between(0.3, 3);
  }
  if (maybe()) scene["plates"]["noise"] = between(0, 1);
  if (scene.contains("rods_2") && maybe()) scene["plates"]["rods_2"]["noise"] = maybe() ? 0 : between(0, 1);
  if (maybe()) scene["plates"]["lid"] = false;
  if (maybe()) scene["time"]["impacts"] = "at_instant";
  if (maybe()) scene["until"] = {{"order_sem", between(0.001, 0.1)}, {"at_most", between(100, 1000)}};
  if (maybe()) scene["stream"] = nullptr;
  if (maybe()) scene["movie"] = {{"every", between(0.001, 1)}, {"size", {2 * *rc::gen::inRange(32, 1000), 480}}};
  return scene;
}

TEST(Canonical, ReadsBackAsTheIdenticalPlan) {
  EXPECT_TRUE(rc::check("load(to_json(plan)) == plan", [] {
    const std::string text = random_scene().dump();
    const Loaded<RunPlan> first = load_scene(text, "f");
    RC_PRE(first);  // few are impossible: a box too small for its rods, say
    const std::string canonical = to_json(*first).dump();
    const Loaded<RunPlan> second = load_scene(canonical, "f");
    if (!second) RC_LOG() << canonical << "\n" << to_string(second.error());
    RC_ASSERT(second);
    RC_ASSERT(*second == *first);
    RC_ASSERT(to_json(*second).dump() == canonical);
    RC_ASSERT(run_id(*second) == run_id(*first));
  }));
}

TEST(Canonical, ReadsBackWithoutGravity) {
  for (const char* text : {R"({"gravity": 0, "plates": {"amplitude": 0.05, "frequency": 100}})",
                           R"({"gravity": 0, "plates": {"gamma": 0}})", R"({"plates": {"gamma": 0}})"}) {
    const RunPlan plan = plan_of(text);
    EXPECT_EQ(plan_of(to_json(plan).dump()), plan) << text;
  }
  EXPECT_FALSE(to_json(plan_of(R"({"gravity": 0, "plates": {"amplitude": 0}})"))["plates"].contains("gamma"));
}

TEST(Canonical, HoldsWhatWasDerived) {
  const auto scene = to_json(plan_of(R"({"box": {"side": 40}, "measure": {"defects": {}}})"));
  EXPECT_EQ(scene["rods"]["beads"], 15);
  EXPECT_EQ(scene["rods"]["count"], 481);
  EXPECT_NEAR(scene["rods"]["area_fraction"].get<double>(), 0.75, 0.001);
  EXPECT_EQ(scene["plates"]["gamma"], 7);
  EXPECT_NEAR(scene["plates"]["amplitude"].get<double>(), 0.043486, 1e-6);
  EXPECT_EQ(scene["time"]["steady"], "auto");
  EXPECT_EQ(scene["measure"]["defects"]["smoothing"], 2.25);
  EXPECT_TRUE(scene["measure"]["order"].is_null());
  EXPECT_FALSE(scene.contains("movie"));
  EXPECT_FALSE(scene["rods"].contains("bead_pitch"));
}

TEST(RunId, IsPinned) {
  // Changes when the canonical form or the physics version changes: then every run of every user gets a new name.
  EXPECT_EQ(run_id(plan_of("{}")), "756c941e733ffdea");
  EXPECT_EQ(scene_hash(plan_of("{}")), "e96c3e3ad02c38b2");
}

TEST(RunId, DoesNotDependOnHowASceneIsWritten) {
  const std::string id = run_id(plan_of(R"({"rods": {"length": 2.5, "area_fraction": 0.6}, "time": {"step": 2e-6}})"));
  EXPECT_EQ(
      run_id(plan_of(R"({"time": {"step": "2 us"}, /* order */ "rods": {"area_fraction": 6e-1, "length": "2500 um"},
                              "box": {"side": "8.373 cm"}, "plates": {"gamma": 7.0}})")),
      id);
  EXPECT_EQ(run_id(plan_of(R"({"rods": {"area_fraction": 0.6}, "time": {"step": 2e-6}})", {"rods.length=2.5"})), id);
}

TEST(RunId, DependsOnEverythingButTheLengthAndTheStream) {
  const std::string id = run_id(plan_of("{}"));
  EXPECT_EQ(run_id(plan_of(R"({"stream": null})")), id);
  EXPECT_EQ(run_id(plan_of(R"({"stream": {"rate": 5}})")), id);
  EXPECT_EQ(run_id(plan_of(R"({"time": {"measure": 11}})")), id);
  EXPECT_EQ(run_id(plan_of(R"({"until": {"order_sem": 0.01, "at_most": "1 h"}})")), id);
  EXPECT_NE(scene_hash(plan_of(R"({"time": {"measure": 11}})")), scene_hash(plan_of("{}")));
  for (const char* other :
       {R"({"time": {"seed": 2}})", R"({"time": {"steady": 1}})", R"({"measure": {"order": {}, "msd": {}}})",
        R"({"movie": {}})", R"({"trajectory": {}})", R"({"contacts": {"rod_lid": {"friction": 0.02}}})",
        R"({"box": {"gap": 1.2000000000000002}})"}) {
    EXPECT_NE(run_id(plan_of(other)), id) << other;
  }
}

// What a pair of species has as all rods have is not its own.
TEST(Canonical, ContactsAsForAllRodsAreLeftOut) {
  const RunPlan own = plan_of(R"({"rods_2": {"count": 9}, "contacts": {"rod_base": {"restitution_speed": 30,
                                  "rods_2": {"friction": 0.2, "restitution": 0.3}}}})");
  const nlohmann::ordered_json base = to_json(own).at("contacts").at("rod_base");
  EXPECT_EQ(base.dump(), R"({"friction":0.01,"restitution":0.3,"restitution_speed":30.0,"rods_2":{"friction":0.2}})");
  const std::string common = R"({"rods_2": {"count": 9}})";
  EXPECT_EQ(run_id(plan_of(common)),
            run_id(plan_of(common, {"contacts.rod_lid.rods_2.friction=0.01", "contacts.rod_rod.restitution_speed=0"})));
  EXPECT_NE(run_id(plan_of(common)), run_id(plan_of(common, {"contacts.rod_lid.rods_2.friction=0.02"})));
}

// Noise of a species that is as for all rods is not its own: scenes keep the run ids that they had before.
TEST(Canonical, NoiseAsForAllRodsIsLeftOut) {
  const std::string two = R"({"rods_2": {"count": 9}, "plates": {"noise": 0.02}})";
  const RunPlan own = plan_of(two, {"plates.rods_2.noise=0.03"});
  EXPECT_EQ(to_json(own).at("plates").at("rods_2").dump(), R"({"noise":0.03})");
  EXPECT_EQ(own.system.noise_of(0), 0.02);
  EXPECT_EQ(own.system.noise_of(1), 0.03);
  EXPECT_FALSE(to_json(plan_of(two)).at("plates").contains("rods_2"));
  EXPECT_EQ(run_id(plan_of(two)), run_id(plan_of(two, {"plates.rods_2.noise=0.02"})));
  EXPECT_NE(run_id(plan_of(two)), run_id(own));
  EXPECT_EQ(plan_of(two).system.noise_of(1), 0.02);
  EXPECT_EQ(plan_of(two, {"plates.noise=0", "plates.rods_2.noise=0"}), plan_of(R"({"rods_2": {"count": 9}})"));
}

}  // namespace
}  // namespace shaken::scene
