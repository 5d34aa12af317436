// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>

#include "base/files.h"
#include "base/text.h"
#include "client/plotting/run_figures.h"
#include "client/results.h"
#include "client/target.h"
#include "client/verbs/verbs.h"
#include "run/files/directory.h"
#include "run/files/version.h"

namespace shaken::client {
namespace {

namespace fs = std::filesystem;

class Plot : public Verb {
 public:
  VerbInfo info() const override {
    return {"plot", kResultsGroup, "Figures of a sweep, a job or a run directory, by gnuplot",
            "  shaken plot                   the newest sweep, into plots-s3/\n"
            "  shaken plot s3 -o figures     S(t), S against the swept parameter, P(theta), tilt, G2, MSD\n"
            "  shaken plot s3 --x rods.area_fraction --y theta_m_deg -o theta.pdf\n"
            "  shaken plot s3 --format svg   as PDF or SVG instead of PNG\n"
            "  shaken plot runs/first        what `shaken run` has left there\n"
            "  gnuplot figures/order_time.gp  draws one again, after changing it to taste"};
  }

  void declare(Arguments& arguments) override {
    arguments.optional("ID", id_, "A sweep, a job or a run directory; the newest sweep if left out", Names::kRun);
    arguments.option("--x", x_, "PATH",
                     "One figure: against this parameter or field; the longest swept one if left out", Names::kField);
    arguments.option("--y", y_, "FIELD",
                     "One figure: of this field of `results --csv`, or scalar; order.mean if left out", Names::kField);
    arguments.option("-o,--out", out_, "DIR", "Where to write; plots-ID if left out. With --x or --y also a file",
                     Names::kFolder);
    arguments.option("--format", format_, "png|pdf|svg", "png if left out; with --x or --y also by the suffix of --out",
                     Names::kAnything);
  }

  ExitCode run(const Context& context) override {
    const std::optional<PictureFile> file = read_options();
    Console& console = context.console;
    std::vector<PlottedRun> runs;
    std::vector<Figure> figures;
    LeftOut left_out;
    if (!id_.empty() && is_run_directory(id_)) {
      if (one_figure()) throw Failure(ExitCode::kBadInput, "--x and --y are for sweeps, not for a run directory");
      if (out_.empty()) out_ = (fs::path(id_) / "plots").string();
      add_run(id_, "", "", runs, left_out);
    } else {
      ApiClient session(context.root());
      const Target target = find_target_or_newest(session, id_);
      const Json& named = target.answer.at(target.is_sweep ? "sweep" : "job");
      if (out_.empty()) out_ = "plots-" + short_id(named.at("id").get<std::string>());
      if (target.is_sweep) sweep_ = text_of(named, "name");
      const std::vector<ResultRow> rows = result_rows(session, target), points = aggregated(rows);
      for (const ResultRow& row : rows) note_origin(field_text(row, "job"), version_of(row));
      if (one_figure()) {
        figures = one_figure_of(points);
      } else {
        std::set<std::string> met;  // a run that several points of a sweep ask for is one run
        for (const Json& job : jobs_of(target)) {
          if (text_of(job, "state") == "queued" || !met.insert(text_of(job, "id")).second) continue;
          add_run(job.at("directory").get<std::string>(), point_label(job.at("parameters")), text_of(job, "state"),
                  runs, left_out);
        }
        figures = sweep_figures(points);
      }
    }
    for (const auto& [why, n] : left_out) {
      console.err << fmt::format("left out: {}{}\n", n > 1 ? fmt::format("{} runs, ", n) : "", printable(why));
    }
    for (const PlottedRun& run : runs) note_origin(run.id, run.version);
    for (Figure& figure : run_figures(std::move(runs))) figures.push_back(std::move(figure));
    if (figures.empty()) throw Failure(ExitCode::kFailed, "there is nothing to plot yet");
    if (file) {
      figures.front().name = file->name;
      out_ = file->folder.string();
    }
    const PlotOrigin origin = this->origin();
    for (Figure& figure : figures) figure.origin = origin;
    for (const Figure& figure : figures) console.out << draw(figure, out_, picture_format_).string() << "\n";
    return ExitCode::kOk;
  }

 private:
  /// --out as a single picture.
  struct PictureFile {
    fs::path folder;
    std::string name;
  };
  using LeftOut = std::map<std::string, int>;  ///< why, and how often

  bool one_figure() const { return !x_.empty() || !y_.empty(); }

  static std::optional<PictureFormat> format_of(std::string_view word) {
    for (const PictureFormat format : {PictureFormat::kPng, PictureFormat::kPdf, PictureFormat::kSvg}) {
      if (word == suffix_of(format)) return format;
    }
    return std::nullopt;
  }

  /// Sets the format; returns the picture that --out names, if it names one.
  std::optional<PictureFile> read_options() {
    const fs::path out(out_);
    const std::string suffix = out.has_extension() ? out.extension().string().substr(1) : "";
    const std::optional<PictureFormat> of_suffix = format_of(suffix);
    const std::optional<PictureFormat> asked = format_of(format_);
    std::string problems;
    if (!format_.empty() && !asked) problems += fmt::format("--format takes png, pdf or svg, not '{}'\n", format_);
    if (of_suffix && !one_figure()) {
      problems += fmt::format("{} is one picture, and this draws several: give a folder, or --x and --y\n", out_);
    }
    std::error_code unknown;
    if (one_figure() && !suffix.empty() && !of_suffix && !fs::is_directory(out, unknown)) {
      problems += fmt::format("{}: a plot is a .png, .pdf or .svg\n", out_);
    }
    if (of_suffix && asked && suffix != format_) {
      problems += fmt::format("--format {} does not go with {}\n", format_, out_);
    }
    if (!problems.empty()) {
      problems.pop_back();
      throw Failure(ExitCode::kBadInput, problems);
    }
    if (asked) {
      picture_format_ = *asked;
    } else if (of_suffix) {
      picture_format_ = *of_suffix;
    }
    if (!of_suffix) return std::nullopt;
    return PictureFile{out.has_parent_path() ? out.parent_path() : fs::path("."), out.stem().string()};
  }

  /// A run that is in the plots.
  void note_origin(const std::string& id, const RowVersion& version) {
    if (!id.empty()) runs_.insert(id);
    if (version.is_known()) versions_.insert(version.text());
  }

  /// What the plots are made from. A sweep goes by its name: its number says when it was submitted, and equal runs make
  /// equal files.
  PlotOrigin origin() const {
    PlotOrigin origin{{"Software", std::string("shaken plot ") + run::version()}};
    if (!versions_.empty()) origin.emplace_back("Computed by", origin_list({versions_.begin(), versions_.end()}));
    if (!sweep_.empty()) origin.emplace_back("Sweep", printable(sweep_));
    if (!runs_.empty()) origin.emplace_back("Runs", printable(origin_list({runs_.begin(), runs_.end()})));
    return origin;
  }

  std::vector<Figure> one_figure_of(const std::vector<ResultRow>& points) const {
    SweepAxes axes;
    if (!x_.empty()) axes.x = resolved_field(points, x_);
    if (!y_.empty()) axes.y = resolved_field(points, y_);
    std::vector<Figure> figures = sweep_figures(points, axes);
    if (figures.empty()) {
      throw Failure(ExitCode::kFailed, axes.x.empty()
                                           ? "no numeric parameter is swept: --x names a field to plot against"
                                           : fmt::format("no point has both {} and {} as numbers", axes.x, axes.y));
    }
    return figures;
  }

  /// A run without observables is counted by its reason and left out; the others are plotted.
  static void add_run(const fs::path& directory, const std::string& point, const std::string& state,
                      std::vector<PlottedRun>& runs, LeftOut& left_out) {
    const run::RunDirectory files{directory};
    if (!fs::exists(files.observables())) {
      ++left_out[state.empty() || state == "done" ? "no observables.h5 there: " + directory.string()
                                                  : state + " before anything was measured"];
      return;
    }
    auto observables = run::read_observables(files.observables());
    if (!observables) {
      ++left_out[observables.error().message];
      return;
    }
    const auto text = read_file(files.summary());
    const Json summary = text ? Json::parse(*text, nullptr, false) : Json();
    const Json steady = summary.is_object() ? summary.value("steady", Json()) : Json();
    runs.push_back({point, *std::move(observables),
                    steadiness_of(steady.is_boolean() ? std::optional(steady.get<bool>()) : std::nullopt),
                    version_of(summary.is_object() ? summary.value("versions", Json()) : Json()),
                    summary.is_object() ? text_of(summary, "run_id") : ""});
  }

  std::string x_;
  std::string y_;
  std::string format_;
  PictureFormat picture_format_ = PictureFormat::kPng;
  std::string sweep_;               ///< its name
  std::set<std::string> runs_;      ///< ids of what is plotted
  std::set<std::string> versions_;  ///< what computed it
  std::string id_;
  std::string out_;
};

}  // namespace

std::unique_ptr<Verb> make_plot() { return std::make_unique<Plot>(); }

}  // namespace shaken::client
