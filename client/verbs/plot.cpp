// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <set>

#include "base/plots_by_python.h"
#include "base/process.h"
#include "base/text.h"
#include "client/live/target.h"
#include "client/results.h"
#include "client/verbs/verbs.h"
#include "client/where.h"
#include "run/files/version.h"

namespace shaken::client {
namespace {

namespace fs = std::filesystem;

class Plot : public Verb {
 public:
  VerbInfo info() const override {
    return {"plot", kResultsGroup, "Figures of a sweep, a job or a run directory",
            "  shaken plot                   the newest sweep, into plots-s3/\n"
            "  shaken plot s3 -o figures     S(t), S against the swept parameter, P(theta), tilt, G2, MSD\n"
            "  shaken plot s3 --x rods.area_fraction --y theta_m_deg -o theta.pdf\n"
            "  shaken plot s3 --where 'rods.length=4.5 and box.gap<2mm' --width 183mm\n"
            "  shaken plot s3 --format svg   as PDF or SVG instead of PNG\n"
            "  shaken plot s3 --map -o map.png               the last frames of its runs, by one or two swept numbers\n"
            "  shaken plot runs/first        what `shaken run` has left there",
            kExitCodesOfDaemon};
  }

  void declare(Arguments& arguments) override {
    arguments.optional("ID", id_, "A sweep, a job or a run directory; the newest sweep if left out", Names::kRun);
    arguments.option("--x", x_, "PATH",
                     "One figure: against this parameter or field; the longest swept one if left out", Names::kField);
    arguments.option("--y", y_, "FIELD",
                     "One figure: of this field of `results --csv`, or scalar; order.mean if left out", Names::kField);
    arguments.repeatable("-w,--where", where_, "CONDITION",
                         "Only points that match, as of `results`; repeatable, all must hold");
    arguments.flag("--map", map_, "One figure: the last frames of the runs over the first one or two swept numbers");
    arguments.option("-o,--out", out_, "DIR", "Where to write; plots-ID if left out. Of one figure also a file",
                     Names::kFolder);
    arguments.option("--format", format_, "png|pdf|svg", "png if left out; of one figure also by the suffix of --out",
                     Names::kAnything);
    arguments.option("--width", width_, "89mm|120mm|183mm",
                     "A column, one and a half, or a page; as the panels need it if left out", Names::kAnything);
  }

  ExitCode run(const Context& context) override {
    const std::optional<fs::path> file = read_options();
    Json wanted{{"software", std::string("shaken plot ") + run::version()},
                {"width", width_},
                {"runs", Json::array()},
                {"rows", Json::array()}};
    if (!id_.empty() && is_run_directory(id_)) {
      if (one_figure() || !where_.empty()) {
        throw Failure(ExitCode::kBadInput, "--x, --y, --map and --where are for sweeps, not for a run directory");
      }
      if (out_.empty()) out_ = (fs::path(id_) / "plots").string();
      wanted["runs"].push_back({{"directory", url_encoded(id_)}, {"parameters", Json::object()}});
    } else {
      add_sweep(context, wanted);
    }
    if (file) {
      wanted["name"] = url_encoded(file->stem().string());
      out_ = file->has_parent_path() ? file->parent_path().string() : ".";
    }
    wanted["folder"] = url_encoded(out_);  // whose bytes may be no UTF-8, which JSON does not take
    wanted["format"] = format_;
    for (const std::string& line :
         plots_by_python({"runs"}, wanted.dump(-1, ' ', false, Json::error_handler_t::replace))) {
      (line.starts_with("left out: ") ? context.console.err : context.console.out) << line << "\n";
    }
    return ExitCode::kOk;
  }

 private:
  bool one_figure() const { return map_ || !x_.empty() || !y_.empty(); }

  static bool is_format(std::string_view word) { return word == "png" || word == "pdf" || word == "svg"; }

  /// Sets the format; returns the picture that --out names, if it names one.
  std::optional<fs::path> read_options() {
    const fs::path out(out_);
    const std::string suffix = out.has_extension() ? out.extension().string().substr(1) : "";
    const bool is_picture = is_format(suffix);
    std::string problems;
    if (!format_.empty() && !is_format(format_)) {
      problems += fmt::format("--format takes png, pdf or svg, not '{}'\n", format_);
    }
    if (!width_.empty() && width_ != "89mm" && width_ != "120mm" && width_ != "183mm") {
      problems += fmt::format("--width takes 89mm, 120mm or 183mm, not '{}'\n", width_);
    }
    if (is_picture && !one_figure()) {
      problems +=
          fmt::format("{} is one picture, and this draws several: give a folder, or --x and --y, or --map\n", out_);
    }
    if (map_ && !(x_ + y_).empty()) problems += "--map goes with neither --x nor --y\n";
    std::error_code unknown;
    if (one_figure() && !suffix.empty() && !is_picture && !fs::is_directory(out, unknown)) {
      problems += fmt::format("{}: a plot is a .png, .pdf or .svg\n", out_);
    }
    if (is_picture && is_format(format_) && suffix != format_) {
      problems += fmt::format("--format {} does not go with {}\n", format_, out_);
    }
    if (!problems.empty()) {
      problems.pop_back();
      throw Failure(ExitCode::kBadInput, problems);
    }
    if (format_.empty()) format_ = is_picture ? suffix : "png";
    return is_picture ? std::optional(out) : std::nullopt;
  }

  /// What the daemon knows of a sweep or a job.
  void add_sweep(const Context& context, Json& wanted) {
    Conditions conditions = Conditions::parse(where_);
    ApiClient session(context.root());
    const Target target = find_target_or_newest(session, id_);
    const Json& named = target.answer.at(target.is_sweep ? "sweep" : "job");
    if (out_.empty()) out_ = "plots-" + short_id(named.at("id").get<std::string>());
    // by its name: its number says when it was submitted, and equal runs make equal files
    if (target.is_sweep) wanted["sweep"] = text_of(named, "name");
    std::vector<ResultRow> rows = result_rows(session, target);
    conditions.add_from_scenes(rows, target);
    std::vector<ResultRow> points = aggregated(rows);
    const std::string x = x_.empty() ? "" : resolved_field(points, x_);
    const std::string y = y_.empty() ? "order.mean" : resolved_field(points, y_);
    conditions.keep_matching(points, "points", context.console.err);
    if (points.empty() && !where_.empty()) {
      throw Failure(ExitCode::kFailed, "there is nothing to plot: no point matches --where");
    }
    wanted["x"] = x;
    wanted["y"] = y;
    wanted["over"] = {{"x", times_over(points, x)}, {"y", times_over(points, y)}};
    wanted["points"] = Json::array();
    std::set<std::string> kept;  // parameters
    for (const ResultRow& point : points) {
      wanted["points"].push_back(plotted(point, x, y));
      kept.insert(point.parameters.dump());
    }
    for (const ResultRow& row : rows) {
      if (!kept.contains(row.parameters.dump())) continue;
      wanted["rows"].push_back({{"id", field_text(row, "job")}, {"version", version_text(row)}});
    }
    if (map_) wanted["renderer"] = url_encoded(sibling_program("shaken-render").string());
    if (one_figure() && !map_) return;
    std::set<std::string> met;  // a run that several points of a sweep ask for is one run
    for (const Json& job : jobs_of(target)) {
      if ((text_of(job, "state") == "queued" && !map_) || !kept.contains(job.at("parameters").dump()) ||
          !met.insert(text_of(job, "id")).second) {
        continue;
      }
      wanted["runs"].push_back({{"directory", url_encoded(job.at("directory").get<std::string>())},
                                {"parameters", job.at("parameters")},
                                {"state", text_of(job, "state")}});
    }
  }

  static std::string version_text(const ResultRow& row) {
    const RowVersion version = version_of(row);
    return version.is_known() ? version.text() : "";
  }

  /// The times over which a number is taken in the points, "over_s" in summary.json [s]; none if it depends on none.
  static std::set<double> times_over(const std::vector<ResultRow>& points, const std::string& field) {
    constexpr std::string_view kValue = ".value";
    std::set<double> times;
    if (!field.ends_with(kValue)) return times;
    for (const ResultRow& point : points) {
      const double time = point.number(field.substr(0, field.size() - kValue.size()) + ".over_s");
      if (!std::isnan(time)) times.insert(time);
    }
    return times;
  }

  /// A point as `shaken.plots` takes it; what is not known is null.
  static Json plotted(const ResultRow& point, const std::string& x, const std::string& y) {
    const Steadiness of = steadiness(point, y);
    return {{"parameters", point.parameters},
            {"version", version_text(point)},
            {"x", point.number(x)},
            {"y", point.number(y)},
            {"error", standard_error(point, y)},
            {"steady", of == Steadiness::kNotKnown ? Json() : Json(of == Steadiness::kSteady)}};
  }

  std::string x_;
  std::string y_;
  bool map_ = false;
  std::vector<std::string> where_;
  std::string format_;
  std::string width_;
  std::string id_;
  std::string out_;
};

}  // namespace

std::unique_ptr<Verb> make_plot() { return std::make_unique<Plot>(); }

}  // namespace shaken::client
