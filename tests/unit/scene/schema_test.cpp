// SPDX-License-Identifier: MIT
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

/// Draws documents of which every value by itself is allowed.
class Writer {
 public:
  explicit Writer(std::uint64_t seed) : random_(seed) {}

  int below(std::size_t n) { return static_cast<int>(random_() % n); }
  bool one_in(std::size_t n) { return below(n) == 0; }
  double uniform() { return std::uniform_real_distribution<>(0, 1)(random_); }

  const Field& any_field() { return fields()[static_cast<std::size_t>(below(fields().size()))]; }

  /// What may be written for `field`; often so near to its default that the whole scene is right.
  Json value(const Field& field) {
    if (one_in(20)) return nullptr;
    switch (field.form) {
      case Form::kQuantity:
        return !field.names.empty() && one_in(2) ? Json(field.names.front()) : quantity(field, number(field));
      case Form::kNumbers: {
        Json list = Json::array();
        const double one = number(field);
        for (int k = 0; k < 1 + 2 * below(8); ++k) list.push_back(quantity(field, one));
        return list;
      }
      case Form::kPairs: {
        Json list = Json::array();
        for (int k = 0; k < 1 + below(3); ++k)
          list.push_back({quantity(field, number(field)), quantity(field, number(field))});
        return list;
      }
      case Form::kWhole: {
        const Json whole = static_cast<std::int64_t>(std::clamp(std::round(number(field)), field.low, field.high));
        return one_in(4) ? Json(whole.dump()) : whole;
      }
      case Form::kName:
        return field.names[static_cast<std::size_t>(below(field.names.size()))];
      case Form::kText:
        return "0123456789abcdef";
      case Form::kSize:
        return {64 + 2 * below(1000), 64 + 2 * below(1000)};
      case Form::kSwitch:
        return one_in(2);
      case Form::kTexts:
      case Form::kPair:
      case Form::kElsewhere:
        break;  // none in a scene
      case Form::kBlock:
        return std::array<Json, 4>{Json::object(), true, false, nullptr}[static_cast<std::size_t>(below(4))];
    }
    return nullptr;
  }

  Json scene() {
    Json scene = Json::object();
    if (one_in(4)) scene["$schema"] = "scene.schema.json";
    const int n = below(7);
    for (int k = 0; k < n; ++k) {
      const Field& field = any_field();
      if (Json* place = place_of(scene, field.path)) *place = value(field);
    }
    return scene;
  }

  Json sweep() {
    Json sweep = Json::object();
    if (one_in(4)) sweep["name"] = "a name";
    if (one_in(2)) sweep["scene"] = scene();
    if (one_in(3)) {
      sweep["sweep"] = Json::array({product()});
      if (one_in(2)) sweep["sweep"].push_back(product());
    } else {
      sweep["sweep"] = product();
    }
    return sweep;
  }

 private:
  /// Where the value of `path` stands; null if something that is no object is in the way.
  static Json* place_of(Json& scene, const std::string& path) {
    Json* place = &scene;
    std::stringstream names(path);
    for (std::string name; std::getline(names, name, '.');) {
      if (place->is_null() && place != &scene) *place = Json::object();
      if (!place->is_object()) return nullptr;
      place = &(*place)[name];
    }
    return place;
  }

  double number(const Field& field) {
    const double* usual = std::get_if<double>(&field.fallback);
    if (usual && !one_in(3)) return std::clamp(*usual * (0.95 + 0.1 * uniform()), field.low, field.high);
    if (field.low > 0 && one_in(2))
      return std::clamp(field.low * std::pow(field.high / field.low, uniform()), field.low, field.high);
    return field.low + (field.high - field.low) * uniform();
  }

  Json quantity(const Field& field, double number) {
    // Eight digits, as a person might; where that rounds past a limit, the limit.
    const double written = std::clamp(std::stod(fmt::format("{:.8g}", number)), field.low, field.high);
    if (!one_in(3)) return written;
    const std::vector<Unit> units = units_of(field.dimension);
    if (units.empty() || one_in(3)) return fmt::format("{:g}", written == field.low ? field.low : written);
    const Unit unit = units[static_cast<std::size_t>(below(units.size()))];
    return fmt::format("{:.8g}{}{}", written / unit.scale(), one_in(2) ? " " : "", unit.name);
  }

  Json range(const Field& field) {
    const double from = number(field), to = number(field);
    switch (below(3)) {
      case 0:
        return fmt::format("{:.6g}:{:.6g}:{:.6g}", from, to, to == from ? 1 : (to - from) / 3);
      case 1:
        return {{"from", from}, {"to", fmt::format("{:.6g}", to)}, {"n", 1 + below(3)}};
      default:
        return {{"from", from}, {"to", to}, {"n", 2}, {"scale", one_in(2) ? "log" : "linear"}};
    }
  }

  Json values(const Field& field) {
    if (is_number(field) && one_in(3)) return range(field);
    const bool is_list = field.form == Form::kNumbers || field.form == Form::kPairs;
    if (!is_list && one_in(3)) return value(field);
    Json list = Json::array({value(field)});
    while (one_in(2)) list.push_back(is_number(field) && one_in(4) ? range(field) : value(field));
    return list;
  }

  static bool is_number(const Field& field) { return field.form == Form::kQuantity || field.form == Form::kWhole; }

  Json product() {
    Json product = Json::object();
    const auto some = [&](auto fits, auto write) {
      Json keys = Json::object();
      for (int k = 1 + below(2); k > 0;) {
        const Field& field = any_field();
        if (field.form == Form::kBlock || !fits(field)) continue;
        keys[field.path] = write(field);
        --k;
      }
      return keys;
    };
    const auto any = [](const Field&) { return true; };
    for (const char* part : {"grid", "zip"}) {
      if (one_in(3)) product[part] = some(any, [&](const Field& field) { return values(field); });
    }
    if (one_in(3)) product["list"] = Json::array({some(any, [&](const Field& field) { return value(field); })});
    if (one_in(3)) product["replicas"] = 1 + below(3);
    return product;
  }

  std::mt19937_64 random_;
};

/// Every object of a document with the keys in it.
void find_objects(Json& document, std::vector<Json*>& found) {
  if (document.is_object()) found.push_back(&document);
  if (!document.is_structured()) return;
  for (Json& inner : document) find_objects(inner, found);
}

/// Breaks one thing that a schema can say: an unknown key, a value of a wrong type, a number out of range.
void break_scene(Json& scene, Writer& writer) {
  std::vector<Json*> objects;
  find_objects(scene, objects);
  Json& object = *objects[static_cast<std::size_t>(writer.below(objects.size()))];
  const auto set = [&](const Field& field, const Json& value) {
    Json* place = &scene;
    std::stringstream names(field.path);
    for (std::string name; std::getline(names, name, '.');) {
      if (!place->is_object()) *place = Json::object();
      place = &(*place)[name];
    }
    *place = value;
  };
  switch (writer.below(3)) {
    case 0:
      object["nosuchkey"] = 1;
      return;
    case 1: {
      const Field& field = writer.any_field();
      if (field.form == Form::kBlock) return set(field, 3);
      static const std::array<Json, 3> kWrong{Json::array({Json::object()}), {{"x", 1}}, Json::array({nullptr})};
      return set(field, kWrong[static_cast<std::size_t>(writer.below(3))]);
    }
    default:
      for (;;) {
        const Field& field = writer.any_field();
        const bool too_large = writer.one_in(2);
        const double outside = too_large ? 2 * field.high + 2 : field.low - 1 - std::abs(field.low);
        if (field.form == Form::kNumbers) return set(field, Json::array({outside}));
        if (field.form == Form::kPairs) return set(field, Json::array({Json::array({outside, outside})}));
        if (field.form == Form::kSize) return set(field, Json::array({64, outside}));
        if (field.form != Form::kQuantity && field.form != Form::kWhole) continue;
        return set(field, outside);
      }
  }
}

void break_sweep(Json& sweep, Writer& writer) {
  std::vector<Json*> objects;
  find_objects(sweep, objects);
  Json& object = *objects[static_cast<std::size_t>(writer.below(objects.size()))];
  Json& product = sweep["sweep"].is_array() ? sweep["sweep"].back() : sweep["sweep"];
  switch (writer.below(6)) {
    case 0:
      object["nosuchkey"] = 1;
      return;
    case 1:
      product["grid"] = Json::array({{{"box.gap", 1}}});
      return;
    case 2:
      product["replicas"] = writer.one_in(2) ? Json(0) : Json("3");
      return;
    case 3:
      product["zip"] = {{"box.gap", {{"from", 1}, {"to", 2}, {"n", writer.one_in(2) ? Json(0) : Json(2.5)}}}};
      return;
    case 4:
      product["zip"] = {{"box.gap", {{"from", 1}, {"to", 2}, {"n", 3}, {"scale", "cubic"}}}};
      return;
    default:
      product["grid"] = {{"box.gap", Json::array({1, "1:2"})}};
  }
}

bool accepted(bool as_sweep, const Json& document) {
  const std::string text = document.dump();
  return as_sweep ? static_cast<bool>(load_sweep(text, "f")) : static_cast<bool>(load_scene(text, "f"));
}

/// Draws `n` documents and asks both. Of `broken` ones neither may accept any; of the others the schema accepts every
/// one, and the loader, which knows what contradicts itself, `n_at_least`.
void expect_agreement(bool as_sweep, bool broken, int n, int n_at_least) {
  Writer writer(20240803 + (as_sweep ? 2 : 0) + (broken ? 1 : 0));
  std::vector<Json> documents;
  for (int i = 0; i < n; ++i) {
    Json document = as_sweep ? writer.sweep() : writer.scene();
    if (broken) (as_sweep ? break_sweep : break_scene)(document, writer);
    documents.push_back(std::move(document));
  }
  const std::vector<std::string> said = verdicts(as_sweep ? sweep_schema() : scene_schema(), documents);
  int n_accepted = 0;
  for (std::size_t i = 0; i < documents.size(); ++i) {
    n_accepted += accepted(as_sweep, documents[i]) ? 1 : 0;
    EXPECT_EQ(said[i] == "ok", !broken) << documents[i].dump() << "\n" << said[i];
    if (broken) {
      EXPECT_FALSE(accepted(as_sweep, documents[i])) << documents[i].dump();
    }
  }
  EXPECT_GE(n_accepted, n_at_least);
  testing::Test::RecordProperty("accepted", n_accepted);
}

TEST(Schema, AcceptsEveryAllowedValueOfAScene) { expect_agreement(false, false, test::draws(3000), test::draws(1000)); }
TEST(Schema, AcceptsEveryAllowedValueOfASweep) { expect_agreement(true, false, test::draws(1200), test::draws(200)); }
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

TEST(Schema, RefusesBrokenScenesAsTheLoaderDoes) { expect_agreement(false, true, test::draws(3000), 0); }
TEST(Schema, RefusesBrokenSweepsAsTheLoaderDoes) { expect_agreement(true, true, test::draws(600), 0); }

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
