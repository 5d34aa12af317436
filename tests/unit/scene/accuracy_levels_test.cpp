#include "scene/keys/accuracy_levels.h"

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "scene/canonical.h"
#include "scene/keys/fields.h"
#include "scene/load.h"
#include "scene/sweeps/sweep.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace accuracy_levels_test {

// Whichever of the keys it is: later settings override.
TEST(Accuracy, ASettingWinsOverWhatTheFileSays) {
  const auto step = [](const char* text, const std::vector<std::string>& settings) {
    const auto plan = load_scene(text, "run.json", settings);
    return plan ? plan->system.dt : -1.0;
  };
  EXPECT_EQ(step(R"({"time": {"step": "4 us"}})", {"accuracy=desk"}), 16e-6);
  EXPECT_EQ(step(R"({"accuracy": "paper"})", {"time.step=8us"}), 8e-6);
  EXPECT_EQ(step(R"({"accuracy": "paper"})", {"accuracy=draft"}), 32e-6);
  EXPECT_EQ(step(R"({"accuracy": "paper", "time": {"step": "5 us"}})", {}), -1.0) << "the file contradicts itself";
  EXPECT_EQ(step("{}", {"accuracy=paper", "time.step=5us"}), -1.0) << "so do the settings";
  const std::vector<std::string> swept{"accuracy=draft,paper"};
  const auto sweep = load_sweep(R"({"time": {"step": "4 us"}})", "run.json", swept);
  ASSERT_TRUE(sweep);
  ASSERT_EQ(sweep->points.size(), 2U);
  EXPECT_EQ(sweep->points[0].plan.system.dt, 32e-6);
  EXPECT_EQ(sweep->points[1].plan.system.dt, 4e-6);
}

/// The rows of docs/data/accuracy-bias.csv, by the names of its columns.
using Row = std::map<std::string, std::string>;
std::vector<Row> measured() {
  std::ifstream file(SHAKEN_SOURCE_DIR "/docs/data/accuracy-bias.csv");
  const auto words_of = [](const std::string& line) {
    std::istringstream words(line);
    std::vector<std::string> all;
    for (std::string word; std::getline(words, word, ',');) all.push_back(word);
    return all;
  };
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> columns = words_of(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> words = words_of(line);
    EXPECT_EQ(words.size(), columns.size()) << line;
    for (std::size_t k = 0; k < std::min(words.size(), columns.size()); ++k) {
      if (k == 0) rows.emplace_back();
      rows.back()[columns[k]] = words[k];
    }
  }
  return rows;
}

double number(const Row& row, const std::string& column) { return std::stod(row.at(column)); }

/// |bias| with two standard errors to spare, of the largest of `observables` [%].
double bound_of(const Row& row, const std::vector<std::string>& observables) {
  double bound = 0;
  for (const std::string& name : observables) {
    bound = std::max(bound,
                     std::abs(number(row, name + "_bias_percent")) + 2 * number(row, name + "_standard_error_percent"));
  }
  return bound;
}

/// One way to set time.step and time.impacts, as it did with both rods.
struct Setting {
  double step_us = 0;
  std::string impacts;
  int n_rods = 0;
  double cost = 0;  ///< mean over the rods
  double averages = 0, just_hit = 0;
};

std::vector<Setting> settings() {
  std::map<std::pair<double, std::string>, Setting> all;
  for (const Row& row : measured()) {
    Setting& setting = all[{number(row, "step_us"), row.at("impacts")}];
    setting.step_us = number(row, "step_us");
    setting.impacts = row.at("impacts");
    setting.cost =
        (setting.n_rods * setting.cost + number(row, "cost_relative_to_4_us_at_tick_end")) / (setting.n_rods + 1);
    ++setting.n_rods;
    setting.averages =
        std::max(setting.averages,
                 bound_of(row, {"T_in_plane", "T_upright", "T_rotation", "rms_n_z", "square_displacement_20.7_ms"}));
    setting.just_hit = std::max(setting.just_hit, bound_of(row, {"just_hit"}));
  }
  std::vector<Setting> list;
  for (const auto& [key, setting] : all) list.push_back(setting);
  return list;
}

TEST(Accuracy, LevelsSayWhatWasMeasured) {
  const std::map<std::string_view, std::string> columns{
      {"order", "order_S"},
      {"temperature in the plane", "T_in_plane"},
      {"temperature upright", "T_upright"},
      {"square displacement in 20.7 ms", "square_displacement_20.7_ms"},
      {"rods just hit", "just_hit"}};
  for (const AccuracyLevel& level : accuracy_levels()) {
    SCOPED_TRACE(level.name);
    int n_found = 0;
    for (const Row& row : measured()) {
      if (number(row, "rod_length_mm") != 4.5 || number(row, "step_us") != std::round(1e6 * level.step) ||
          row.at("impacts") != name_of(level.impacts)) {
        continue;
      }
      ++n_found;
      EXPECT_EQ(level.cost, number(row, "cost_relative_to_4_us_at_tick_end"));
      ASSERT_EQ(level.bias.size(), columns.size());
      for (const Bias& bias : level.bias) {
        EXPECT_EQ(bias.value, number(row, columns.at(bias.observable) + "_bias_percent")) << bias.observable;
        EXPECT_EQ(bias.error, number(row, columns.at(bias.observable) + "_standard_error_percent")) << bias.observable;
        EXPECT_EQ(bias.unit, "%");
      }
    }
    EXPECT_EQ(n_found, 1);
  }
}

TEST(Accuracy, LevelsKeepToTheirBoundsAtTheLeastCost) {
  const std::vector<Setting> all = settings();
  ASSERT_EQ(all.size(), 14u);  // seven steps, two ways
  for (const AccuracyLevel& level : accuracy_levels()) {
    SCOPED_TRACE(level.name);
    const auto own = std::find_if(all.begin(), all.end(), [&](const Setting& setting) {
      return setting.step_us == std::round(1e6 * level.step) && setting.impacts == name_of(level.impacts);
    });
    ASSERT_NE(own, all.end());
    EXPECT_EQ(own->n_rods, 2);
    EXPECT_LT(own->averages, level.averages_within);
    EXPECT_LT(own->just_hit, level.just_hit_within);
    if (level.name == "paper") continue;  // the paper's own, whatever it costs
    for (const Setting& other : all) {
      // what contacts do is not what the coarse levels are chosen for
      const bool would_do =
          other.averages < level.averages_within && (level.name != "fine" || other.just_hit < level.just_hit_within);
      EXPECT_FALSE(other.cost < own->cost && would_do) << other.step_us << " us, " << other.impacts;
    }
  }
  EXPECT_EQ(accuracy_level("desk")->averages_within, 1);
}

TEST(Accuracy, LevelsGoFromCoarseToFineAndAreAllowedSteps) {
  double last = 1;
  for (const AccuracyLevel& level : accuracy_levels()) {
    EXPECT_LT(level.step, last) << level.name;
    EXPECT_TRUE(is_allowed(field_at("time.step"), level.step)) << level.name;
    EXPECT_EQ(accuracy_level(level.name), &level);
    System at_level;
    at_level.dt = level.step;
    at_level.impacts = level.impacts;
    EXPECT_EQ(accuracy_level(at_level), &level);
    last = level.step;
  }
  EXPECT_EQ(accuracy_level("sloppy"), nullptr);
  System between;
  between.dt = 4e-6;
  between.impacts = ImpactTime::kAtInstant;
  EXPECT_EQ(accuracy_level(between), nullptr) << "the step of a level, but not its impacts";
}

TEST(Accuracy, StandsForAStepAndForTheInstantOfImpacts) {
  for (const AccuracyLevel& level : accuracy_levels()) {
    const std::string setting = "accuracy=" + std::string(level.name);
    const RunPlan plan = plan_of("{}", {setting});
    EXPECT_EQ(plan.system.dt, level.step);
    EXPECT_EQ(plan.system.impacts, level.impacts);
    // the run is that of the step: its name says nothing of the word
    const std::vector<std::string> both{"time.step=" + std::to_string(level.step * 1e6) + " us",
                                        std::string("time.impacts=") + name_of(level.impacts)};
    EXPECT_EQ(run_id(plan), run_id(plan_of("{}", both)));
    EXPECT_EQ(plan_of("{}", {setting, both[0], both[1]}), plan) << "said twice";
    EXPECT_FALSE(to_json(plan).contains("accuracy"));
    EXPECT_EQ(to_json(plan)["time"]["step"], level.step);
  }
  EXPECT_EQ(run_id(plan_of(R"({"accuracy": "paper"})")), run_id(plan_of("{}")));
  EXPECT_EQ(plan_of(R"({"accuracy": null})"), plan_of("{}"));
}

TEST(Accuracy, ContradictingTheStepOrTheImpactsIsRefused) {
  EXPECT_EQ(plan_of(R"({"accuracy": "paper", "time": {"step": "4 us"}})"), plan_of("{}"));
  EXPECT_EQ(
      problem_of(R"({"accuracy": "fine", "time": {"step": "4 us"}})"),
      "run.json:1:14: /accuracy: accuracy \"fine\" is a time.step of 2 us, but time.step 4 us is given; remove one");
  EXPECT_EQ(problem_of(R"({"accuracy": "fine", "time": {"impacts": "tick_end"}})"),
            "run.json:1:14: /accuracy: accuracy \"fine\" is time.impacts \"at_instant\", but time.impacts \"tick_end\" "
            "is given; remove one");
  EXPECT_EQ(problem_of(R"({"accuracy": "desk", "time": {"impacts": "at_instant"}})"),
            "run.json:1:14: /accuracy: accuracy \"desk\" is time.impacts \"tick_end\", but time.impacts \"at_instant\" "
            "is given; remove one");
  EXPECT_EQ(
      problem_of(R"({"accuracy": "fin"})"),
      "run.json:1:14: /accuracy: \"fin\" is not one of \"draft\", \"desk\", \"paper\", \"fine\"; did you mean fine?");
  EXPECT_NE(problem_of(R"({"accuracy": "draft", "plates": {"frequency": "5 kHz"}})").find("at most 10 us"),
            std::string::npos);
}

TEST(Accuracy, CanBeSwept) {
  const auto sweep = load_sweep(R"({"scene": {}, "sweep": {"grid": {"accuracy": ["draft", "fine"]}}})", "s.json");
  ASSERT_TRUE(sweep) << to_string(sweep.error());
  ASSERT_EQ(sweep->points.size(), 2u);
  EXPECT_EQ(sweep->points[0].label, "accuracy=draft");
  EXPECT_EQ(sweep->points[0].plan.system.dt, accuracy_level("draft")->step);
  EXPECT_EQ(sweep->points[1].plan.system.dt, accuracy_level("fine")->step);
  EXPECT_EQ(sweep->points[0].plan.system.impacts, ImpactTime::kTickEnd);
  EXPECT_EQ(sweep->points[1].plan.system.impacts, ImpactTime::kAtInstant);
}

}  // namespace accuracy_levels_test
}  // namespace shaken::scene
