#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shaken {

/// Where a job is in its life. server/queue/rules.cpp says how it gets from one state to the next.
enum class JobState { kQueued, kHeld, kRunning, kStopping, kDone, kFailed, kTimedOut, kCancelled };

/// What a state means. No other list of them is written by hand: Python, the page and docs/protocol.md have this one by
/// way of the catalogue (client/catalogue.h).
struct JobStateRow {
  JobState state;
  std::string_view word;      ///< in the queue's file, in the API and on the bus
  bool has_worker;            ///< a worker is at work on the job, or has been handed over to a cluster
  bool has_ended;             ///< nothing more happens to the job unless somebody asks for it
  bool has_failed;            ///< it has ended by itself, and is not done
  std::string_view requests;  ///< the verbs of `shaken` that the page offers, with blanks between them
  std::string_view meaning;
};

// clang-format off
/// In the order of JobState. Whoever asks for the jobs of one state after the other misses none that goes on meanwhile,
/// but for one that goes back to the queue.
inline constexpr std::array<JobStateRow, 8> kJobStates{{
    {JobState::kQueued,    "queued",    false, false, false, "hold cancel",   "It waits for its turn."},
    {JobState::kHeld,      "held",      false, false, false, "resume cancel", "It waits to be resumed, or for room."},
    {JobState::kRunning,   "running",   true,  false, false, "hold cancel",   "A worker, or a cluster, has it."},
    {JobState::kStopping,  "stopping",  true,  false, false, "",              "Its worker saves a checkpoint."},
    {JobState::kDone,      "done",      false, true,  false, "",              "Its run came to its end."},
    {JobState::kFailed,    "failed",    false, true,  true,  "retry",         "It came to nothing, as `reason` says."},
    {JobState::kTimedOut,  "timed out", false, true,  true,  "retry",         "Its time limit is used up."},
    {JobState::kCancelled, "cancelled", false, true,  false, "retry",         "On request, or it was cleaned."},
}};
// clang-format on

constexpr const JobStateRow& row_of(JobState state) { return kJobStates[static_cast<std::size_t>(state)]; }
constexpr std::string_view to_word(JobState state) { return row_of(state).word; }
constexpr bool has_worker(JobState state) { return row_of(state).has_worker; }
constexpr bool has_ended(JobState state) { return row_of(state).has_ended; }
constexpr bool has_failed(JobState state) { return row_of(state).has_failed; }
constexpr bool is_waiting(JobState state) { return !has_ended(state) && !has_worker(state); }
constexpr bool came_to_nothing(JobState state) { return has_ended(state) && state != JobState::kDone; }
/// Whether the job will end if nobody does anything.
constexpr bool is_on_its_way(JobState state) { return !has_ended(state) && state != JobState::kHeld; }

/// The states that are so, as in states_that(has_ended).
inline std::vector<JobState> states_that(bool (*are_so)(JobState)) {
  std::vector<JobState> states;
  for (const JobStateRow& row : kJobStates) {
    if (are_so(row.state)) states.push_back(row.state);
  }
  return states;
}
/// Their words.
inline std::vector<std::string> words_of(bool (*states)(JobState)) {
  std::vector<std::string> words;
  for (const JobState state : states_that(states)) words.emplace_back(to_word(state));
  return words;
}

constexpr std::optional<JobState> job_state(std::string_view word) {
  for (const JobStateRow& row : kJobStates) {
    if (row.word == word) return row.state;
  }
  return std::nullopt;
}
/// The same of a word that a daemon has sent; one that is not known has no worker.
constexpr bool has_worker(std::string_view word) { return has_worker(job_state(word).value_or(JobState::kQueued)); }

}  // namespace shaken
