#include <fmt/format.h>

#include <map>

#include "base/table.h"
#include "base/text.h"
#include "client/live/target.h"
#include "client/scene_input.h"
#include "client/verbs/verbs.h"
#include "scene/canonical.h"
#include "scene/placement.h"

namespace shaken::client {
namespace {

using Align = Table::Align;

class Validate : public Verb {
 public:
  VerbInfo info() const override {
    return {"validate", kPrepareGroup, "Check a scene or sweep file and show what follows from it",
            "  shaken validate scene.json\n"
            "  shaken validate sweep.json -s rods.length=2.5,3.5,4.5 --replicas 3\n"
            "  shaken validate scene.json --resolved     every value, defaults filled in\n"
            "  shaken validate scene.json --json         problems, or what follows, for programs\n"
            "\nMEMORY is that of the measurements at their peak; more than the machine has is refused.\n"
            "The rods are placed, to see whether they fit. A remark is of what is allowed but hardly meant; the exit "
            "code is 0 all the same."};
  }

  void declare(Arguments& arguments) override {
    arguments.required("FILE", file_, "A scene or sweep file; - reads stdin", Names::kFile);
    arguments.repeatable("-s,--set", settings_, "PATH=VALUE", "Change or sweep one value; repeatable");
    arguments.option("--replicas", replicas_, "N", "Runs of each point, each with a seed of its own");
    arguments.flag("--resolved", resolved_, "Print the resolved scenes as JSON");
    arguments.flag("--json", json_, "Print problems or derived quantities as JSON");
  }

  ExitCode run(const Context& context) override {
    const SceneInput input = read_scene_input(file_);
    Console& console = context.console;
    const auto loaded = scene::load_runs(input.text, input.file, settings_, replicas_);
    if (!loaded) {
      if (!json_) throw Failure(ExitCode::kBadInput, refusal_text(loaded.error()));
      print_problems(loaded.error(), console);
      return ExitCode::kBadInput;
    }
    const std::vector<scene::SweepPoint>& points = loaded->points;
    if (resolved_) {
      print_resolved(points, console);
    } else if (json_) {
      print_json(points, console);
    } else {
      print_summary(points, console);
    }
    return ExitCode::kOk;
  }

 private:
  static void print_problems(const std::vector<keys::Problem>& problems, Console& console) {
    console.out << json_text(Json{{"ok", false}, {"problems", keys::to_json(problems)}});
  }

  static void print_resolved(const std::vector<scene::SweepPoint>& points, Console& console) {
    if (points.size() == 1) {
      console.out << json_text(scene::to_json(points.front().plan));
      return;
    }
    Json list = Json::array();
    for (const scene::SweepPoint& point : points) list.push_back(scene::to_json(point.plan));
    console.out << json_text(list);
  }

  static void print_json(const std::vector<scene::SweepPoint>& points, Console& console) {
    Json list = Json::array();
    for (const scene::SweepPoint& point : points) {
      Json entry{{"label", point.label}, {"parameters", point.parameters}, {"replica", point.replica}};
      entry.update(derived_quantities(point));
      list.push_back(std::move(entry));
    }
    console.out << json_text(Json{{"ok", true}, {"problems", Json::array()}, {"points", list}});
  }

  void print_summary(const std::vector<scene::SweepPoint>& points, Console& console) const {
    console.out << fmt::format("{} {}: {}\n", file_ == "-" ? "stdin" : file_,
                               console.painted(Colour::kGreen, "is fine"),
                               points.size() == 1 ? "one run" : fmt::format("{} runs", points.size()));
    Table table({{"RUN"},
                 {"RODS", Align::kRight},
                 {"AREA FRACTION", Align::kRight},
                 {"GAMMA", Align::kRight},
                 {"AMPLITUDE mm", Align::kRight},
                 {"SIM s", Align::kRight},
                 {"TICKS", Align::kRight},
                 {"FRAMES", Align::kRight},
                 {"MEMORY", Align::kRight},
                 {"POINT"}});
    std::map<std::string, std::size_t> remarks;
    for (const scene::SweepPoint& point : points) {
      const Json derived = derived_quantities(point);
      const auto number = [&derived](const char* key) {
        return derived.at(key).is_null() ? "-" : number_text(derived.at(key).get<double>());
      };
      table.add_row({short_id(derived.at("id").get<std::string>()), of_species(derived, "n_rods", "count"),
                     of_species(derived, "area_fraction", "area_fraction"), number("gamma"), number("amplitude_mm"),
                     number("sim_seconds"), number("ticks"), number("trajectory_frames"),
                     bytes_text(derived.at("measurement_memory_bytes").get<double>()), point.label});
      for (const Json& remark : derived.at("remarks")) ++remarks[remark.get<std::string>()];
    }
    console.out << table.text(console.width);
    for (const auto& [remark, count] : remarks) {
      console.out << fmt::format("{}: {}{}\n", console.painted(Colour::kYellow, "remark"), remark,
                                 points.size() == 1 ? "" : fmt::format(" (in {} of {} runs)", count, points.size()));
    }
  }

  /// "0.7" of one species; "0.7 = 0.5 + 0.2" of several.
  static std::string of_species(const Json& derived, const char* total, const char* of_each) {
    std::string text = number_text(derived.at(total).get<double>());
    const Json& species = derived.at("species");
    if (species.size() == 1) return text;
    for (const Json& one : species) {
      text += (&one == &species.front() ? " = " : " + ") + number_text(one.at(of_each).get<double>());
    }
    return text;
  }

  std::string file_;
  std::vector<std::string> settings_;
  std::optional<int> replicas_;
  bool resolved_ = false;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_validate() { return std::make_unique<Validate>(); }

}  // namespace shaken::client
