#pragma once

#include <optional>
#include <string>

namespace shaken {

/// Of what kind of time an average is. All that shows averages has the same marks and words for it.
enum class Steadiness {
  kSteady,    ///< a steady state, or no average over time
  kRelaxing,  ///< one in which the run still relaxed
  kNotKnown,  ///< one that is too short to tell
};

/// Of "steady" in summary.json: true, false, or null.
Steadiness steadiness_of(std::optional<bool> steady);

/// The mark before a value: "~" where it still relaxes, "?" where that is not known; empty for kSteady.
const char* mark_of(Steadiness steadiness);
/// "steady", "still relaxing", "not known to be steady".
const char* word_of(Steadiness steadiness);
/// The word, what it means for the value and what to do, as a line below a table; of all but kSteady.
std::string meaning_of(Steadiness steadiness);

}  // namespace shaken
