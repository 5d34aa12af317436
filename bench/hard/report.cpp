// SPDX-License-Identifier: MIT
#include "bench/hard/report.h"

#include <fmt/format.h>

#include <cmath>

#include "bench/machine.h"
#include "bench/picture.h"
#include "run/files/version.h"

namespace shaken::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string margin_text(const Outcome& outcome) {
  const double margin = outcome.margin();
  return std::isfinite(margin) && margin > 0 && outcome.limit > 0 ? fmt::format("{:.2g}", margin) : "-";
}

const char* verdict(const Outcome& outcome) { return outcome.ok() ? "holds" : "DOES NOT HOLD"; }

}  // namespace

std::string as_text(const std::vector<HardCase>& cases) {
  std::vector<std::vector<std::string>> rows{{"case", "what must hold", "worst", "limit", "margin", "verdict"}};
  for (const HardCase& of : cases) {
    for (const Outcome& outcome : of.outcomes) {
      rows.push_back({&outcome == &of.outcomes.front() ? of.name : "", outcome.holds,
                      fmt::format("{:.3g}", outcome.worst),
                      fmt::format("{} {:.3g}", outcome.at_least ? ">=" : "<=", outcome.limit), margin_text(outcome),
                      verdict(outcome)});
    }
  }
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text = fmt::format("shaken {}\n", run::version());
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const bool left = c < 2 || c == 5;
      line += left ? fmt::format("{:<{}}  ", row[c], widths[c]) : fmt::format("{:>{}}  ", row[c], widths[c]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  for (const HardCase& of : cases) {
    for (const Outcome& outcome : of.outcomes) {
      if (!outcome.ok()) text += fmt::format("{}: {}: {}\n", of.name, outcome.holds, outcome.note);
    }
  }
  return text;
}

Json as_json(const std::vector<HardCase>& cases) {
  Json rows = Json::array();
  for (const HardCase& of : cases) {
    for (const Outcome& outcome : of.outcomes) {
      const double margin = outcome.margin();
      rows.push_back({{"case", of.name},
                      {"what", of.what},
                      {"holds", outcome.holds},
                      {"worst", outcome.worst},
                      {"limit", outcome.limit},
                      {"limit_is", outcome.at_least ? "least" : "most"},
                      {"margin", std::isfinite(margin) ? Json(margin) : Json(nullptr)},
                      {"ok", outcome.ok()},
                      {"note", outcome.note}});
    }
  }
  return {{"bench", "hard"}, {"version", run::version()}, {"machine", to_json(this_machine())}, {"rows", rows}};
}

void draw_margins(const std::filesystem::path& folder, const std::vector<HardCase>& cases) {
  std::string data = "# case  smallest margin\n";
  int n = 0;
  for (const HardCase& of : cases) {
    double least = 1e99;
    for (const Outcome& outcome : of.outcomes) {
      const double margin = outcome.margin();
      if (outcome.limit > 0 && !outcome.at_least && std::isfinite(margin)) least = std::min(least, margin);
    }
    if (least > 1e98) continue;  // nothing but yes and no
    data += fmt::format("\"{}\" {:.4g} {}\n", of.name, least, n++);
  }
  std::string script = gnuplot_prologue("hard", 1000, 200 + 28 * n);
  script += fmt::format(
      "set logscale x\nset xrange [0.5:*]\nset yrange [{}:-1]\nset xlabel 'smallest margin: limit over worst value "
      "seen'\n"
      "set style fill solid\nset arrow from 1,graph 0 to 1,graph 1 nohead linecolor '#d62728' dashtype 2\n"
      "plot 'hard.dat' using (0.5):3:(0.5):2:($3-0.35):($3+0.35):ytic(1) with boxxyerror linecolor '#3b528b' notitle\n",
      n);
  draw(folder, "hard", data, script);
}

}  // namespace shaken::bench
