// SPDX-License-Identifier: MIT
#include "client/paper/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <set>
#include <thread>
#include <utility>

#include "base/files.h"
#include "base/interrupt.h"
#include "base/process.h"
#include "base/progress_line.h"
#include "base/table.h"
#include "base/text.h"
#include "client/estimate.h"
#include "client/own_daemon.h"
#include "client/paper/claims.h"
#include "client/paper/cost.h"
#include "client/scene_input.h"
#include "client/target.h"
#include "client/verbs/verbs.h"
#include "run/files/directory.h"

namespace shaken::client {
namespace {

namespace fs = std::filesystem;
using Align = Table::Align;
using Clock = std::chrono::steady_clock;

/// Between lines of progress where there is no terminal to redraw.
constexpr double kQuiet = 60;  ///< between two lines of progress in a log [s]

/// A daemon that goes away more often than that has a reason.
constexpr int kMostRestarts = 3;

fs::path default_configs() {
  if (const char* given = std::getenv("SHAKEN_CONFIGS"); given != nullptr && *given != '\0') return given;
  if (fs::exists("configs/figures")) return "configs";
  return SHAKEN_CONFIGS_DIR;
}

/// A sweep that figures are drawn from.
struct NamedSweep {
  std::string name;
  SceneInput input;
  scene::Sweep sweep;
  bool needed = false;             ///< for the figures asked for; the claims look at all
  std::optional<Target> target{};  ///< once the daemon knows it
};

double rod_seconds(const scene::Sweep& sweep) {
  double sum = 0;
  for (const scene::SweepPoint& point : sweep.points) sum += point.plan.system.n_all_rods() * point.plan.total_time();
  return sum;
}

class Figures : public Verb {
 public:
  VerbInfo info() const override {
    return {"figures", kResultsGroup, "The figures of Sharma & Soni (2024), and some beyond: runs, waits, draws",
            "  shaken figures                        everything at laptop scale, into figures-laptop/\n"
            "  shaken figures --list                 what there is, and the runs that each needs\n"
            "  shaken figures 2 6 7                  the phase diagram and the layers\n"
            "  shaken figures --scale tiny           seconds: to see that all is there\n"
            "  shaken figures --scale paper --dry-run   what the paper's sizes would cost here\n"
            "  shaken figures --draw-only            from the runs that are done, while others go on\n"
            "Stop it at any time: the same command goes on where it stopped. `shaken watch` and `shaken status` work\n"
            "meanwhile. What it will cost is told before it starts, and asked on a terminal. Beside each PNG lie its "
            "data (.dat) and the script that draws it again (.gp)."};
  }

  void declare(Arguments& arguments) override {
    arguments.list("FIGURE", ids_, "2 to 10, or a name of --list; all if left out", Names::kFigure, 0);
    arguments.option("--scale", scale_, "tiny|laptop|paper", "Size of the runs; laptop if left out");
    arguments.option("-o,--out", out_, "DIR", "Where to draw; figures-SCALE if left out", Names::kFolder);
    arguments.option("--configs", configs_, "DIR", "Folder that holds figures/SCALE/*.json", Names::kFolder);
    arguments.flag("--list", list_, "List the figures and the sweeps they need, and do nothing");
    arguments.flag("--dry-run", dry_run_, "Check the sweeps and say what they would cost on this machine");
    arguments.flag("-y,--yes", yes_, "Start without asking, also on a terminal");
    arguments.flag("--draw-only", draw_only_, "Queue nothing: draw from the runs that are done");
    arguments.option("--report", report_, "FILE",
                     "Put claims, costs and versions between the marks in this Markdown file, as in docs/validation.md",
                     Names::kFile);
    arguments.flag("--json", json_, "Print what was made as JSON");
  }

  ExitCode run(const Context& context) override {
    choose();
    if (list_) return show_list(context.console);
    load();
    if (dry_run_) return show_cost(context.console);
    if (out_.empty()) out_ = "figures-" + scale_;

    runs_folder_ = context.root / "runs";
    const InterruptGuard guard;
    prepare();
    bool complete = true;
    if (draw_only_) {
      for (const PaperFigure* figure : chosen_) {
        if (!guard.interrupted()) complete &= draw_one(*figure, context.console);
      }
    } else {
      if (!is_agreed_to(context)) {
        context.console.err << "nothing was started\n";
        return ExitCode::kFailed;
      }
      begin_ = Clock::now();
      std::optional<OwnDaemon> daemon;
      daemon.emplace(context.root);
      if (daemon->started_here()) {
        context.console.err << fmt::format("shakend started for {}; it stops with this command\n",
                                           context.root.string());
      }
      Session session(context.root);
      submit(session);
      complete = wait_and_draw(session, context.root, daemon, guard, context.console);
      if (!guard.interrupted()) conclude(context.console);
      if (daemon->started_here()) let_others_finish(session, guard, context.console);
    }
    if (guard.interrupted()) {
      context.console.err << "interrupted: the same command goes on from here\n";
      return ExitCode::kInterrupted;
    }
    if (draw_only_) conclude(context.console);
    return complete ? ExitCode::kOk : ExitCode::kFailed;
  }

 private:
  /// The figures asked for, and their sweeps, in the order of all_sets().
  void choose() {
    static constexpr std::string_view kScales[] = {"tiny", "laptop", "paper"};
    std::vector<std::string> problems;
    if (std::find(std::begin(kScales), std::end(kScales), scale_) == std::end(kScales)) {
      problems.push_back(fmt::format("--scale takes tiny, laptop or paper, not '{}'", scale_));
    }
    if (draw_only_ && dry_run_) problems.emplace_back("--draw-only and --dry-run exclude each other");
    for (const std::string& id : ids_) {
      const auto all = paper_figures();
      if (std::none_of(all.begin(), all.end(), [&](const PaperFigure& figure) { return figure.id == id; })) {
        problems.push_back(fmt::format("there is no figure '{}'", id));
      }
    }
    if (!problems.empty()) {
      std::string text;
      for (const std::string& problem : problems) text += problem + "\n";
      std::string names;
      for (const PaperFigure& figure : paper_figures()) names += fmt::format(" {}", figure.id);
      throw Failure(ExitCode::kBadInput, text + "figures:" + names);
    }
    std::set<std::string_view> needed;
    for (const PaperFigure& figure : paper_figures()) {
      if (!ids_.empty() && std::find(ids_.begin(), ids_.end(), figure.id) == ids_.end()) continue;
      chosen_.push_back(&figure);
      needed.insert(figure.sets.begin(), figure.sets.end());
    }
    for (const std::string_view set : all_sets()) {
      sweeps_.push_back({.name = std::string(set), .input = {}, .sweep = {}, .needed = needed.contains(set)});
    }
  }

  fs::path folder() const { return (configs_.empty() ? default_configs() : fs::path(configs_)) / "figures" / scale_; }

  void load() {
    for (NamedSweep& sweep : sweeps_) {
      sweep.input = read_scene_input((folder() / (sweep.name + ".json")).string());
      sweep.sweep = load_points(sweep.input, {}, std::nullopt);
    }
  }

  /// What would otherwise fail only after hours.
  void prepare() const {
    std::string problems;
    if (run_captured({"gnuplot", "--version"}).exit_code != 0) {
      problems += "gnuplot is not here: `apt install gnuplot-nox`\n";
    }
    std::error_code error;
    fs::create_directories(out_, error);
    const fs::path trial = fs::path(out_) / ".trial";
    if (!error && write_file_atomically(trial, "")) error = std::make_error_code(std::errc::permission_denied);
    std::error_code ignored;
    fs::remove(trial, ignored);
    if (error) problems += fmt::format("{}: cannot be written to: {}\n", out_, error.message());
    if (!report_.empty()) {
      try {
        written_report("", "", "", "");
      } catch (const Failure& failure) {
        problems += fmt::format("{}: {}\n", report_, failure.what());
      }
    }
    if (problems.empty()) return;
    problems.pop_back();
    throw Failure(ExitCode::kBadInput, problems);
  }

  /// The report file with these sections in place of those that it has.
  std::string written_report(const std::string& origin, const std::string& claims, const std::string& sweeps,
                             const std::string& figures) const {
    const auto text = read_file(report_);
    if (!text) throw Failure(ExitCode::kBadInput, text.error().message);
    std::string document = *text, problems;
    const std::pair<const char*, const std::string&> sections[] = {
        {"origin", origin}, {"claims", claims}, {"sweeps", sweeps}, {"figures", figures}};
    for (const auto& [name, section] : sections) {
      try {
        document = with_section(document, name, section);
      } catch (const Failure& failure) {
        problems += (problems.empty() ? "" : "\n") + std::string(failure.what());
      }
    }
    if (!problems.empty()) throw Failure(ExitCode::kBadInput, problems);
    return document;
  }

  ExitCode show_list(Console& console) const {
    if (json_) {
      Json list = Json::array();
      for (const PaperFigure* figure : chosen_) {
        list.push_back({{"id", figure->id}, {"title", figure->title}, {"sweeps", figure->sets}});
      }
      console.out << list.dump(2) << "\n";
      return ExitCode::kOk;
    }
    Table table({{"FIGURE"}, {"SHOWS"}, {"SWEEPS"}});
    for (const PaperFigure* figure : chosen_) {
      std::string sets;
      for (const std::string_view set : figure->sets) sets += (sets.empty() ? "" : " ") + std::string(set);
      table.add_row({std::string(figure->id), std::string(figure->title), sets});
    }
    console.out << table.text(console.width) << fmt::format("Sweeps: {}\n", folder().string());
    return ExitCode::kOk;
  }

  ExitCode show_cost(Console& console) const {
    Table table({{"SWEEP"}, {"RUNS", Align::kRight}, {"ROD-SECONDS", Align::kRight}, {"CPU"}, {"DISK"}});
    Json list = Json::array();
    double cpu = 0, disk = 0;
    for (const NamedSweep& sweep : sweeps_) {
      if (!sweep.needed) continue;
      const Estimate estimate = estimate_cost(sweep.sweep, {});
      const LevelCost& cost = estimate.levels.front();  // as written
      cpu += cost.cpu.value_or(0);
      disk += cost.disk.value_or(0);
      table.add_row({sweep.name, std::to_string(sweep.sweep.points.size()), number_text(rod_seconds(sweep.sweep)),
                     cost.cpu ? cpu_text(*cost.cpu) : "?", cost.disk ? bytes_text(*cost.disk) : "?"});
      list.push_back({{"sweep", sweep.name},
                      {"runs", sweep.sweep.points.size()},
                      {"rod_seconds", rod_seconds(sweep.sweep)},
                      {"cpu_seconds", cost.cpu ? Json(*cost.cpu) : Json()},
                      {"disk_bytes", cost.disk ? Json(*cost.disk) : Json()}});
    }
    if (json_) {
      console.out << Json{{"scale", scale_}, {"sweeps", list}, {"cpu_seconds", cpu}, {"disk_bytes", disk}}.dump(2)
                  << "\n";
    } else {
      console.out << table.text(console.width)
                  << fmt::format("together {} and {}: divide by the cores of this machine\n", cpu_text(cpu),
                                 bytes_text(disk));
    }
    return ExitCode::kOk;
  }

  /// Tells what the runs that are not done yet will cost, and asks where there is somebody to ask. Whether to start.
  bool is_agreed_to(const Context& context) const {
    // A glance at each sweep: hours or minutes is the question.
    EstimateOptions glance{.cpu = 0.2, .most_probes = 2, .levels = false};
    Console& console = context.console;
    std::size_t n_runs = 0;
    double cpu = 0, disk = 0;
    for (const NamedSweep& sweep : sweeps_) {
      if (!sweep.needed) continue;
      scene::Sweep rest = sweep.sweep;
      std::erase_if(rest.points, [&](const scene::SweepPoint& point) {
        return is_finished(runs_folder_ / derived_quantities(point).at("id").get<std::string>());
      });
      if (rest.points.empty()) continue;
      if (console.err_is_terminal)
        console.err << fmt::format("\r\x1b[Kwhat will it cost? {}", sweep.name) << std::flush;
      const LevelCost cost = estimate_cost(rest, glance).levels.front();
      n_runs += rest.points.size();
      cpu += cost.cpu.value_or(0);
      disk += cost.disk.value_or(0);
    }
    if (console.err_is_terminal) console.err << "\r\x1b[K" << std::flush;
    if (n_runs == 0) return true;
    const unsigned n_cores = std::max(1U, std::thread::hardware_concurrency());
    console.err << fmt::format("{} runs to be done: about {}, {} on {} cores, and {} in {}\n", n_runs, cpu_text(cpu),
                               duration_text(cpu / n_cores), n_cores, bytes_text(disk), runs_folder_.string());
    return yes_ || console.in == nullptr || console.agrees("Go on?", true);
  }

  void submit(Session& session) {
    for (NamedSweep& sweep : sweeps_) {
      if (!sweep.needed) continue;
      const Json answer = session.post(
          "/v1/sweeps", {{"text", sweep.input.text}, {"file", sweep.input.file}, {"settings", Json::array()}});
      sweep.target = find_target(session, answer.at("sweep").at("id").get<std::string>());
    }
  }

  static bool has_ended(const NamedSweep& sweep) {
    const std::vector<Json> jobs = jobs_of(*sweep.target);
    return std::all_of(jobs.begin(), jobs.end(), [](const Json& job) { return is_final(text_of(job, "state")); });
  }

  bool can_be_drawn(const PaperFigure& figure) const {
    return std::all_of(sweeps_.begin(), sweeps_.end(), [&](const NamedSweep& sweep) {
      const bool needed = std::find(figure.sets.begin(), figure.sets.end(), sweep.name) != figure.sets.end();
      return !needed || has_ended(sweep);
    });
  }

  /// Draws each figure as soon as its runs have ended. False if a run has not come to its end, or a figure could not be
  /// drawn. A daemon that goes away meanwhile is started again.
  bool wait_and_draw(Session& session, const fs::path& root, std::optional<OwnDaemon>& daemon,
                     const InterruptGuard& guard, Console& console) {
    std::vector<const PaperFigure*> left = chosen_;
    bool complete = true;
    int n_restarts = 0;
    ProgressLine progress(console.err, console.err_is_terminal, console.width, kQuiet);
    for (;;) {
      for (auto figure = left.begin(); figure != left.end();) {
        if (guard.interrupted()) return false;
        if (can_be_drawn(**figure)) {
          complete &= draw_one(**figure, console);
          figure = left.erase(figure);
        } else {
          ++figure;
        }
      }
      if (left.empty()) break;
      show_progress(progress);
      guard.sleep_for(std::chrono::milliseconds(500));
      if (guard.interrupted()) {
        return false;
      }
      try {
        for (NamedSweep& sweep : sweeps_) {
          if (sweep.needed && !has_ended(sweep)) refresh(session, *sweep.target);
        }
      } catch (const Failure& failure) {
        if (failure.code != ExitCode::kNoDaemon || ++n_restarts > kMostRestarts) throw;
        console.err << "the daemon has gone; starting one\n";
        daemon.emplace(root);
      }
    }
    for (const NamedSweep& sweep : sweeps_) {
      if (!sweep.needed) continue;
      for (const Json& job : jobs_of(*sweep.target)) {
        if (text_of(job, "state") == "done") continue;
        complete = false;
        console.err << fmt::format("{} {} {}: {} {}\n", sweep.name, short_id(text_of(job, "id")), text_of(job, "label"),
                                   text_of(job, "state"), text_of(job, "reason"));
      }
    }
    return complete;
  }

  /// The daemon goes with this command; jobs that others have queued with it meanwhile come to their end first.
  static void let_others_finish(Session& session, const InterruptGuard& guard, Console& console) {
    bool told = false;
    while (!guard.interrupted()) {
      const Json jobs = session.get("/v1/status").at("jobs");
      const int n = jobs.value("queued", 0) + jobs.value("running", 0) + jobs.value("stopping", 0);
      if (n == 0) return;
      if (!told) {
        console.err << fmt::format(
            "waiting for {} jobs that others have queued here (Ctrl-C: they stop, and can go on)\n", n);
      }
      told = true;
      guard.sleep_for(std::chrono::seconds(2));
    }
  }

  void show_progress(ProgressLine& progress) const {
    double done = 0, all = 0, eta = -1;
    int n_ended = 0, n_jobs = 0;
    for (const NamedSweep& sweep : sweeps_) {
      if (!sweep.needed) continue;
      const std::vector<Json> jobs = jobs_of(*sweep.target);
      // what a run costs goes about with its rods and its time
      for (std::size_t k = 0; k < std::min(jobs.size(), sweep.sweep.points.size()); ++k) {
        const scene::RunPlan& plan = sweep.sweep.points[k].plan;
        const double cost = plan.system.n_all_rods() * plan.total_time();
        const bool ended = is_final(text_of(jobs[k], "state"));
        all += cost;
        done += cost * (ended ? 1.0 : job_fraction(jobs[k]));
        n_ended += ended;
        ++n_jobs;
      }
    }
    const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
    if (first_done_ < 0) first_done_ = done;
    if (elapsed > 5 && done > first_done_) eta = (all - done) * elapsed / (done - first_done_);
    const double fraction = all > 0 ? done / all : 1;
    progress.show(progress_text(fraction, fmt::format("{}/{} runs", n_ended, n_jobs), eta));
  }

  /// The runs of a sweep that are done, in its order.
  RunSet done_runs(const NamedSweep& sweep) const {
    RunSet set;
    for (const scene::SweepPoint& point : sweep.sweep.points) {
      const fs::path directory = runs_folder_ / derived_quantities(point).at("id").get<std::string>();
      if (is_finished(directory)) set.emplace_back(directory, point.parameters);
    }
    return set;
  }

  /// The runs that are there, by sweep.
  Library sweeps() const {
    Library runs;
    for (const NamedSweep& sweep : sweeps_) runs.add(sweep.name, done_runs(sweep));
    return runs;
  }

  /// As figures and claims see them: `transition` holds replicas of points of `phases`.
  Library library() const {
    Library runs = sweeps();
    runs.add("phases", joined(runs["phases"], runs["transition"]));
    return runs;
  }

  /// A picture of the run's last frame in OUT/pictures, drawn once.
  fs::path snapshot(const FinishedRun& run, Console& console) const {
    if (!fs::exists(run::RunDirectory{run.directory()}.trajectory())) return {};
    const fs::path folder = fs::absolute(out_) / "pictures";
    const fs::path picture = folder / (run.directory().filename().string() + ".png");
    if (fs::exists(picture)) return picture;
    fs::create_directories(folder);
    const Captured drawn = run_captured({sibling_program("shaken-render").string(), "picture", run.directory().string(),
                                         "--frame", "last", "--bare", "--size", "640x640", "-o", picture.string()});
    if (drawn.exit_code == 0) return picture;
    console.err << fmt::format("no picture of {}: {}\n", run.directory().string(), drawn.output);
    return {};
  }

  /// False if it could not be drawn, which is told; the others go on.
  bool draw_one(const PaperFigure& figure, Console& console) {
    if (console.err_is_terminal) console.err << "\r\x1b[K" << std::flush;
    try {
      if (figure.draw == nullptr) return collect_films(console);
      const Library runs = library();
      if (std::all_of(figure.sets.begin(), figure.sets.end(),
                      [&](std::string_view set) { return runs[std::string(set)].empty(); })) {
        console.err << fmt::format("figure {}: no run is done yet\n", figure.id);
        return false;
      }
      Sheet sheet = figure.draw({runs, [&](const FinishedRun& run) { return snapshot(run, console); }});
      sheet.name = std::string(figure.file);
      tell(figure.id, draw(sheet, out_), console);
      return true;
    } catch (const std::exception& problem) {
      console.err << fmt::format("figure {}: {}\n", figure.id, problem.what());
      return false;
    }
  }

  /// S1.mp4, S2.mp4, ... in the order of the sweep, and a picture of the end of each.
  bool collect_films(Console& console) {
    const auto movies = std::find_if(sweeps_.begin(), sweeps_.end(), [](const auto& s) { return s.name == "movies"; });
    const fs::path folder = fs::path(out_) / "movies";
    fs::create_directories(folder);
    std::size_t n_films = 0;
    for (std::size_t k = 0; k < movies->sweep.points.size(); ++k) {
      const fs::path directory = runs_folder_ / derived_quantities(movies->sweep.points[k]).at("id").get<std::string>();
      const run::RunDirectory files{directory};
      if (!is_finished(directory) || !fs::exists(files.movie())) continue;
      const std::string name = fmt::format("S{}", k + 1);
      const fs::path film = folder / (name + ".mp4");
      std::error_code error;
      fs::copy_file(files.movie(), film, fs::copy_options::overwrite_existing, error);
      if (error) {
        console.err << fmt::format("{}: {}\n", film.string(), error.message());
        continue;
      }
      if (const fs::path picture = snapshot(FinishedRun(directory), console); !picture.empty()) {
        fs::copy_file(picture, folder / (name + ".png"), fs::copy_options::overwrite_existing, error);
      }
      tell(name, film, console);
      ++n_films;
    }
    if (n_films == 0) console.err << "movies: no run is done yet\n";
    return n_films == movies->sweep.points.size();
  }

  void tell(std::string_view id, const fs::path& file, Console& console) {
    made_.push_back({{"figure", id}, {"file", file.string()}});
    if (!json_) console.out << file.string() << std::endl;
  }

  /// The claims that belong to the figures asked for, from all runs at hand.
  void conclude(Console& console) {
    const Library runs = library();
    std::vector<std::string_view> figures;
    for (const PaperFigure* figure : chosen_) figures.push_back(figure->id);
    const std::vector<Claim> claims = claims_of(figures);
    const std::string table = claims_table(runs, claims);
    const auto save = [](const fs::path& file, const std::string& text) {
      if (const auto error = write_file_atomically(file, text)) throw Failure(ExitCode::kFailed, error->message);
    };
    save(fs::path(out_) / "claims.md", table);
    save(fs::path(out_) / "claims.json", claims_json(runs, claims).dump(2) + "\n");
    if (!report_.empty()) {
      // a report is of everything, whatever was drawn
      save(report_, written_report(origin_text(sweeps(), all_sets()), claims_table(runs, paper_claims()),
                                   sweep_cost_table(sweeps(), all_sets()), figure_cost_table(sweeps())));
    }
    if (json_) {
      console.out << Json{{"scale", scale_}, {"made", made_}, {"claims", claims_json(runs, claims)}}.dump(2) << "\n";
    } else {
      console.out << (fs::path(out_) / "claims.md").string() << "\n";
    }
  }

  std::vector<std::string> ids_;
  std::string scale_ = "laptop";
  std::string out_;
  std::string configs_;
  std::string report_;
  bool list_ = false, dry_run_ = false, draw_only_ = false, yes_ = false, json_ = false;

  fs::path runs_folder_;
  std::vector<const PaperFigure*> chosen_;
  std::vector<NamedSweep> sweeps_;
  Json made_ = Json::array();
  Clock::time_point begin_ = Clock::now();
  mutable double first_done_ = -1;
};

}  // namespace

std::unique_ptr<Verb> make_figures() { return std::make_unique<Figures>(); }

}  // namespace shaken::client
