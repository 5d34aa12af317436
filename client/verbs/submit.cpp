#include <fmt/format.h>

#include <map>

#include "base/table.h"
#include "base/text.h"
#include "client/cost_estimate.h"
#include "client/live/target.h"
#include "client/scene_input.h"
#include "client/verbs/verbs.h"
#include "client/waiting.h"

namespace shaken::client {
namespace {

using Align = Table::Align;

/// Longer tables are left to `shaken status`.
constexpr std::size_t kMostLines = 60;

class Submit : public Verb {
 public:
  VerbInfo info() const override {
    return {"submit", kControlGroup, "Queue a scene or a sweep with the daemon; what was done before is not done again",
            "  shaken submit scene.json\n"
            "  shaken submit scene.json -s rods.length=2.5,3.5,4.5 -s rods.area_fraction=0.55:0.75:0.05\n"
            "  shaken submit sweep.json --replicas 4 --name phases\n"
            "  shaken submit urgent.json --priority 10      starts before all that waits\n"
            "  shaken submit sweep.json --soft-limit 10min --time-limit 2h --at-once 4\n"
            "  shaken submit second.json --after first --stop-if 'failed>10%'\n"
            "  shaken submit sweep.json --dry-run           only checks, shows the points and what they would cost\n"
            "  shaken submit scene.json --wait && shaken results"};
  }

  void declare(Arguments& arguments) override {
    arguments.required("FILE", file_, "A scene or sweep file; - reads stdin", Names::kFile);
    arguments.repeatable("-s,--set", settings_, "PATH=VALUE",
                         "Change one value, or sweep it: VALUE,VALUE or FROM:TO:STEP; repeatable");
    arguments.option("--replicas", replicas_, "N", "Runs of each point, each with a seed of its own");
    arguments.option("--name", name_, "NAME", "Of the sweep; the file's name if left out");
    arguments.option("--priority", priority_, "N", "Jobs of a higher priority start first; 0 if left out");
    arguments.option("--soft-limit", soft_limit_, "TIME",
                     "Wall time of one attempt (10min): then a run gives way to others, and waits behind them");
    arguments.option("--time-limit", time_limit_, "TIME",
                     "Wall time of all attempts together (2h): then a run is stopped as `timed out`");
    arguments.option("--at-once", at_most_, "N", "Jobs of this sweep that may run at once");
    arguments.repeatable("--after", after_, "ID", "Start when this sweep or job is done; repeatable");
    arguments.option("--stop-if", stop_if_, "RULE",
                     "failed>10% of the jobs that ended (five at least), or failed>3: hold those that still wait");
    arguments.flag("--dry-run", dry_run_,
                   "Check everything, show the points and what they would cost, but queue nothing");
    arguments.flag("--no-probe", no_probe_, "With --dry-run: leave out the costs, which have to be measured");
    arguments.flag("--wait", wait_, "Wait until all jobs have ended; exit code 0 only if all are done");
    arguments.flag("--json", json_, "Print the daemon's answer as JSON");
  }

  ExitCode run(const Context& context) override {
    if (no_probe_ && !dry_run_) throw Failure(ExitCode::kBadInput, "--no-probe has a meaning with --dry-run only");
    const SceneInput input = read_scene_input(file_);
    const std::string name = name_.empty() ? scene::sweep_name(input.text, input.file) : name_;
    auto problem = name_.empty() ? std::nullopt : scene::name_problem(name);
    if (!problem) problem = scene::id_problem(name);
    if (problem) {
      throw Failure(ExitCode::kBadInput,
                    fmt::format("{}: {}; choose another one with --name", printable(input.file), printable(*problem)));
    }
    // Read here as the daemon reads it: mistakes are told even without a daemon, and rods can be counted.
    scene::Sweep sweep = load_points(input, settings_, replicas_);
    sweep.name = name;
    Json request{{"text", input.text}, {"file", input.file}, {"settings", settings_}};
    if (replicas_) request["replicas"] = *replicas_;
    if (!name_.empty()) request["name"] = name_;
    if (priority_) request["priority"] = *priority_;
    if (!soft_limit_.empty()) request["soft_limit_s"] = duration_option("--soft-limit", soft_limit_);
    if (!time_limit_.empty()) request["time_limit_s"] = duration_option("--time-limit", time_limit_);
    if (at_most_) request["at_most"] = *at_most_;
    if (!after_.empty()) request["after"] = after_;
    if (!stop_if_.empty()) request["stop_if"] = stop_if_;
    if (dry_run_) {
      request["dry_run"] = true;
      show_dry_run(sweep, why_not_checked(context, request), context.console);
      return ExitCode::kOk;
    }
    ApiClient session(context.root());
    const Json answer = session.post("/v1/sweeps", request);
    if (json_) {
      context.console.out << json_text(answer);
    } else {
      show(answer, sweep, context.console);
    }
    if (!wait_) return ExitCode::kOk;
    context.console.out << std::flush;
    return wait_for(session, {find_target(session, answer.at("sweep").at("id").get<std::string>())}, std::nullopt,
                    context.console);
  }

 private:
  /// What the daemon would refuse, it refuses now. Points and costs need no daemon: why it was not asked; "" if it was.
  static std::string why_not_checked(const Context& context, const Json& request) {
    try {
      ApiClient(context.root()).post("/v1/sweeps", request);
      return "";
    } catch (const Failure& failure) {
      if (failure.code != ExitCode::kNoDaemon) throw;
      return failure.what();
    }
  }

  void show_dry_run(const scene::Sweep& sweep, const std::string& not_checked, Console& console) const {
    Json list = Json::array();
    Table table({{"JOB"}, {"N", Align::kRight}, {"SIM s", Align::kRight}, {"POINT"}});
    for (const scene::SweepPoint& point : sweep.points) {
      const Json derived = derived_quantities(point);
      list.push_back({{"id", derived.at("id")},
                      {"label", point.label},
                      {"parameters", point.parameters},
                      {"replica", point.replica},
                      {"n_rods", derived.at("n_rods")}});
      table.add_row({short_id(derived.at("id").get<std::string>()), std::to_string(point.plan.system.n_all_rods()),
                     number_text(point.plan.total_time()), point.label});
    }
    Json json{{"points", list}};
    if (!not_checked.empty()) json["not_checked"] = not_checked;
    if (!json_ && !not_checked.empty()) {
      console.err << "shaken: whether the daemon would take it is not known: " << not_checked << '\n';
    }
    if (!json_) {
      console.out << fmt::format("{}: {} points, nothing queued\n{}", sweep.name, sweep.points.size(),
                                 table.text(console.width))
                  << std::flush;
    }
    if (!no_probe_) {
      const CostEstimate estimate = estimate_cost(sweep, {});
      json["estimate"] = estimate_json(estimate);
      if (!json_) console.out << "\nOn this machine, on one core:\n" << estimate_text(estimate, console.width);
    }
    if (json_) console.out << json_text(json);
  }

  static void show(const Json& answer, const scene::Sweep& local, Console& console) {
    std::map<std::string, int> n_rods;
    for (const scene::SweepPoint& point : local.points) {
      n_rods[derived_quantities(point).at("id").get<std::string>()] = point.plan.system.n_all_rods();
    }
    const Json& sweep = answer.at("sweep");
    const Json& jobs = answer.at("jobs");
    const Json& counts = answer.at("counts");
    const int n_new = counts.value("new", 0);
    Table table({{"JOB"}, {"STATE"}, {"N", Align::kRight}, {"POINT"}});
    for (const Json& job : jobs) {
      if (&job - &jobs.front() >= static_cast<std::ptrdiff_t>(kMostLines)) break;
      const std::string id = job.at("id").get<std::string>();
      const bool is_new = n_new > 0 && text_of(job, "state") != "done" &&
                          text_of(job, "sweep") == text_of(sweep, "id") &&
                          job.value("created_utime", std::int64_t{0}) >= sweep.value("created_utime", std::int64_t{0});
      const auto n = n_rods.find(id);
      table.add_row({short_id(id), is_new ? console.painted(Colour::kGreen, "new") : text_of(job, "state"),
                     n == n_rods.end() ? "" : std::to_string(n->second), text_of(job, "label")});
    }
    std::string words = fmt::format("{} new", n_new);
    if (const int n = counts.value("found", 0); n > 0) words += fmt::format(", {} found done", n);
    if (const int n = counts.value("requeued", 0); n > 0) words += fmt::format(", {} queued again", n);
    if (const int n = counts.value("extended", 0); n > 0) words += fmt::format(", {} extended", n);
    const auto add_others = [&](JobState state, const char* already, int named) {  // the counts have those named too
      const int n = counts.value(std::string(to_word(state)), 0) - named;
      if (n > 0) words += fmt::format(", {} {}{}", n, already, to_word(state));
    };
    add_others(JobState::kDone, "", counts.value("found", 0));
    add_others(JobState::kRunning, "already ", 0);
    add_others(JobState::kQueued, "already ", n_new + counts.value("requeued", 0) + counts.value("extended", 0));
    console.out << fmt::format("sweep {} ({}): {}: {}\n", console.painted(Colour::kBold, text_of(sweep, "id")),
                               text_of(sweep, "name"), counted(jobs.size(), "point"), words)
                << table.text(console.width);
    if (jobs.size() > kMostLines) {
      console.out << fmt::format("... and {} more: `shaken status {}`\n", jobs.size() - kMostLines,
                                 text_of(sweep, "id"));
    }
  }

  std::string file_;
  std::vector<std::string> settings_;
  std::optional<int> replicas_;
  std::string name_;
  std::optional<int> priority_;
  std::string soft_limit_;
  std::string time_limit_;
  std::optional<int> at_most_;
  std::vector<std::string> after_;
  std::string stop_if_;
  bool dry_run_ = false;
  bool no_probe_ = false;
  bool wait_ = false;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_submit() { return std::make_unique<Submit>(); }

}  // namespace shaken::client
