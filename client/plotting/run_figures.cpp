// SPDX-License-Identifier: MIT
#include "client/plotting/run_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/steadiness.h"
#include "base/text.h"
#include "scene/fields.h"

namespace shaken::client {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Curve mean_curve(const std::vector<Curve>& replicas) {
  Curve mean = replicas.front();
  if (replicas.size() == 1) return mean;
  const std::size_t n = mean.x.size();
  mean.y_error.assign(n, kNone);
  for (const Curve& replica : replicas) {
    if (!replica.unsteady.empty()) mean.unsteady = replica.unsteady;
  }
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<double> values, sems;
    for (const Curve& replica : replicas) {
      if (!std::isfinite(replica.y[k])) continue;
      values.push_back(replica.y[k]);
      sems.push_back(replica.y_error.empty() ? kNone : replica.y_error[k]);
    }
    if (values.empty()) continue;
    const Estimate result = replica_mean(values, sems);
    mean.y[k] = result.value;
    mean.y_error[k] = result.sem;
  }
  return mean;
}

namespace {

/// What different versions computed are different points, which say so; a run that is not done yet is of the newest.
void name_versions(std::vector<PlottedRun>& runs) {
  std::set<RowVersion> versions;
  for (const PlottedRun& run : runs) {
    if (run.version.is_known()) versions.insert(run.version);
  }
  if (versions.size() < 2) return;
  for (PlottedRun& run : runs) {
    const RowVersion& version = run.version.is_known() ? run.version : *versions.rbegin();
    run.point += (run.point.empty() ? "" : ", ") + version.text();
  }
}

/// The label of a point, with a word if one of its replicas is in no steady state, or is not known to be.
std::string label_of(const std::string& point, const std::vector<PlottedRun>& runs) {
  const auto any = [&](Steadiness steadiness) {
    return std::any_of(runs.begin(), runs.end(),
                       [&](const PlottedRun& run) { return run.point == point && run.steadiness == steadiness; });
  };
  const std::string words = any(Steadiness::kRelaxing)   ? word_of(Steadiness::kRelaxing)
                            : any(Steadiness::kNotKnown) ? word_of(Steadiness::kNotKnown)
                                                         : "";
  if (words.empty()) return point;
  return point.empty() ? words : point + " (" + words + ")";
}

/// The arrays "x" and "y" (and "y_error") of every run that has them, as curves in the colour of their point. The first
/// of a point bears its label.
std::vector<Curve> curves_of(const std::vector<PlottedRun>& runs, const std::string& x, const std::string& y,
                             const std::string& y_error = "") {
  std::vector<Curve> curves;
  std::vector<std::string> points;
  for (const PlottedRun& run : runs) {
    const auto xs = run.observables.find(x);
    const auto ys = run.observables.find(y);
    if (xs == run.observables.end() || ys == run.observables.end()) continue;
    // A file that is still being written may have one array longer than the other.
    const std::size_t n = std::min(xs->second.size(), ys->second.size());
    if (n == 0) continue;
    const auto point = std::find(points.begin(), points.end(), run.point);
    Curve curve{.colour = static_cast<std::size_t>(point - points.begin()), .x = xs->second, .y = ys->second};
    if (point == points.end()) {
      points.push_back(run.point);
      curve.label = label_of(run.point, runs);
    }
    curve.x.resize(n);
    curve.y.resize(n);
    if (const auto errors = run.observables.find(y_error); errors != run.observables.end()) {
      curve.y_error = errors->second;
      curve.y_error.resize(n, kNone);
    }
    if (run.steadiness != Steadiness::kSteady) curve.unsteady.assign(n, true);
    curves.push_back(std::move(curve));
  }
  return curves;
}

/// One curve per point where its replicas have the same x; the others as they are.
std::vector<Curve> averaged(const std::vector<Curve>& curves) {
  std::vector<Curve> means;
  for (auto begin = curves.begin(); begin != curves.end();) {
    // Replicas of a point follow each other in a sweep.
    const auto end = std::find_if(
        begin, curves.end(), [&](const Curve& curve) { return curve.colour != begin->colour || curve.x != begin->x; });
    means.push_back(mean_curve({begin, end}));
    begin = end;
  }
  return means;
}

/// As averaged, with errors as bands: bars would hide curves of many bins.
std::vector<Curve> averaged_lines(const std::vector<Curve>& curves) {
  std::vector<Curve> means = averaged(curves);
  for (Curve& curve : means) curve.band = true;
  return means;
}

/// How a parameter, or a field of the results, is called in print.
struct Symbol {
  const char* name;
  const char* symbol;
  const char* unit;
};
const std::map<std::string, Symbol>& symbols() {
  static const std::map<std::string, Symbol> kSymbols{
      {"rods.length", {"rod length", "ℓ", "mm"}},
      {"rods.mid_diameter", {"middle diameter", "d", "mm"}},
      {"rods.end_diameter", {"end diameter", "d′", "mm"}},
      {"rods.area_fraction", {"area fraction", "φ", ""}},
      {"rods.count", {"number of rods", "N", ""}},
      {"box.side", {"side of the box", "L", "mm"}},
      {"box.gap", {"gap between the plates", "w", "mm"}},
      {"plates.gamma", {"shaking strength", "Γ", ""}},
      {"plates.amplitude", {"amplitude of the plates", "a", "mm"}},
      {"plates.frequency", {"frequency of the plates", "f", "Hz"}},
      {"time.step", {"time step", "Δt", "s"}},
      {"order.mean", {"nematic order", "⟨S⟩", ""}},
      {"order.std", {"fluctuation of the nematic order", "std S", ""}},
      {"measured.theta_m_deg.value", {"tilt of the layers", "θ_m", "°"}},
      {"measured.wavelength_mm.value", {"wavelength of the layers", "λ", "mm"}},
      {"measured.diffusion_mm2_s.value", {"diffusion coefficient", "D", "mm^2/s"}},
      {"measured.rotational_diffusion_rad2_s.value", {"rotational diffusion", "D_r", "rad^2/s"}},
      {"cpu_seconds", {"CPU time", "", "s"}},
  };
  return kSymbols;
}

Figure order_figure(const std::vector<PlottedRun>& runs) {
  return {.name = "order_time",
          .x_title = "time t (s)",
          .y_title = "nematic order S",
          .style = Figure::Style::kLines,
          .commands = {"set xrange [0:*]", "set yrange [0:1]"},
          .curves = curves_of(runs, "/order/time_s", "/order/order")};
}

Figure angles_figure(const std::vector<PlottedRun>& runs) {
  return {.name = "angles",
          .x_title = "angle to the director {/Symbol q} (rad)",
          .y_title = "P({/Symbol q}) (1/rad)",
          .style = Figure::Style::kLines,
          .commands = {"set xrange [-pi/2:pi/2]", "set yrange [0:*]",
                       "set xtics ('−π/2' -pi/2, '−π/4' -pi/4, '0' 0, 'π/4' pi/4, 'π/2' pi/2)"},
          .curves = averaged_lines(curves_of(runs, "/angles/theta_rad", "/angles/density_per_rad"))};
}

Figure tilt_figure(const std::vector<PlottedRun>& runs) {
  return {.name = "tilt",
          .x_title = "tilt n_z",
          .y_title = "mean velocity along the rod ⟨v_{||}⟩ (mm/s)",
          .style = Figure::Style::kLinesPoints,
          .commands = {"set xzeroaxis linecolor '#999999'", "set yzeroaxis linecolor '#999999'"},
          .curves = averaged(curves_of(runs, "/tilt/n_z", "/tilt/v_along_mm_s", "/tilt/v_along_sem_mm_s"))};
}

Figure defects_figure(const std::vector<PlottedRun>& runs) {
  Figure figure{.name = "defects",
                .x_title = "time t (s)",
                .y_title = "defects, +1/2 and −1/2 together",
                .style = Figure::Style::kLines,
                .commands = {"set xrange [0:*]", "set yrange [0:*]"},
                .curves = curves_of(runs, "/defects/time_s", "/defects/n_plus")};
  const std::vector<Curve> minus = curves_of(runs, "/defects/time_s", "/defects/n_minus");
  for (std::size_t i = 0; i < std::min(minus.size(), figure.curves.size()); ++i) {
    Curve& curve = figure.curves[i];
    for (std::size_t k = 0; k < std::min(curve.y.size(), minus[i].y.size()); ++k) curve.y[k] += minus[i].y[k];
  }
  return figure;
}

/// Curves of one array against another, averaged over replicas.
Figure lines_figure(const std::vector<PlottedRun>& runs, std::string name, std::string x_title, std::string y_title,
                    std::vector<std::string> commands, const std::string& x, const std::string& y,
                    const std::string& y_error = "") {
  return {.name = std::move(name),
          .x_title = std::move(x_title),
          .y_title = std::move(y_title),
          .style = Figure::Style::kLines,
          .commands = std::move(commands),
          .curves = averaged_lines(curves_of(runs, x, y, y_error))};
}

const char* const kZeroAxis = "set xzeroaxis linecolor '#999999'";
const char* const kLogX = "set logscale x";

/// Observables that need no more than a line each.
std::vector<Figure> line_figures(const std::vector<PlottedRun>& runs) {
  const std::string distance = "distance r (mm)", lag = "lag t (s)";
  return {
      lines_figure(runs, "order_pdf", "nematic order S", "P[S]", {"set xrange [0:1]", "set yrange [0:*]"},
                   "/order/pdf/order", "/order/pdf/density"),
      lines_figure(runs, "g2", distance, "G_2(r) = ⟨cos 2({/Symbol q}_i − {/Symbol q}_j)⟩",
                   {"set xrange [0:*]", kZeroAxis}, "/g2/r_mm", "/g2/g2"),
      lines_figure(runs, "g", distance, "g(r)", {"set xrange [0:*]", "set yrange [0:*]"}, "/g2/r_mm", "/g2/g"),
      lines_figure(runs, "g2_across", "distance across the director (mm)", "G_2", {"set xrange [0:*]", kZeroAxis},
                   "/pairs/cut/r_mm", "/pairs/cut/g2_across"),
      lines_figure(runs, "layers", "wave number across the director (1/mm)",
                   "spectrum of sin 2({/Symbol q} − {/Symbol q}_N)", {"set xrange [0:*]", "set yrange [0:*]"},
                   "/layers/q_per_mm", "/layers/spectrum_across"),
      lines_figure(runs, "orientation_memory", lag, "C_2(t)", {kLogX, kZeroAxis}, "/rotation/lag_s", "/rotation/c2",
                   "/rotation/c2_sem"),
      lines_figure(runs, "velocity_memory", lag, "C_v(t)", {kLogX, kZeroAxis}, "/velocity/lag_s", "/velocity/c_v",
                   "/velocity/c_v_sem"),
      lines_figure(runs, "number_fluctuations", "mean number in a box ⟨N⟩", "standard deviation {/Symbol D}N",
                   {"set logscale xy"}, "/fluctuations/mean_n", "/fluctuations/std_n", "/fluctuations/std_n_sem"),
  };
}

Figure msd_figure(const std::vector<PlottedRun>& runs) {
  Figure figure{.name = "msd",
                .x_title = "lag {/Symbol t} (s)",
                .y_title = "mean square displacement (mm^2)",
                .style = Figure::Style::kLines,
                .commands = {"set logscale xy", "set format xy '10^{%T}'"},
                .curves = averaged_lines(curves_of(runs, "/msd/lag_s", "/msd/total_mm2", "/msd/total_sem_mm2"))};
  // Logarithms: zero lag has no place.
  for (Curve& curve : figure.curves) {
    for (std::size_t k = 0; k < curve.x.size(); ++k) {
      if (!(curve.x[k] > 0) || !(curve.y[k] > 0)) curve.y[k] = NAN;
    }
  }
  return figure;
}

}  // namespace

std::string point_label(const Json& parameters) {
  std::string label;
  for (const auto& [path, value] : parameters.items()) {
    const auto symbol = symbols().find(path);
    const std::string number = value.is_number() ? number_text(value.get<double>())
                                                 : (value.is_string() ? value.get<std::string>() : value.dump());
    if (!label.empty()) label += ", ";
    label += fmt::format("{} = {}", symbol == symbols().end() ? path : symbol->second.symbol, number);
    if (symbol != symbols().end() && *symbol->second.unit != '\0') label += fmt::format(" {}", symbol->second.unit);
  }
  return label;
}

std::string axis_title(const std::string& path) {
  if (const auto found = symbols().find(path); found != symbols().end()) {
    const auto& [name, symbol, unit] = found->second;
    std::string title = name;
    if (*symbol != '\0') title += std::string(" ") + symbol;
    if (*unit != '\0') title += std::string(" (") + unit + ")";
    return title;
  }
  // "measured.NAME.value" by its name, which ends with its unit.
  static constexpr std::string_view kMeasured = "measured.", kValue = ".value";
  std::string name = path;
  if (name.starts_with(kMeasured) && name.ends_with(kValue)) {
    name = name.substr(kMeasured.size(), name.size() - kMeasured.size() - kValue.size());
  }
  // Names hold underscores, which enhanced text would take for subscripts.
  std::string escaped;
  for (const char c : name) escaped += c == '_' ? std::string("\\_") : std::string(1, c);
  const std::string_view unit =
      scene::field_index(path) >= 0 ? scene::default_unit(scene::field_at(path).dimension) : std::string_view();
  return unit.empty() ? escaped : fmt::format("{} ({})", escaped, unit);
}

std::vector<Figure> run_figures(std::vector<PlottedRun> runs) {
  name_versions(runs);
  std::vector<Figure> figures;
  std::vector<Figure> all{order_figure(runs), angles_figure(runs), tilt_figure(runs), defects_figure(runs),
                          msd_figure(runs)};
  for (Figure& figure : line_figures(runs)) all.push_back(std::move(figure));
  for (Figure& figure : all) {
    if (!figure.curves.empty()) figures.push_back(std::move(figure));
  }
  return figures;
}

namespace {

/// The one of `swept` with the most values; empty if none has two.
std::string longest_parameter(const std::vector<ResultRow>& points, const std::vector<std::string>& swept) {
  std::string longest;
  std::size_t most_values = 1;
  for (const std::string& path : swept) {
    std::set<double> values;
    for (const ResultRow& point : points) {
      if (const double value = point.number(path); !std::isnan(value)) values.insert(value);
    }
    if (values.size() > most_values) {
      most_values = values.size();
      longest = path;
    }
  }
  return longest;
}

std::string file_name(std::string field) {
  for (const std::string_view part : {"measured.", ".value", ".mean"}) {
    if (const auto at = field.find(part); at != std::string::npos) field.erase(at, part.size());
  }
  std::replace(field.begin(), field.end(), '.', '_');
  return field;
}

}  // namespace

std::vector<Figure> sweep_figures(const std::vector<ResultRow>& points, const SweepAxes& axes) {
  const std::vector<std::string> swept = swept_parameters(points);
  const std::string x_path = axes.x.empty() ? longest_parameter(points, swept) : axes.x;
  if (x_path.empty()) return {};

  std::vector<std::string> others;
  std::copy_if(swept.begin(), swept.end(), std::back_inserter(others),
               [&](const auto& path) { return path != x_path; });
  struct Point {
    double x, y, error;
    Steadiness steadiness;
  };
  std::vector<std::pair<std::string, std::vector<Point>>> groups;
  const bool several_versions = has_several_versions(points);
  for (const ResultRow& point : points) {
    const Point p{point.number(x_path), point.number(axes.y), standard_error(point, axes.y), steadiness(point, axes.y)};
    if (std::isnan(p.x) || std::isnan(p.y)) continue;
    Json named = Json::object();
    for (const std::string& path : others) named[path] = point.parameters.value(path, Json());
    std::string label = point_label(named);
    if (several_versions) label += (label.empty() ? "" : ", ") + version_of(point).text();
    auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == label; });
    if (group == groups.end()) group = groups.insert(groups.end(), {label, {}});
    group->second.push_back(p);
  }
  if (groups.empty()) return {};

  Figure figure{.name = file_name(axes.y) + "_" + file_name(x_path),
                .x_title = axis_title(x_path),
                .y_title = axis_title(axes.y),
                .style = Figure::Style::kLinesPoints,
                .commands = {"set offsets graph 0.04, graph 0.04, 0, 0"}};
  if (axes.y == "order.mean") {
    figure.commands.insert(figure.commands.end(),
                           {"set yrange [0:1]",
                            "set arrow from graph 0, first 0.5 to graph 1, first 0.5 nohead linecolor '#999999' "
                            "dashtype 2 back"});
  }
  bool any_error = false, any_relaxes = false, any_unknown = false;
  for (auto& [label, group] : groups) {
    std::sort(group.begin(), group.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
    Curve curve{.label = label, .colour = figure.curves.size()};
    for (const Point& point : group) {
      curve.x.push_back(point.x);
      curve.y.push_back(point.y);
      curve.y_error.push_back(point.error);
      curve.unsteady.push_back(point.steadiness != Steadiness::kSteady);
      any_error |= !std::isnan(point.error);
      any_relaxes |= point.steadiness == Steadiness::kRelaxing;
      any_unknown |= point.steadiness == Steadiness::kNotKnown;
    }
    figure.curves.push_back(std::move(curve));
  }
  if (any_error) figure.y_title += " ± standard error";
  if (any_relaxes || any_unknown) {
    figure.title =
        fmt::format("hollow: {}{}{}, run longer", any_relaxes ? word_of(Steadiness::kRelaxing) : "",
                    any_relaxes && any_unknown ? " or " : "", any_unknown ? word_of(Steadiness::kNotKnown) : "");
  }
  return {figure};
}

}  // namespace shaken::client
