#include <fmt/format.h>

#include <cmath>

#include "base/keys/units.h"
#include "base/table.h"
#include "base/text.h"
#include "client/cost_estimate.h"
#include "client/scene_input.h"
#include "client/slurm_estimate.h"
#include "client/verbs/verbs.h"
#include "scene/keys/accuracy_levels.h"
#include "scene/keys/derived.h"
#include "scene/keys/observables.h"

namespace shaken::client {
namespace {

using Align = Table::Align;
using keys::Dimension;

std::string percent(const Json& share) { return fmt::format("{:.1f}", 100 * share.get<double>()); }

class Explain : public Verb {
 public:
  VerbInfo info() const override {
    return {"explain", kPrepareGroup, "What a scene calls for, and what it would cost on this machine",
            "  shaken explain scene.json                   effects on and off, CPU time and disk at each accuracy\n"
            "  shaken explain scene.json -s movie=null     what it would cost without\n"
            "  shaken explain sweep.json                   the sum over a sweep, from the point in its middle\n"
            "  shaken explain scene.json --cpu 10          a longer probe, closer to the steady state\n"
            "  shaken explain scene.json --from runs/first   the state of a run of the same system\n"
            "  shaken explain sweep.json --executor slurm --cores 200    core-hours and wall time there\n"
            "  shaken explain scene.json --no-probe        only what is on and off, and why"};
  }

  void declare(Arguments& arguments) override {
    arguments.required("SCENE", file_, "A scene or sweep file; - reads stdin", Names::kFile);
    arguments.repeatable("-s,--set", settings_, "PATH=VALUE", "Change or sweep one value; repeatable");
    arguments.option("--replicas", replicas_, "N", "Runs of each point, each with a seed of its own");
    arguments.flag("--no-probe", no_probe_, "Step nothing: leaves out all that has to be measured");
    arguments.option(
        "--cpu", cpu_, "S",
        "CPU time for the steps of the probe, at most; 1 if not given, and never more than a tenth of the run's");
    arguments.option("--from", from_, "DIR", "Probe from the saved state of this run, of the same system and step",
                     Names::kFolder);
    arguments.option("--executor", executor_, "local|slurm", "Where it is to run; as the sweep says if not given");
    arguments.option("--cores", cores_, "N", "Cores that Slurm gives at once; one for each task if not given");
    arguments.option("--max-pending", max_pending_, "N", "The daemon's limit on tasks that wait; 100 if not given");
    arguments.option("--runs-per-task", runs_per_task_, "N",
                     "The daemon's, where the sweep does not say; 1 if not given");
    arguments.flag("--json", json_, "Print JSON");
  }

  ExitCode run(const Context& context) override {
    check_options();
    const scene::Sweep sweep = load_points(read_scene_input(file_), settings_, replicas_);
    Console& console = context.console;
    const double cpu = no_probe_ ? 0 : cpu_.value_or(EstimateOptions{}.cpu);
    const CostEstimate estimate = estimate_cost(sweep, {.cpu = cpu, .from = from_});
    const scene::SweepPoint& point = sweep.points[estimate.shown];
    const auto in_slurm = slurm_load(sweep, estimate);
    if (json_) {
      Json json = estimate_json(estimate);
      json["name"] = sweep.name;
      json["shown"] = {{"label", point.label}, {"parameters", point.parameters}};
      json["shown"].update(derived_quantities(point));
      json.update(estimate.report);
      if (in_slurm) json["slurm"] = slurm_estimate_json(*in_slurm, estimate_in_slurm(*in_slurm));
      console.out << json_text(json);
      return ExitCode::kOk;
    }
    show_scene(sweep, point, console);
    console.out << fmt::format("The measurements take about {} of memory at their peak.\n\n",
                               bytes_text(scene::peak_of(scene::measure_memory(point.plan))));
    show_effects(estimate.report, console);
    if (no_probe_) return ExitCode::kOk;
    show_probe(estimate.report, console);
    console.out << "\nOn this machine, on one core:\n" << estimate_text(estimate, console.width);
    show_room(estimate.report, sweep.points.size() > 1, console);
    if (in_slurm) console.out << "\n" << slurm_estimate_text(*in_slurm, estimate_in_slurm(*in_slurm));
    return ExitCode::kOk;
  }

 private:
  void check_options() const {
    is_slurm(executor_);  // throws where it is no executor's name
    std::string problems;
    const auto add_problem = [&](const char* problem) {
      problems.append(problems.empty() ? "" : "\n").append(problem);
    };
    if (cpu_ && !(*cpu_ > 0 && *cpu_ <= 3600)) add_problem("--cpu must be more than 0 and at most 3600 seconds");
    if (no_probe_ && cpu_) add_problem("--cpu has no meaning with --no-probe");
    for (const auto& [name, value] :
         {std::pair{"--cores", cores_}, {"--max-pending", max_pending_}, {"--runs-per-task", runs_per_task_}}) {
      if (value && *value < 1) add_problem(fmt::format("{} must be at least 1", name).c_str());
    }
    if (no_probe_ && !from_.empty()) add_problem("--from has no meaning with --no-probe");
    if (!problems.empty()) throw Failure(ExitCode::kBadInput, problems);
  }

  /// What goes to Slurm, if it does and its cost is known.
  std::optional<SlurmLoad> slurm_load(const scene::Sweep& sweep, const CostEstimate& estimate) const {
    if (!is_slurm(executor_.empty() ? sweep.executor : executor_)) return std::nullopt;
    if (estimate.runs.empty()) return std::nullopt;
    SlurmLoad load{.cores = cores_.value_or(0)};
    for (const PointCost& run : estimate.runs) load.runs.push_back(run.cpu());
    load.runs_per_task = sweep.slurm.runs_per_task > 0 ? sweep.slurm.runs_per_task : runs_per_task_.value_or(1);
    load.max_pending = max_pending_.value_or(load.max_pending);
    load.time_limit = sweep.slurm.time;
    return load;
  }

  static void show_scene(const scene::Sweep& sweep, const scene::SweepPoint& point, Console& console) {
    const System& s = point.plan.system;
    const auto length = [](double value) { return keys::format_quantity(value, Dimension::kLength); };
    std::string text = console.painted(Colour::kBold, sweep.name);
    if (sweep.points.size() > 1) {
      text += fmt::format(": {} runs; shown is {}", sweep.points.size(), point.label);
    }
    const auto gamma = scene::gamma_of(s);
    const double total = point.plan.longest_time();
    const auto differ = [](double spread) {
      return spread > 0 ? fmt::format(" (+- {:.4g} %)", 100 * spread) : std::string();
    };
    const auto rods = [&](const RodShape& rod, int count) {
      const std::string longer = differ(rod.spread.length), wider = differ(rod.spread.end_diameter);
      std::string shape = fmt::format("{} of {}{}, ", count, length(rod.length), longer);
      if (rod.n_beads == 1) {
        shape = fmt::format("{} spheres of {}{}", count, length(rod.mid_diameter), longer);
      } else if (!rod.bead_diameters.empty()) {
        shape += fmt::format("{} beads of given diameters", rod.n_beads);
      } else if (rod.profile == Profile::kPolar) {
        shape += fmt::format("{} thick at the tail, {}{} at the head ({} beads)", length(rod.mid_diameter),
                             length(rod.end_diameter), wider, rod.n_beads);
      } else {
        shape += fmt::format("{} thick, {}{} at the ends ({} beads)", length(rod.mid_diameter),
                             length(rod.end_diameter), wider, rod.n_beads);
      }
      return fmt::format("{}; area fraction {}\n", shape, number_text(scene::area_fraction_of(s, rod, count)));
    };
    text += "\n  rods    " + rods(s.rod, s.n_rods);
    for (const auto& added : s.added) {
      if (added) text += "          " + rods(added->rod, added->count);
    }
    if (s.walls) {
      std::string size = length(s.walls->size), more;
      if (s.walls->arena == Arena::kAnnulus) more = fmt::format(", {} inside", length(s.walls->inner));
      if (s.walls->arena == Arena::kStadium) more = fmt::format(", {} between its round ends", length(s.walls->length));
      if (s.walls->arena == Arena::kEllipse) size = fmt::format("{} by {}", length(s.walls->length), size);
      if (s.walls->arena == Arena::kWedge)
        more = fmt::format(" to {} over {}", length(s.walls->narrow), length(s.walls->length));
      if (s.walls->arena == Arena::kChannel) more = fmt::format(", periodic after {}", length(s.box_side));
      text += fmt::format("  arena   {} of {}{} between side walls; plates {} apart\n", name_of(s.walls->arena), size,
                          more, length(s.gap));
    } else {
      text += fmt::format(
          "  box     {}, periodic; plates {} apart\n",
          s.box_aspect == 1 ? length(s.box_side) + " square" : length(s.box().x()) + " by " + length(s.box().y()),
          length(s.gap));
    }
    text += fmt::format("  plates  {}a = {} mm, f = {}; gravity {}\n",
                        gamma ? fmt::format("Gamma = {}, ", number_text(*gamma)) : "", number_text(s.amplitude),
                        keys::format_quantity(s.frequency, Dimension::kFrequency),
                        keys::format_quantity(s.gravity, Dimension::kAcceleration));
    if (s.has_second_vibration()) {
      text += fmt::format("          with a second vibration of {} at {}\n", length(s.second->amplitude),
                          keys::format_quantity(s.second->frequency, Dimension::kFrequency));
    }
    if (s.has_lid_motion()) {
      text += s.lid_motion->amplitude > 0
                  ? fmt::format("          under a lid that vibrates by {}, {} degrees ahead of the base\n",
                                length(s.lid_motion->amplitude), number_text(s.lid_motion->phase))
                  : std::string("          under a lid at rest\n");
    }
    if (s.has_inclination()) text += fmt::format("          inclined by {} degrees\n", number_text(s.inclination));
    const scene::AccuracyLevel* known = scene::accuracy_level(s);
    const std::string level = known ? fmt::format(" (\"{}\")", known->name) : "";
    text += fmt::format("  time    {}{} in {} steps of {}{}; steady state {}\n",
                        keys::format_quantity(total, Dimension::kTime), point.plan.until ? " at most" : "",
                        number_text(std::round(total / s.dt)), keys::format_quantity(s.dt, Dimension::kTime), level,
                        point.plan.steady ? "from " + keys::format_quantity(*point.plan.steady, Dimension::kTime)
                                          : std::string("found from S(t)"));
    console.out << text << "\n";
  }

  static void show_effects(const Json& report, Console& console) {
    const bool probed = report.contains("probe");
    std::vector<Table::Column> columns{{"EFFECT"}, {""}, {"BECAUSE"}};
    if (probed) columns.insert(columns.begin() + 2, {"CPU %", Align::kRight});
    Table table(columns);
    for (const Json& effect : report.at("effects")) {
      std::vector<std::string> row{effect.at("name").get<std::string>(), effect.at("on").get<bool>()
                                                                             ? console.painted(Colour::kGreen, "on")
                                                                             : console.painted(Colour::kDim, "off")};
      if (probed) row.push_back(effect.contains("cpu_share") ? percent(effect.at("cpu_share")) : "");
      row.push_back(effect.at("why").get<std::string>());
      table.add_row(std::move(row));
    }
    console.out << table.text(console.width);
  }

  /// What the disk must have room for beyond what stays on it.
  static void show_room(const Json& report, bool several, Console& console) {
    const Json& disk = report.at("disk_bytes");
    const double most = disk.at("most").get<double>(), total = disk.at("total").get<double>();
    if (most <= total) return;
    console.out << fmt::format(
        "\nAt its end {} run needs room for trajectory.part and trajectory.h5 together: {} on the disk, of which {}\n"
        "stay.{}\n",
        several ? "the shown" : "the", bytes_text(most), bytes_text(total),
        several ? " So does every other that is running." : "");
  }

  void show_probe(const Json& report, Console& console) const {
    console.out << fmt::format(
        "\nShares are of the CPU time of the whole run, {}. The rest of that time: {} % for stepping, which is all of\n"
        "the physics, {} % for checkpoints. What one effect of the physics costs, only a run without it tells:\n"
        "`shaken bench effects`.\n",
        cpu_text(report.at("cpu_seconds").get<double>()), percent(report.at("stepping_cpu_share")),
        percent(report.at("checkpoints_cpu_share")));
    const Json& probe = report.at("probe");
    console.out << fmt::format(
        "\nProbe: {} s of the run stepped in {} CPU-seconds, {} rod-seconds per CPU-second, {}.\n",
        number_text(probe.at("simulated_s").get<double>()), number_text(probe.at("cpu_s").get<double>()),
        number_text(probe.at("rod_seconds_per_cpu_second").get<double>()),
        from_.empty() ? fmt::format("after {} s from the rods' start,\nfrom where it may be long to the "
                                    "steady state (--cpu 10 goes further, --from DIR begins there)",
                                    number_text(probe.at("warm_up_s").get<double>()))
                      : "from the state in " + from_);
  }

  std::string file_;
  std::vector<std::string> settings_;
  std::optional<int> replicas_;
  std::optional<double> cpu_;
  std::string from_;
  std::string executor_;
  std::optional<int> cores_, max_pending_, runs_per_task_;
  bool no_probe_ = false;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_explain() { return std::make_unique<Explain>(); }

}  // namespace shaken::client
