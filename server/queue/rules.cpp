#include "server/queue/rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/core/check.h"
#include "base/text.h"

namespace shaken::server {
namespace {

struct PhaseRow {
  std::string_view code;
  StoredPhase stored;
};

// clang-format off
/// In the order of JobPhase, which is that of the columns below.
constexpr std::array<PhaseRow, 15> kPhases{{
    {"Q",  {JobState::kQueued, "", ""}},
    {"Hr", {JobState::kHeld, "request", ""}},
    {"Hd", {JobState::kHeld, "room", ""}},
    {"Ho", {JobState::kHeld, "others", ""}},
    {"Hs", {JobState::kHeld, "rule", ""}},
    {"R",  {JobState::kRunning, "", ""}},
    {"Sq", {JobState::kStopping, "", to_word(JobState::kQueued)}},
    {"Sl", {JobState::kStopping, "", "last"}},
    {"Sc", {JobState::kStopping, "", to_word(JobState::kCancelled)}},
    {"Sh", {JobState::kStopping, "", to_word(JobState::kHeld)}},
    {"St", {JobState::kStopping, "", to_word(JobState::kTimedOut)}},
    {"D",  {JobState::kDone, "", ""}},
    {"F",  {JobState::kFailed, "", ""}},
    {"T",  {JobState::kTimedOut, "", ""}},
    {"C",  {JobState::kCancelled, "", ""}},
}};

struct EventRow {
  JobEvent event;
  std::string_view next;  ///< by phase
};

/// Q queued. Held: Hr on request, Hd until the disk has room, Ho for others that came to nothing, Hs by a stop rule.
/// R running. Stopping, and then: Sq queued, Sl queued as the last of its priority, Sc cancelled, Sh held on request,
/// St timed out. D done, F failed, T timed out, C cancelled. "." nothing changes, "!" cannot happen.
constexpr std::array<EventRow, 23> kRules{{
    //                                Q  Hr Hd Ho Hs R  Sq Sl Sc Sh St D  F  T  C
    {JobEvent::kCancel,              "C  C  C  C  C  Sc Sc Sc .  Sc Sc .  .  .  .  "},
    {JobEvent::kHold,                "Hr .  Hr Hr Hr Sh Sh Sh .  .  .  .  .  .  .  "},  // a cancel, a limit come first
    {JobEvent::kResume,              ".  Q  Q  Q  Q  .  .  .  .  Sq .  .  .  .  .  "},
    {JobEvent::kRetry,               ".  Q  Q  Q  Q  .  .  .  .  Sq .  .  Q  Q  Q  "},  // queued: its pause ends
    {JobEvent::kSubmitAgain,         ".  Q  .  Q  Q  .  .  .  Sq Sq Sq .  Q  Q  Q  "},  // the disk is full for it, too
    {JobEvent::kResultsLost,         "!  !  !  !  !  !  !  !  !  !  !  Q  !  !  !  "},
    {JobEvent::kExtend,              ".  .  .  .  .  .  .  .  .  .  .  Q  .  .  .  "},  // R, S: when its worker is done
    {JobEvent::kClean,               ".  .  .  .  .  .  .  .  .  .  .  C  C  C  C  "},
    {JobEvent::kLaunch,              "R  .  .  .  .  .  .  .  .  .  .  .  .  .  .  "},
    {JobEvent::kRefuseScene,         "F  .  .  .  .  .  .  .  .  .  .  .  .  .  .  "},
    {JobEvent::kSoftLimit,           ".  .  .  .  .  Sl .  .  .  .  .  .  .  .  .  "},
    {JobEvent::kTimeLimit,           "T  .  .  .  .  St .  .  .  .  .  .  .  .  .  "},
    {JobEvent::kShutDown,            ".  .  .  .  .  Sq .  .  .  .  .  .  .  .  .  "},
    {JobEvent::kWorkerDone,          "!  !  !  !  !  D  D  D  D  D  D  !  !  !  !  "},  // be it asked to stop
    {JobEvent::kWorkerFailed,        "!  !  !  !  !  F  F  F  F  F  F  !  !  !  !  "},
    {JobEvent::kWorkerStopped,       "!  !  !  !  !  Q  Q  Q  C  Hr T  !  !  !  !  "},
    {JobEvent::kWorkerCrashed,       "!  !  !  !  !  Q  Q  Q  C  Hr T  !  !  !  !  "},
    {JobEvent::kCrashedTooOften,     "!  !  !  !  !  F  Q  Q  C  Hr T  !  !  !  !  "},
    {JobEvent::kNoRoom,              "!  !  !  !  !  Hd Q  Q  C  Hr T  !  !  !  !  "},
    {JobEvent::kRoomAgain,           ".  .  Q  .  .  .  .  .  .  .  .  .  .  .  .  "},
    {JobEvent::kPrerequisiteFailed,  "Ho .  .  .  .  .  .  .  .  .  .  .  .  .  .  "},
    {JobEvent::kPrerequisiteRetried, ".  .  .  Q  .  .  .  .  .  .  .  .  .  .  .  "},
    {JobEvent::kStopRuleMet,         "Hs .  .  .  .  .  .  .  .  .  .  .  .  .  .  "},
}};
// clang-format on
constexpr std::size_t kColumn = 3;

constexpr std::string_view code_at(std::size_t event, std::size_t phase) {
  const std::string_view code = kRules[event].next.substr(kColumn * phase, kColumn);
  return code.substr(0, code.find(' '));
}

constexpr std::optional<JobPhase> phase_named(std::string_view code) {
  for (std::size_t phase = 0; phase < kPhases.size(); ++phase) {
    if (kPhases[phase].code == code) return static_cast<JobPhase>(phase);
  }
  return std::nullopt;
}

/// A row for every event, in their order, with a known code for every phase.
constexpr bool is_whole() {
  for (std::size_t row = 0; row < kRules.size(); ++row) {
    if (static_cast<std::size_t>(kRules[row].event) != row) return false;
    for (std::size_t phase = 0; phase < kPhases.size(); ++phase) {
      const std::string_view code = code_at(row, phase);
      if (code != "." && code != "!" && !phase_named(code)) return false;
    }
  }
  return kRules.back().event == JobEvent::kStopRuleMet && phase_named("C") == JobPhase::kCancelled;
}
static_assert(is_whole());

}  // namespace

std::optional<JobPhase> next_phase(JobPhase phase, JobEvent event) {
  const auto row = static_cast<std::size_t>(event), column = static_cast<std::size_t>(phase);
  const std::string_view code = code_at(row, column);
  SHAKEN_CHECK(code != "!", fmt::format("event {} in phase {}", row, kPhases.at(column).code));
  return phase_named(code);
}

StoredPhase stored(JobPhase phase) { return kPhases.at(static_cast<std::size_t>(phase)).stored; }

std::optional<JobPhase> phase_of(JobState state, std::string_view hold, std::string_view after_stop) {
  const auto row = std::find_if(kPhases.begin(), kPhases.end(), [&](const PhaseRow& each) {
    return each.stored.state == state && (hold.empty() || each.stored.hold == hold) &&
           (after_stop.empty() || each.stored.after_stop == after_stop);
  });
  return row == kPhases.end() ? std::nullopt : phase_named(row->code);
}

bool is_withdrawn(JobPhase phase) { return phase == JobPhase::kStopToCancel || came_to_nothing(stored(phase).state); }

std::optional<JobState> state_without_result(const JobCounts& counts) {
  for (const JobState state : states_that(came_to_nothing)) {
    if (counts[state] > 0) return state;
  }
  return std::nullopt;
}

std::chrono::milliseconds refusal_pause(std::chrono::milliseconds first, int times) {
  constexpr int kMostDoublings = 4;
  return first * (1 << std::min(times, kMostDoublings));
}

std::string time_limit_text(std::chrono::milliseconds limit) {
  return fmt::format("it ran for {}, its time limit; `shaken retry` gives it as much again",
                     duration_text(std::chrono::duration<double>(limit).count()));
}

}  // namespace shaken::server
