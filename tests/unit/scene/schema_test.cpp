#include "scene/schema.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <regex>
#include <sstream>

#include "scene/canonical.h"
#include "scene/sweeps/sweep.h"
#include "tests/support/effort.h"
#include "tests/unit/scene/mutated.h"
#include "tests/unit/scene/scene_support.h"

namespace shaken::scene {
namespace {

using Json = nlohmann::ordered_json;

std::string read_text(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// What a validator that knows nothing of Shaken says of each document: "ok", or what is wrong.
std::vector<std::string> verdicts(const Json& schema, const std::vector<Json>& documents) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("shaken-schema-{}", getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "schema.json") << schema.dump();
  {
    std::ofstream lines(folder / "documents");
    for (const Json& document : documents) lines << document.dump() << "\n";
  }
  const std::string in = folder.string();
  const int status = std::system(
      fmt::format(
          "/usr/bin/python3 {0}/tests/unit/scene/validate_by_schema.py {1}/schema.json {1}/documents > {1}/said",
          SHAKEN_SOURCE_DIR, in)
          .c_str());
  EXPECT_EQ(status, 0) << "is python3-jsonschema installed?";
  std::vector<std::string> found;
  std::ifstream said(folder / "said");
  for (std::string line; std::getline(said, line);) found.push_back(line);
  std::filesystem::remove_all(folder);
  EXPECT_EQ(found.size(), documents.size());
  found.resize(documents.size());
  return found;
}

bool is_number(const Field& field) { return field.form == Form::kQuantity || field.form == Form::kWhole; }

/// What may be written for `field`: its limits, its default and something between, with every unit.
std::vector<Json> allowed(const Field& field) {
  const double middle = field.low > 0 ? std::sqrt(field.low * field.high) : 0.5 * (field.low + field.high);
  std::vector<Json> numbers{field.low, field.high, middle};
  if (const double* usual = std::get_if<double>(&field.fallback)) numbers.emplace_back(*usual);
  for (const Unit& unit : units_of(field.dimension)) {
    numbers.push_back(fmt::format("{:.8g} {}", middle / unit.scale(), unit.name));
    numbers.push_back(fmt::format("{:.8g}{}", middle / unit.scale(), unit.name));
  }
  std::vector<Json> values{nullptr};
  switch (field.form) {
    case Form::kQuantity:
      values.insert(values.end(), numbers.begin(), numbers.end());
      values.insert(values.end(), field.names.begin(), field.names.end());
      break;
    case Form::kNumbers:
      for (const Json& number : numbers) values.push_back(Json::array({number, middle, number}));
      break;
    case Form::kPairs:
      for (const Json& number : numbers) values.push_back(Json::array({{number, middle}, {middle, number}}));
      break;
    case Form::kWhole:
      for (const double number : {field.low, field.high, std::round(middle)}) {
        values.emplace_back(static_cast<std::int64_t>(number));
        values.emplace_back(values.back().dump());
      }
      break;
    case Form::kName:
      values.insert(values.end(), field.names.begin(), field.names.end());
      break;
    case Form::kText:
      values.emplace_back("0123456789abcdef");
      break;
    case Form::kSize:
      values.insert(values.end(), {Json::array({64, 64}), Json::array({1280, 720})});
      break;
    case Form::kSwitch:
      values.insert(values.end(), {true, false});
      break;
    case Form::kBlock:
      values.insert(values.end(), {Json::object(), true, false});
      break;
    case Form::kTexts:
    case Form::kPair:
    case Form::kElsewhere:
      break;  // none in a scene
  }
  return values;
}

/// What neither may take: another type, a number out of range.
std::vector<Json> refused(const Field& field) {
  if (field.form == Form::kBlock) return {3, "on", Json::array()};
  std::vector<Json> values{Json::array({Json::object()}), {{"x", 1}}, Json::array({nullptr})};
  for (const double outside : {field.low - 1 - std::abs(field.low), 2 * field.high + 2}) {
    if (is_number(field)) values.emplace_back(outside);
    if (field.form == Form::kNumbers) values.push_back(Json::array({outside}));
    if (field.form == Form::kPairs) values.push_back(Json::array({{outside, outside}}));
    if (field.form == Form::kSize) values.push_back(Json::array({64, outside}));
  }
  return values;
}

/// The ways in which a sweep may have numbers from `from` to `to`.
std::vector<Json> ranges(double from, double to) {
  const std::string text = fmt::format("{:.6g}:{:.6g}:{:.6g}", from, to, to == from ? 1 : (to - from) / 3);
  return {text,
          Json::array({from, text}),
          {{"from", from}, {"to", fmt::format("{:.6g}", to)}, {"n", 3}},
          {{"from", from}, {"to", to}, {"n", 2}, {"scale", "log"}},
          {{"from", from}, {"to", to}, {"n", 2}, {"scale", "linear"}}};
}

Json scene_with(const std::string& path, const Json& value) {
  Json scene = Json::object();
  scene[Json::json_pointer("/" + std::regex_replace(path, std::regex("\\."), "/"))] = value;
  return scene;
}

bool accepted(bool as_sweep, const Json& document) {
  const std::string text = document.dump();
  return as_sweep ? static_cast<bool>(load_sweep(text, "f")) : static_cast<bool>(load_scene(text, "f"));
}

/// Asks both of all documents. Of those that are wrong neither may accept any; of the others the schema accepts every
/// one, and the loader, which knows what contradicts itself, most.
void expect_agreement(bool as_sweep, bool are_right, const std::vector<Json>& documents) {
  const std::vector<std::string> said = verdicts(as_sweep ? sweep_schema() : scene_schema(), documents);
  std::size_t n_accepted = 0;
  for (std::size_t i = 0; i < documents.size(); ++i) {
    n_accepted += accepted(as_sweep, documents[i]);
    EXPECT_EQ(said[i] == "ok", are_right) << documents[i].dump() << "\n" << said[i];
    if (are_right) continue;
    EXPECT_FALSE(accepted(as_sweep, documents[i])) << documents[i].dump();
  }
  EXPECT_GE(2 * n_accepted, are_right ? documents.size() : 0);
  testing::Test::RecordProperty("accepted", static_cast<int>(n_accepted));
}

TEST(Schema, AgreesOnEveryKeyOfAScene) {
  std::vector<Json> right{{{"$schema", "scene.schema.json"}}}, wrong{{{"nosuchkey", 1}}};
  for (const Field& field : fields()) {
    for (const Json& value : allowed(field)) right.push_back(scene_with(field.path, value));
    for (const Json& value : refused(field)) wrong.push_back(scene_with(field.path, value));
    if (field.form == Form::kBlock) wrong.push_back(scene_with(field.path + ".nosuchkey", 1));
  }
  expect_agreement(false, true, right);
  expect_agreement(false, false, wrong);
}

TEST(Schema, AgreesOnEveryKeyOfASweep) {
  const auto sweep = [](const Json& product) { return Json{{"scene", Json::object()}, {"sweep", product}}; };
  const Json gap{{"grid", {{"box.gap", {1.2, 1.3}}}}};
  std::vector<Json> right{sweep(gap), sweep(Json::array({gap, gap})), sweep({{"replicas", 3}})};
  right.push_back({{"$schema", "sweep.schema.json"}, {"name", "a name"}, {"sweep", gap}});
  std::vector<Json> wrong{sweep({{"replicas", 0}}),
                          sweep({{"replicas", "3"}}),
                          sweep({{"nosuchkey", 1}}),
                          sweep({{"grid", Json::array({{{"box.gap", 1}}})}}),
                          {{"nosuchkey", 1}, {"sweep", gap}}};
  for (const Json& n : {Json(0), Json(2.5)})
    wrong.push_back(sweep({{"zip", {{"box.gap", {{"from", 1}, {"to", 2}, {"n", n}}}}}}));
  wrong.push_back(sweep({{"zip", {{"box.gap", {{"from", 1}, {"to", 2}, {"n", 3}, {"scale", "cubic"}}}}}}));
  wrong.push_back(sweep({{"grid", {{"box.gap", {1, "1:2"}}}}}));
  for (const Field& field : fields()) {
    if (field.form == Form::kBlock) continue;
    for (const char* part : {"grid", "zip"}) {
      right.push_back(sweep({{part, {{field.path, allowed(field)}}}}));
      if (!is_number(field)) continue;
      const double usual =
          std::holds_alternative<double>(field.fallback) ? std::get<double>(field.fallback) : field.low;
      for (const Json& range : ranges(usual, std::clamp(usual + 1, field.low, field.high)))
        right.push_back(sweep({{part, {{field.path, range}}}}));
    }
    for (const Json& value : allowed(field)) right.push_back(sweep({{"list", Json::array({{{field.path, value}}})}}));
  }
  expect_agreement(true, true, right);
  expect_agreement(true, false, wrong);
}

// What does not vary with the scenes that are drawn.
TEST(Schema, AgreesOnWhatASweepAsksOfItsExecutor) {
  const auto with = [](const char* key, Json value) {
    return Json{{"scene", Json::object()}, {key, std::move(value)}};
  };
  std::vector<Json> documents{with("executor", "slurm"), with("executor", "local"), with("slurm", Json::object()),
                              with("executor", "cloud"), with("executor", 1),       with("slurm", 3)};
  for (const Json& keys : std::vector<Json>{{{"partition", "a_b,c-1"}},
                                            {{"partition", nullptr}},
                                            {{"partition", "-a"}},
                                            {{"partition", "a b"}},
                                            {{"account", ""}},
                                            {{"time", "2 h"}},
                                            {{"time", true}},
                                            {{"memory", "4G"}},
                                            {{"memory", "4 GB"}},
                                            {{"memory", "0G"}},
                                            {{"runs_per_task", 7}},
                                            {{"runs_per_task", 0}},
                                            {{"runs_per_task", 1.5}},
                                            {{"options", {"--qos=low"}}},
                                            {{"options", {"-q"}}},
                                            {{"options", "--qos"}},
                                            {{"cores", 3}}}) {
    documents.push_back(with("slurm", keys));
  }
  const std::vector<std::string> said = verdicts(sweep_schema(), documents);
  for (std::size_t i = 0; i < documents.size(); ++i) {
    EXPECT_EQ(said[i] == "ok", accepted(true, documents[i])) << documents[i].dump() << "\n" << said[i];
  }
}

// Whatever is written: what the loader accepts, the schema does.
TEST(Schema, AcceptsWhateverTheLoaderAccepts) {
  std::mt19937_64 random(20240804);
  std::array<std::vector<Json>, 2> documents;
  for (int i = 0; i < test::draws(30000); ++i) {
    const bool as_sweep = i % 2 == 1;
    const std::string text = mutated(!as_sweep ? kScene : i % 4 == 1 ? kSweep : kSweeps, random);
    const bool fine = as_sweep ? static_cast<bool>(load_sweep(text, "f")) : static_cast<bool>(load_scene(text, "f"));
    if (fine) documents[as_sweep ? 1 : 0].push_back(Json::parse(text, nullptr, true, true));
  }
  for (const bool as_sweep : {false, true}) {
    const std::vector<Json>& kind = documents[as_sweep ? 1 : 0];
    EXPECT_GE(static_cast<int>(kind.size()), test::draws(80));
    const std::vector<std::string> said = verdicts(as_sweep ? sweep_schema() : scene_schema(), kind);
    for (std::size_t i = 0; i < kind.size(); ++i) EXPECT_EQ(said[i], "ok") << kind[i].dump();
  }
}

TEST(Schema, AcceptsTheFilesThatAreShipped) {
  std::vector<Json> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SHAKEN_SOURCE_DIR "/configs")) {
    if (entry.path().extension() == ".json") files.push_back(Json::parse(read_text(entry.path()), nullptr, true, true));
  }
  ASSERT_GE(files.size(), 5u);
  for (const std::string& said : verdicts(sweep_schema(), files)) EXPECT_EQ(said, "ok");
}

TEST(Schema, SaysOfEachKeyWhatTheReferenceSays) {
  const Json scene = scene_schema();
  const Json& length = scene.at("$defs").at("rods.length");
  EXPECT_EQ(length.at("description"), "Length from tip to tip. Allowed: [0.05, 50] mm. Default: 4.5 mm.");
  EXPECT_EQ(length.at("default"), 4.5);
  EXPECT_EQ(length.at("minimum"), 0.05);
  EXPECT_EQ(length.at("maximum"), 50);
  EXPECT_EQ(scene.at("properties").at("rods").at("properties").at("length").at("$ref"), "#/$defs/rods.length");
  EXPECT_EQ(scene.at("$defs").at("rods.start").at("enum"),
            Json::array({"aligned", "random", "compressed", "polydomain", "defect_pair", nullptr}));
  for (const Field& field : fields()) {
    EXPECT_EQ(scene.at("$defs").contains(field.path), field.form != Form::kBlock) << field.path;
  }
}

TEST(Schema, IsNamedInAFileAndMeansNothingThere) {
  EXPECT_EQ(run_id(plan_of(R"({"$schema": "any text", "box": {"gap": 1.3}})")),
            run_id(plan_of(R"({"box": {"gap": 1.3}})")));
  EXPECT_TRUE(load_sweep(R"({"$schema": "x", "scene": {"$schema": "y"}, "sweep": {"replicas": 2}})", "f"));
  EXPECT_EQ(problem_of(R"({"$schema": 3})"), "run.json:1:13: /$schema: expected a text, not the number 3");
  EXPECT_EQ(problem_of(R"({"box": {"$schema": "x"}})"), "run.json:1:10: /box/$schema: unknown key");
}

}  // namespace
}  // namespace shaken::scene
