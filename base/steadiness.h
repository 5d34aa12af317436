#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace shaken {

/// The kind of time that an average is of. All that shows averages has the same marks and words for it.
enum class Steadiness {
  kSteady,    ///< a steady state, or no average over time
  kRelaxing,  ///< one in which the run still relaxed
  kNotKnown,  ///< one that is too short to tell
};

/// How it is shown; Python and the page have these rows by way of the catalogue (client/catalogue.h).
struct SteadinessRow {
  std::optional<bool> steady;  ///< "steady" in summary.json
  const char* mark;            ///< before a value
  const char* word;
  const char* advice;  ///< what it means for the value, and what to do
};

/// In the order of Steadiness.
inline constexpr std::array<SteadinessRow, 3> kSteadiness{
    {{true, "", "steady", ""},
     {false, "~", "still relaxing", "no steady state yet, run it longer (-s time.measure=...)"},
     {std::nullopt, "?", "not known to be steady",
      "too short to tell, its error holds the drift; run it longer (-s time.measure=...)"}}};

constexpr Steadiness steadiness_of(std::optional<bool> steady) {
  return !steady ? Steadiness::kNotKnown : *steady ? Steadiness::kSteady : Steadiness::kRelaxing;
}
constexpr const SteadinessRow& row_of(Steadiness steadiness) {
  return kSteadiness[static_cast<std::size_t>(steadiness)];
}
constexpr const char* mark_of(Steadiness steadiness) { return row_of(steadiness).mark; }
constexpr const char* word_of(Steadiness steadiness) { return row_of(steadiness).word; }
/// The word and the advice, as a line below a table; of all but kSteady.
inline std::string meaning_of(Steadiness steadiness) {
  return std::string(word_of(steadiness)) + ": " + row_of(steadiness).advice;
}

}  // namespace shaken
