// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "client/plotting/run_figures.h"
#include "client/result_rows.h"
#include "client/run_location.h"
#include "client/target.h"
#include "client/verbs/verbs.h"
#include "run/files/directory.h"

namespace shaken::client {
namespace {

namespace fs = std::filesystem;

class Plot : public Verb {
 public:
  VerbInfo info() const override {
    return {"plot", kResultsGroup, "Figures of a sweep, a job or a run directory, by gnuplot",
            "  shaken plot                   the newest sweep, into plots-s3/\n"
            "  shaken plot s3 -o figures     S(t), S against the swept parameter, P(theta), tilt, G2, MSD\n"
            "  shaken plot runs/first        what `shaken run` has left there\n"
            "  gnuplot figures/order_time.gp  draws one again, after changing it to taste"};
  }

  void declare(Arguments& arguments) override {
    arguments.optional("ID", id_, "A sweep, a job or a run directory; the newest sweep if left out", Names::kId);
    arguments.option("-o,--out", out_, "DIR", "Where to write; plots-ID if left out", Names::kFolder);
  }

  ExitCode run(const Context& context) override {
    std::vector<PlottedRun> runs;
    std::vector<Figure> figures;
    Console& console = context.console;
    if (!id_.empty() && is_run_directory(id_)) {
      if (out_.empty()) out_ = (fs::path(id_) / "plots").string();
      add_run(id_, "", runs, console);
    } else {
      Session session(context.root);
      const Target target = find_target_or_newest(session, id_);
      const Json& named = target.answer.at(target.is_sweep ? "sweep" : "job");
      if (out_.empty()) out_ = "plots-" + short_id(named.at("id").get<std::string>());
      for (const Json& job : jobs_of(target)) {
        if (text_of(job, "state") == "queued") continue;
        add_run(job.at("directory").get<std::string>(), point_label(job.at("parameters")), runs, console);
      }
      figures = sweep_figures(aggregated(result_rows(session, target)));
    }
    for (Figure& figure : run_figures(runs)) figures.push_back(std::move(figure));
    if (figures.empty()) throw Failure(ExitCode::kFailed, "there is nothing to plot yet");
    for (const Figure& figure : figures) console.out << draw(figure, out_).string() << "\n";
    return ExitCode::kOk;
  }

 private:
  /// A run without readable observables is named and left out; the others are plotted.
  static void add_run(const fs::path& directory, const std::string& point, std::vector<PlottedRun>& runs,
                      Console& console) {
    auto observables = run::read_observables(run::RunDirectory{directory}.observables());
    if (observables) {
      runs.push_back({point, *std::move(observables)});
    } else {
      console.err << fmt::format("left out: {}\n", observables.error().message);
    }
  }

  std::string id_;
  std::string out_;
};

}  // namespace

std::unique_ptr<Verb> make_plot() { return std::make_unique<Plot>(); }

}  // namespace shaken::client
