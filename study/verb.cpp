// SPDX-License-Identifier: MIT
#include "study/verb.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "base/files.h"
#include "base/interrupt.h"
#include "base/process.h"
#include "base/slurm_conf.h"
#include "base/table.h"
#include "base/text.h"
#include "client/verbs/verbs.h"
#include "study/claims.h"
#include "study/computing_plan.h"
#include "study/cost.h"
#include "study/destination.h"
#include "study/drawing.h"
#include "study/report.h"
#include "study/scheduling.h"
#include "study/selection.h"

namespace shaken::study {
namespace {

namespace fs = std::filesystem;

class Figures : public client::Verb {
 public:
  client::VerbInfo info() const override {
    return {"figures", client::kResultsGroup,
            "The figures of Sharma & Soni (2024), and some beyond: runs, waits, draws",
            "  shaken figures                        everything at laptop scale, into figures-laptop/\n"
            "  shaken figures --list                 what there is, and the runs that each needs\n"
            "  shaken figures 3 8 layer-trends       the phase diagram and the layers; numbers are the paper's\n"
            "  shaken figures --scale tiny           seconds: to see that all is there\n"
            "  shaken figures --scale paper --dry-run --cores 8   what the paper's sizes would cost on eight cores\n"
            "  shaken --root /shared/me figures --scale paper --executor slurm --partition long --time 24h\n"
            "                                        everything at the paper's size, in Slurm (docs/cluster.md)\n"
            "  shaken figures --scale paper --executor slurm --cores 64 --plan plan.md\n"
            "                                        only a plan for a computing centre, and the sweeps beside it\n"
            "  shaken figures --draw-only            from the runs that are done, while others go on\n"
            "Stop it at any time: the same command goes on where it stopped. `shaken watch` and `shaken status` work\n"
            "meanwhile. What it will cost is told before it starts, and asked on a terminal. Beside each PNG lie its "
            "data (.dat) and the script that draws it again (.gp)."};
  }

  void declare(client::Arguments& arguments) override {
    arguments.list("FIGURE", ids_, "A number of the paper, 2 to 14, or a name of --list; all if left out",
                   figure_words());
    arguments.option("--scale", scale_, "tiny|laptop|paper", "Size of the runs; laptop if left out");
    arguments.option("-o,--out", out_, "DIR", "Where to draw; figures-SCALE if left out", client::Names::kFolder);
    arguments.option("--configs", configs_, "DIR", "Folder that holds figures/SCALE/*.json", client::Names::kFolder);
    arguments.flag("--list", list_, "List the figures and the sweeps they need, and do nothing");
    arguments.flag("--dry-run", dry_run_, "Check the sweeps, say what they would cost, and start nothing");
    arguments.option("--cores", cores_, "N",
                     "Cores that costs are told for; those of this machine, in Slurm one for each task if left out");
    arguments.option("--plan", plan_, "FILE",
                     "Start nothing: write what a computing centre wants to know (Markdown), and the sweeps beside it",
                     client::Names::kFile);
    destination_.declare(arguments);
    arguments.flag("-y,--yes", yes_, "Start without asking, also on a terminal");
    arguments.flag("--draw-only", draw_only_, "Queue nothing: draw from the runs that are done");
    arguments.option("--report", report_, "FILE",
                     "Put claims, costs and versions between the marks in this Markdown file, as in docs/validation.md",
                     client::Names::kFile);
    arguments.flag("--json", json_, "Print what was made as JSON");
  }

  ExitCode run(const client::Context& context) override {
    client::Console& console = context.console;
    choose();
    if (list_) return show_list(console);
    load(selection_, sweeps_folder(configs_, scale_));
    destination_.redirect(selection_);
    if (dry_run_ || !plan_.empty()) {
      tell_cost(console);
      return ExitCode::kOk;
    }
    if (out_.empty()) out_ = "figures-" + scale_;

    const fs::path root = context.root(), runs_folder = root / "runs";
    const InterruptGuard guard;
    prepare();
    FigureMaker maker(selection_, runs_folder, out_, json_, console);
    bool complete = true;
    if (draw_only_) {
      for (const PaperFigure* figure : selection_.figures) {
        if (!guard.interrupted()) complete &= maker.draw(*figure);
      }
      if (!guard.interrupted()) conclude(runs_folder, maker.made(), console);
    } else {
      if (!is_agreed_to(selection_, runs_folder, cores_.value_or(0), yes_, console)) {
        console.err << "nothing was started\n";
        return ExitCode::kFailed;
      }
      Schedule schedule(selection_, root, console);
      schedule.submit();
      complete = schedule.wait(guard, [&](const PaperFigure& figure) { return maker.draw(figure); });
      if (!guard.interrupted()) conclude(runs_folder, maker.made(), console);
      schedule.let_others_finish(guard);
    }
    if (guard.interrupted()) {
      console.err << (in_slurm() ? "interrupted: what Slurm has goes on, the same command follows it from here\n"
                                 : "interrupted: the same command goes on from here\n");
      return ExitCode::kInterrupted;
    }
    return complete ? ExitCode::kOk : ExitCode::kFailed;
  }

 private:
  /// The figures asked for. Throws Failure with all that is wrong with the options.
  void choose() {
    static constexpr std::string_view kScales[] = {"tiny", "laptop", "paper"};
    std::string problems;
    if (std::find(std::begin(kScales), std::end(kScales), scale_) == std::end(kScales)) {
      problems += fmt::format("--scale takes tiny, laptop or paper, not '{}'\n", scale_);
    }
    problems += destination_.problems();
    if (cores_ && *cores_ < 1) problems += "--cores must be at least 1\n";
    if (!plan_.empty() && !destination_.is_slurm()) problems += "--plan is for Slurm: add --executor slurm\n";
    if (!plan_.empty() && draw_only_) problems += "--draw-only and --plan exclude each other\n";
    if (draw_only_ && dry_run_) problems += "--draw-only and --dry-run exclude each other\n";
    selection_ = selected(ids_, problems);
    if (problems.empty()) return;
    std::string names;
    for (const std::string& id : figure_words()) names += " " + id;
    throw Failure(ExitCode::kBadInput, problems + "figures:" + names);
  }

  bool in_slurm() const {
    return std::any_of(selection_.sweeps.begin(), selection_.sweeps.end(),
                       [](const NamedSweep& sweep) { return sweep.needed && sweep.sweep.executor == "slurm"; });
  }

  /// What it would cost, and the plan if one is asked for.
  void tell_cost(client::Console& console) const {
    const StudyCost cost = probed_cost(selection_.sweeps, {.levels = false}, cores_.value_or(0), console);
    if (!plan_.empty()) write_computing_plan(selection_, cost, drawing_command(), plan_);
    Json json = json_ ? cost_json(cost, scale_) : Json();
    if (!plan_.empty()) json["plan"] = {{"file", plan_}, {"sweeps", sweeps_beside(plan_).string()}};
    if (json_) {
      console.out << client::json_text(json);
      return;
    }
    console.out << cost_text(cost, console.width);
    if (!plan_.empty()) console.out << plan_ << "\n" << sweeps_beside(plan_).string() << "\n";
  }

  /// What draws these figures once the runs are done.
  std::string drawing_command() const {
    std::string command = "shaken --root ROOT figures";
    for (const std::string& id : ids_) command += " " + id;
    command += " --scale " + scale_;
    if (!configs_.empty()) command += fmt::format(" --configs {}", fs::absolute(configs_).lexically_normal().string());
    return command + " --draw-only";
  }

  /// What would otherwise fail only after hours.
  void prepare() const {
    std::string problems;
    if (run_captured({"gnuplot", "--version"}).exit_code != 0) {
      problems += "gnuplot is not here: `apt install gnuplot-nox`\n";
    }
    if (in_slurm() && !draw_only_ && run_captured({"timeout", "5", "sbatch", "--version"}).exit_code != 0) {
      problems +=
          fmt::format("sbatch is not here, or finds no cluster ({}): `shaken doctor --executor slurm` says more\n",
                      printable(slurm_conf_text()));
    }
    std::error_code error;
    fs::create_directories(out_, error);
    const fs::path trial = fs::path(out_) / ".trial";
    if (!error && !write_file_atomically(trial, "")) error = std::make_error_code(std::errc::permission_denied);
    std::error_code ignored;
    fs::remove(trial, ignored);
    if (error) problems += fmt::format("{}: cannot be written to: {}\n", out_, error.message());
    if (!report_.empty()) {
      try {
        with_sections(report_, report_sections({}));
      } catch (const Failure& failure) {
        problems += fmt::format("{}: {}\n", report_, failure.what());
      }
    }
    if (problems.empty()) return;
    problems.pop_back();
    throw Failure(ExitCode::kBadInput, problems);
  }

  ExitCode show_list(client::Console& console) const {
    if (json_) {
      Json list = Json::array();
      for (const PaperFigure* figure : selection_.figures) {
        list.push_back({{"id", figure->id()},
                        {"number", figure->number.empty() ? Json() : Json(figure->number)},
                        {"name", figure->name},
                        {"title", figure->title},
                        {"sweeps", figure->sets}});
      }
      console.out << client::json_text(list);
      return ExitCode::kOk;
    }
    Table table({{"PAPER"}, {"NAME"}, {"SHOWS"}, {"SWEEPS"}});
    for (const PaperFigure* figure : selection_.figures) {
      std::string sets;
      for (const std::string_view set : figure->sets) sets += (sets.empty() ? "" : " ") + std::string(set);
      table.add_row({std::string(figure->number), std::string(figure->name), std::string(figure->title), sets});
    }
    console.out << table.text(console.width) << fmt::format("Sweeps: {}\n", sweeps_folder(configs_, scale_).string());
    return ExitCode::kOk;
  }

  /// The claims that belong to the figures asked for, from all runs at hand.
  void conclude(const fs::path& runs_folder, const Json& made, client::Console& console) const {
    std::vector<std::string> left_out;
    const Library by_sweep = done_runs(selection_, runs_folder, &left_out), runs = for_figures(by_sweep);
    for (const std::string& run : left_out) console.err << printable(run) << "\n";
    std::vector<std::string_view> figures;
    for (const PaperFigure* figure : selection_.figures) figures.push_back(figure->id());
    const std::vector<Claim> claims = claims_of(figures);
    const fs::path table = fs::path(out_) / "claims.md";
    done_or_fail(write_file_atomically(table, claims_table(runs, claims)));
    done_or_fail(write_file_atomically(fs::path(out_) / "claims.json", claims_json(runs, claims).dump(2) + "\n"));
    // a report is of everything, whatever was drawn
    if (!report_.empty()) {
      done_or_fail(write_file_atomically(report_, with_sections(report_, report_sections(by_sweep))));
    }
    if (const std::set<std::string> versions = versions_of(by_sweep, all_sets()); versions.size() > 1) {
      console.err << "runs of several versions together:\n" << origin_text(by_sweep, all_sets());
    }
    if (json_) {
      console.out << client::json_text(Json{{"scale", scale_}, {"made", made}, {"claims", claims_json(runs, claims)}});
    } else {
      console.out << table.string() << "\n";
    }
  }

  std::vector<std::string> ids_;
  std::string scale_ = "laptop";
  std::string out_;
  std::string configs_;
  std::string report_;
  std::string plan_;
  std::optional<int> cores_;
  Destination destination_;
  bool list_ = false, dry_run_ = false, draw_only_ = false, yes_ = false, json_ = false;
  Selection selection_;
};

}  // namespace

std::unique_ptr<client::Verb> make_figures() { return std::make_unique<Figures>(); }

std::vector<std::unique_ptr<client::Verb>> make_all_verbs() {
  auto verbs = client::make_verbs();
  const auto plot = std::find_if(verbs.begin(), verbs.end(),
                                 [](const auto& verb) { return std::string_view(verb->info().name) == "plot"; });
  verbs.insert(plot == verbs.end() ? plot : plot + 1, make_figures());
  return verbs;
}

}  // namespace shaken::study
