#include "base/steadiness.h"

namespace shaken {

Steadiness steadiness_of(std::optional<bool> steady) {
  if (!steady) return Steadiness::kNotKnown;
  return *steady ? Steadiness::kSteady : Steadiness::kRelaxing;
}

const char* mark_of(Steadiness steadiness) {
  return steadiness == Steadiness::kRelaxing ? "~" : steadiness == Steadiness::kNotKnown ? "?" : "";
}

const char* word_of(Steadiness steadiness) {
  switch (steadiness) {
    case Steadiness::kRelaxing:
      return "still relaxing";
    case Steadiness::kNotKnown:
      return "not known to be steady";
    default:
      return "steady";
  }
}

const char* meaning_of(Steadiness steadiness) {
  switch (steadiness) {
    case Steadiness::kRelaxing:
      return "still relaxing: no steady state yet, run it longer (-s time.measure=...)";
    case Steadiness::kNotKnown:
      return "not known to be steady: too short to tell, its error holds the drift; run it longer (-s "
             "time.measure=...)";
    default:
      return "";
  }
}

}  // namespace shaken
