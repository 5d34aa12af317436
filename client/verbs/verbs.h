#pragma once

#include <memory>

#include "client/verb.h"

namespace shaken::client {

inline constexpr const char* kPrepareGroup = "Prepare";
inline constexpr const char* kControlGroup = "Run and control";
inline constexpr const char* kResultsGroup = "Results";
inline constexpr const char* kHelpGroup = "Set-up and help";

// clang-format off
/// Every verb, in the order of the help within its group: make_VERB() of each.
#define SHAKEN_VERBS(X) \
  X(init) X(schema) X(validate) X(explain) X(calibrate) X(import) X(run) X(submit) X(status) X(watch) X(record) \
  X(replay_log) X(web) X(logs) X(history) X(wait) X(extend) X(hold) X(resume) X(retry) X(priority) X(cancel) \
  X(clean) X(results) X(plot) X(figures) X(picture) X(movie) X(export) X(measure) X(replay) X(pack) X(unpack) \
  X(bench) X(doctor) X(completion) X(cite)
// clang-format on
#define SHAKEN_VERB(name) std::unique_ptr<Verb> make_##name();
SHAKEN_VERBS(SHAKEN_VERB)
#undef SHAKEN_VERB

}  // namespace shaken::client
