// SPDX-License-Identifier: MIT
#include "study/questions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/panels.h"

namespace shaken::study {
namespace {

/// Errors by which neighbours of a trend may go the other way: with ten of them two errors would be met by chance.
constexpr double kStepBack = 3;

using Word = Answer::Word;

Answer compared(const Estimate& a, const Estimate& b, double sigmas) {
  for (const Estimate& estimate : {a, b}) {
    if (std::string why = doubt(estimate); !why.empty()) return unknown(std::move(why));
  }
  const double margin = sigmas * std::hypot(judged_error(a), judged_error(b));
  if (a.value - b.value > margin) return yes();
  return b.value - a.value > margin ? no() : unknown("the errors are too large");
}

std::ptrdiff_t count(const std::vector<Answer>& answers, Word word) {
  return std::count_if(answers.begin(), answers.end(), [&](const Answer& answer) { return answer.word == word; });
}

/// Why the unknown ones are, each reason once.
std::string reasons(const std::vector<Answer>& answers) {
  std::vector<std::string> seen;
  std::string words;
  for (const Answer& answer : answers) {
    if (answer.word != Word::kUnknown || std::find(seen.begin(), seen.end(), answer.why) != seen.end()) continue;
    seen.push_back(answer.why);
    words = listed(std::move(words), answer.why);
  }
  return words;
}

}  // namespace

Answer yes() { return {Word::kYes}; }
Answer no() { return {Word::kNo}; }
Answer unknown(std::string why) { return {Word::kUnknown, std::move(why)}; }

std::string doubt(const Estimate& estimate) {
  if (!is_known(estimate)) return "not measured everywhere";
  if (estimate.steady == false) return "a run still relaxes";
  if (!std::isfinite(estimate.sem)) return "too few independent samples for an error";
  if (!std::isfinite(judged_error(estimate))) return "not known whether a run is steady";
  return "";
}

Answer larger(const Estimate& a, const Estimate& b) { return compared(a, b, kSigmas); }
Answer above(const Estimate& estimate, double level) { return larger(estimate, exactly(level)); }
Answer below(const Estimate& estimate, double level) { return larger(exactly(level), estimate); }

Answer close_to(const Estimate& estimate, double target, double tolerance) {
  if (std::string why = doubt(estimate); !why.empty()) return unknown(std::move(why));
  const double away = std::abs(estimate.value - target);
  const double margin = kSigmas * judged_error(estimate);
  if (away + margin <= tolerance) return yes();
  return away - margin > tolerance ? no() : unknown("the errors are too large");
}

Answer trend(const std::vector<Point>& points, bool rising) {
  std::vector<Estimate> deciding;
  std::string why = "fewer than two points";
  for (const Point& point : points) {
    std::string doubtful = doubt(point.estimate);
    if (doubtful.empty()) {
      deciding.push_back(point.estimate);
    } else {
      why = std::move(doubtful);
    }
  }
  if (deciding.size() < 2) return unknown(why);
  if (!rising) std::reverse(deciding.begin(), deciding.end());
  for (std::size_t k = 1; k < deciding.size(); ++k) {
    if (compared(deciding[k - 1], deciding[k], kStepBack) == yes()) return no();
  }
  return larger(deciding.back(), deciding.front());
}

Finding conclude(const std::vector<Answer>& answers, std::string found) {
  if (answers.empty()) return {};
  const bool any_yes = count(answers, Word::kYes) > 0, any_no = count(answers, Word::kNo) > 0;
  if (any_yes && any_no) return {Verdict::kPartly, std::move(found)};
  if (count(answers, Word::kUnknown) > 0) return {Verdict::kUnresolved, std::move(found), reasons(answers)};
  return {any_yes ? Verdict::kAgrees : Verdict::kDisagrees, std::move(found)};
}

Finding conclude(const Evidence& evidence, const std::string& before, const std::string& after) {
  return conclude(evidence.answers, before + evidence.found + after);
}

Finding conclude_everywhere(const std::vector<Answer>& answers, std::string found) {
  if (count(answers, Word::kNo) > 0) return {Verdict::kDisagrees, std::move(found)};
  return conclude(answers, std::move(found));
}

std::vector<Answer> telling(const std::vector<Answer>& answers) {
  std::vector<Answer> able;
  std::copy_if(answers.begin(), answers.end(), std::back_inserter(able),
               [](const Answer& answer) { return answer.word != Word::kUnknown; });
  return able.empty() ? answers : able;
}

std::string text(const Estimate& estimate, int digits) {
  if (!is_known(estimate)) return "-";
  std::string words;
  if (std::isfinite(estimate.sem)) {
    if (estimate.sem > 0) digits = std::clamp(static_cast<int>(std::ceil(-std::log10(estimate.sem))), digits, 6);
    words = fmt::format("{:.{}f} ± {:.{}f}", estimate.value, digits, estimate.sem, digits);
  } else {
    words = fmt::format("{:.{}f} ± ?", estimate.value, digits);
  }
  if (estimate.steady == false) return words + " (still relaxing)";
  if (estimate.steady || !std::isfinite(estimate.drift_sem)) return words;
  return words + fmt::format(" (drift {:.{}f} ± {:.{}f})", estimate.drift, digits, estimate.drift_sem, digits);
}

std::string text(const std::vector<Point>& points, const std::string& key, int digits) {
  std::string words;
  for (const auto& [at, estimate] : points) {
    words = listed(std::move(words), fmt::format("{} at {}", text(estimate, digits), value_label(key, at)));
  }
  return words;
}

void Evidence::say(const std::string& words) { found = listed(std::move(found), words); }

std::string listed(std::string words, const std::string& more) {
  if (!words.empty() && !more.empty()) words += "; ";
  return words + more;
}

}  // namespace shaken::study
