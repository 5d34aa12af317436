#include "base/steadiness.h"

#include <array>
#include <cstddef>

namespace shaken {
namespace {

struct Words {
  const char *mark, *word, *advice;
};
/// In the order of Steadiness.
constexpr std::array<Words, 3> kRows{
    {{"", "steady", ""},
     {"~", "still relaxing", "no steady state yet, run it longer (-s time.measure=...)"},
     {"?", "not known to be steady",
      "too short to tell, its error holds the drift; run it longer (-s time.measure=...)"}}};

const Words& words_of(Steadiness steadiness) { return kRows.at(static_cast<std::size_t>(steadiness)); }

}  // namespace

Steadiness steadiness_of(std::optional<bool> steady) {
  if (!steady) return Steadiness::kNotKnown;
  return *steady ? Steadiness::kSteady : Steadiness::kRelaxing;
}

const char* mark_of(Steadiness steadiness) { return words_of(steadiness).mark; }

const char* word_of(Steadiness steadiness) { return words_of(steadiness).word; }

std::string meaning_of(Steadiness steadiness) {
  return std::string(words_of(steadiness).word) + ": " + words_of(steadiness).advice;
}

}  // namespace shaken
