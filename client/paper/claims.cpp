// SPDX-License-Identifier: MIT
#include "client/paper/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/failure.h"

namespace shaken::client {

std::span<const Claim> paper_claims() {
  static const std::vector<Claim> kClaims = [] {
    std::vector<Claim> all;
    for (const auto& some : {order_claims(), structure_claims(), layer_claims(), motion_claims()}) {
      all.insert(all.end(), some.begin(), some.end());
    }
    return all;
  }();
  return kClaims;
}

std::vector<Claim> claims_of(std::span<const std::string_view> figures) {
  std::vector<Claim> chosen;
  for (const Claim& claim : paper_claims()) {
    if (figures.empty() || std::find(figures.begin(), figures.end(), claim.figure) != figures.end()) {
      chosen.push_back(claim);
    }
  }
  return chosen;
}

std::string_view word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAgrees:
      return "agrees";
    case Verdict::kPartly:
      return "in part";
    case Verdict::kDisagrees:
      return "disagrees";
    case Verdict::kUnresolved:
      return "not resolved";
    case Verdict::kNoData:
      break;
  }
  return "no data";
}

std::string claims_table(const Library& runs, std::span<const Claim> claims) {
  std::string table = "| figure | the paper says | found here | verdict |\n|---|---|---|---|\n";
  for (const Claim& claim : claims) {
    const Finding finding = claim.check(runs);
    std::string says(claim.says), verdict(word(finding.verdict));
    if (claim.reach == Reach::kCannotAgree) says += ". *Runs like these can refute it only:* ";
    if (claim.reach == Reach::kCannotDisagree) says += ". *Runs like these can confirm it only:* ";
    if (claim.reach == Reach::kEitherWay && !claim.note.empty()) says += ". *Note:* ";
    says += claim.note;
    if (finding.verdict == Verdict::kDisagrees) verdict.insert(0, "**").append("**");
    if (!finding.why.empty()) verdict += ": " + finding.why;
    table += fmt::format("| {} | {} | {} | {} |\n", claim.figure, says, finding.found, verdict);
  }
  return table;
}

Json claims_json(const Library& runs, std::span<const Claim> claims) {
  Json list = Json::array();
  for (const Claim& claim : claims) {
    const Finding finding = claim.check(runs);
    list.push_back({{"claim", claim.id},
                    {"figure", claim.figure},
                    {"says", claim.says},
                    {"verdict", word(finding.verdict)},
                    {"found", finding.found},
                    {"why", finding.why},
                    {"note", claim.note}});
  }
  return list;
}

std::string with_section(const std::string& document, const std::string& name, const std::string& table) {
  const std::string begin_mark = fmt::format("<!-- {}: begin -->\n", name);
  const std::string end_mark = fmt::format("<!-- {}: end -->", name);
  const std::size_t begin = document.find(begin_mark);
  const std::size_t end = document.find(end_mark);
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    throw Failure(ExitCode::kBadInput, fmt::format("the report lacks the lines {}{}", begin_mark, end_mark));
  }
  return document.substr(0, begin + begin_mark.size()) + table + document.substr(end);
}

RunSet of(const Library& runs, const char* set, double length, double fraction) {
  return where(where(runs[set], "rods.length", length), "rods.area_fraction", fraction);
}

RunSet layers(const Library& runs, double length, double fraction, double end_diameter) {
  return where(of(runs, "layers", length, fraction), "rods.end_diameter", end_diameter);
}

bool is_papers_box(const RunSet& runs) {
  return !runs.empty() && std::all_of(runs.begin(), runs.end(),
                                      [](const FinishedRun& run) { return run.number("box.side") >= kPapersBox; });
}

Quantity far_g2(const RunSet& runs) {
  std::vector<Quantity> far;
  for (const FinishedRun& run : runs) {
    const auto &g2 = run.array("/g2/g2"), &errors = run.array("/g2/g2_sem");
    double sum = 0, error = 0, n = 0;
    for (std::size_t k = 3 * g2.size() / 4; k < g2.size(); ++k) {
      if (!std::isfinite(g2[k])) continue;
      sum += g2[k];
      error += errors.size() == g2.size() ? errors[k] : NAN;
      n += 1;
    }
    far.push_back(n > 0 ? Quantity{sum / n, error / n, run.steadiness()} : Quantity{});
  }
  return mean_of(far);
}

}  // namespace shaken::client
