// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "client/json.h"
#include "client/paper/questions.h"
#include "client/paper/run_set.h"

namespace shaken::client {

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
std::vector<Claim> order_claims();      ///< where rods order, how sharply, in which box
std::vector<Claim> structure_claims();  ///< correlations in space, elasticity
std::vector<Claim> layer_claims();      ///< layers and what they depend on, crystal
std::vector<Claim> motion_claims();     ///< swimming, diffusion, rotation, defects

/// Claims that belong to these figures; all if none is named.
std::vector<Claim> claims_of(std::span<const std::string_view> figures);

/// Claims against all runs, as a table of Markdown.
std::string claims_table(const Library& runs, std::span<const Claim> claims);
/// The same as JSON: [{"claim", "figure", "says", "verdict", "found", "why", "note"}].
Json claims_json(const Library& runs, std::span<const Claim> claims);

/// "agrees", "not resolved".
std::string_view word(Verdict verdict);

/// Puts `table` between the lines "<!-- NAME: begin -->" and "<!-- NAME: end -->" of `document`; throws Failure if it
/// lacks them.
std::string with_section(const std::string& document, const std::string& name, const std::string& table);

// What the claims look at, in several files.

/// The runs of one sweep at a length and an area fraction.
RunSet of(const Library& runs, const char* set, double length, double fraction);
/// The layered sweep's at a length, an area fraction and an end diameter.
RunSet layers(const Library& runs, double length, double fraction, double end_diameter = 0.4);
/// The paper's box [mm], its smaller one. A narrower box orders more easily: there, order is no sign of order in the
/// paper's, and disorder is.
inline constexpr double kPapersBox = 83.7;
bool is_papers_box(const RunSet& runs);
/// G2 far away: mean over the last quarter of the distances, up to half the box. Its error is the mean of theirs, as if
/// they went up and down together, which is the most it can be.
Quantity far_g2(const RunSet& runs);

}  // namespace shaken::client
