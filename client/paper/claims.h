// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "client/json.h"
#include "client/paper/run_set.h"

namespace shaken::client {

/// How a claim of the paper fares.
enum class Verdict {
  kAgrees,
  kPartly,      ///< some of what it says
  kDisagrees,   ///< beyond the errors
  kUnresolved,  ///< the errors are too large, or the system too small
  kNoData,      ///< the runs it needs are not there
};

/// What the runs say to a claim.
struct Finding {
  Verdict verdict = Verdict::kNoData;
  std::string found;  ///< numbers with errors, in words
};

/// One statement of Sharma & Soni (2024), and how to hold it against runs.
struct Claim {
  std::string_view id;
  std::string_view figure;  ///< where to look, as in paper_figures()
  std::string_view says;    ///< the paper, in our words
  Finding (*check)(const Library&);
};

std::span<const Claim> paper_claims();

/// All claims against all runs, as a table of Markdown.
std::string claims_table(const Library& runs);
/// The same as JSON: [{"claim", "figure", "verdict", "found"}].
Json claims_json(const Library& runs);

/// Puts `table` between the lines "<!-- NAME: begin -->" and "<!-- NAME: end -->" of `document`; throws Failure if it
/// lacks them.
std::string with_section(const std::string& document, const std::string& name, const std::string& table);

}  // namespace shaken::client
