// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "client/json.h"
#include "study/questions.h"
#include "study/run_set.h"

namespace shaken::study {

/// What runs like these can say to a claim at most.
enum class Reach { kEitherWay, kCannotAgree, kCannotDisagree };

/// One statement of Sharma & Soni (2024), and how to hold it against runs.
struct Claim {
  std::string_view id;
  std::string_view figure;  ///< where to look, as in paper_figures()
  std::string_view says;    ///< the paper, in our words
  Finding (*check)(const Library&);
  Reach reach = Reach::kEitherWay;
  std::string_view note{};  ///< why it goes one way only, what the paper leaves open or contradicts itself in
};

/// All of them.
std::span<const Claim> paper_claims();

/// Claims that belong to these figures; all if none is named.
std::vector<Claim> claims_of(std::span<const std::string_view> figures);

/// Claims against all runs, as a table of Markdown.
std::string claims_table(const Library& runs, std::span<const Claim> claims);
/// The same as JSON: [{"claim", "figure", "says", "verdict", "found", "why", "note"}].
Json claims_json(const Library& runs, std::span<const Claim> claims);

/// "agrees", "not resolved".
std::string_view word(Verdict verdict);

}  // namespace shaken::study
