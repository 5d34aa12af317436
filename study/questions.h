// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "study/run_set.h"

namespace shaken::study {

/// How a claim of the paper fares.
enum class Verdict {
  kAgrees,
  kPartly,      ///< some of what it says
  kDisagrees,   ///< beyond the errors
  kUnresolved,  ///< the errors are too large, the system is too small, or it still relaxes
  kNoData,      ///< the runs it needs are not there
};

/// What runs say to a yes-or-no question, and why, if they cannot tell.
struct Answer {
  enum class Word { kYes, kNo, kUnknown };
  Word word = Word::kUnknown;
  std::string why{};  ///< of kUnknown: "the errors are too large"
  friend bool operator==(const Answer&, const Answer&) = default;
};
Answer yes();
Answer no();
Answer unknown(std::string why);

/// What the runs say to a claim.
struct Finding {
  Verdict verdict = Verdict::kNoData;
  std::string found{};  ///< numbers with errors, in words
  std::string why{};    ///< of kUnresolved: what keeps them from telling
};

/// Errors by which two numbers must differ before they count as different.
inline constexpr double kSigmas = 2;

/// Why a number decides nothing; empty if it does. A number decides if it is measured, has an error, and its run is
/// known to be steady, or its drift is known (see judged_error).
std::string doubt(const Estimate& estimate);

/// a > b, by the errors that they are judged with.
Answer larger(const Estimate& a, const Estimate& b);
Answer above(const Estimate& estimate, double level);
Answer below(const Estimate& estimate, double level);
/// Within `tolerance` of `target`, with its error to spare.
Answer close_to(const Estimate& estimate, double target, double tolerance);
/// Whether what is measured at rising values of a key rises (or falls) from the first to the last that decide. A step
/// back between neighbours by more than three errors is a no.
Answer trend(const std::vector<Point>& points, bool rising);

/// What is gathered for a claim: answers, and the numbers behind them in words.
struct Evidence {
  std::vector<Answer> answers{};
  std::string found{};

  void answer(Answer answer) { answers.push_back(std::move(answer)); }
  /// Adds words, after "; ".
  void say(const std::string& words);
};

/// All yes: agrees. All no: disagrees. Some of both: in part. Otherwise it is open.
Finding conclude(const std::vector<Answer>& answers, std::string found);
/// The same, with words before and after those of the evidence.
Finding conclude(const Evidence& evidence, const std::string& before = "", const std::string& after = "");
/// Of what is said to hold everywhere: one no is enough.
Finding conclude_everywhere(const std::vector<Answer>& answers, std::string found);
/// Those that can tell; if none can, all.
std::vector<Answer> telling(const std::vector<Answer>& answers);

/// Value and error with at least `digits` decimals, and as many as the error needs to show. Says so if the run still
/// relaxes, and names the drift where it is not known whether it does.
std::string text(const Estimate& estimate, int digits = 2);
/// Points in words: "0.90 ± 0.01 at φ = 0.75; ...".
std::string text(const std::vector<Point>& points, const std::string& key, int digits = 2);
/// Both with "; " between, unless one is empty.
std::string listed(std::string words, const std::string& more);

}  // namespace shaken::study
