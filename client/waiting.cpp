#include "client/waiting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/interrupt.h"
#include "base/progress_line.h"
#include "base/text.h"

namespace shaken::client {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kDaemonMayBeAway{10};

/// Every job once, by id: targets may overlap.
std::map<std::string, Json> jobs_of_all(const std::vector<Target>& targets) {
  std::map<std::string, Json> jobs;
  for (const Target& target : targets) {
    for (const Json& job : jobs_of(target)) jobs[job.at("id").get<std::string>()] = job;
  }
  return jobs;
}

/// Time to the end as the daemon sees it: the slowest target's.
double eta_of(const std::vector<Target>& targets) {
  double eta = -1;
  for (const Target& target : targets) {
    eta = std::max(eta,
                   target.is_sweep ? target.answer.at("sweep").value("eta_s", -1.0) : job_eta(target.answer.at("job")));
  }
  return eta;
}

/// What changes sooner is on its way.
constexpr std::chrono::seconds kStands{3};
constexpr std::chrono::minutes kIsOver{1};

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

std::string without_numbers(const std::string& text) {
  std::string rest;
  for (const char c : text) {
    if (!is_digit(c)) {
      rest += c;
    } else if (rest.empty() || rest.back() != '#') {
      rest += '#';
    }
  }
  return rest;
}

}  // namespace

std::vector<std::string> WaitingReasons::news(const std::vector<Json>& jobs, Clock::time_point now) {
  struct Group {
    std::string text;
    int n = 0;
  };
  std::map<std::string, Group> groups;
  for (const Json& job : jobs) {
    const std::string state = text_of(job, "state"), reason = text_of(job, "reason");
    if (reason.empty() || has_ended(job)) continue;
    const std::string text = (state == "running" ? "handed over" : state) + ": " + reason;
    Group& group = groups[without_numbers(text)];
    if (group.n++ == 0) group.text = text;
  }
  std::erase_if(seen_, [&](const auto& entry) { return now - entry.second.last >= kIsOver; });
  std::vector<std::string> lines;
  for (const auto& [key, group] : groups) {
    Reason& reason = seen_.try_emplace(key, Reason{now, now}).first->second;
    reason.last = now;
    if (reason.shown || now - reason.first < kStands) continue;
    reason.shown = true;
    lines.push_back(fmt::format("{} job{} {}", group.n, group.n == 1 ? "" : "s", group.text));
  }
  return lines;
}

ExitCode wait_for(ApiClient& session, std::vector<Target> targets, std::optional<double> timeout_s, Console& console) {
  if (targets.empty()) {
    console.err << "no job is queued or running\n";
    return ExitCode::kOk;
  }
  const InterruptGuard guard;
  const Clock::time_point start = Clock::now();
  Clock::time_point last_answer = start;
  ProgressLine progress(console.err, console.err_is_terminal, console.width, 0);
  WaitingReasons reasons;

  for (;;) {
    const auto jobs = jobs_of_all(targets);
    int n_done = 0;
    int n_ended = 0;
    double fraction = 0;
    for (const auto& [id, job] : jobs) {
      n_done += text_of(job, "state") == "done";
      n_ended += has_ended(job);
      fraction += job_fraction(job) / static_cast<double>(jobs.size());
    }
    const int n_jobs = static_cast<int>(jobs.size());
    progress.show(progress_text(fraction, fmt::format("{}/{} jobs", n_ended, n_jobs), eta_of(targets)));

    if (n_ended == n_jobs) {
      progress.clear();
      for (const auto& [id, job] : jobs) {
        const std::string state = text_of(job, "state");
        if (state == "done") continue;
        const std::string reason = text_of(job, "reason"), label = text_of(job, "label");
        console.err << fmt::format("{} {}{}{}\n", short_id(id), state, reason.empty() ? "" : ": " + reason,
                                   label.empty() ? "" : " (" + label + ")");
      }
      return n_done == n_jobs ? ExitCode::kOk : ExitCode::kFailed;
    }
    std::vector<Json> all;
    all.reserve(jobs.size());
    for (const auto& [id, job] : jobs) all.push_back(job);
    for (const std::string& line : reasons.news(all)) progress.end_with(line);
    const double elapsed = std::chrono::duration<double>(Clock::now() - start).count();
    if (guard.interrupted() || (timeout_s && elapsed >= *timeout_s)) {
      progress.clear();
      console.err << fmt::format("{}: {} of {} jobs have not ended; they go on\n",
                                 guard.interrupted() ? "interrupted" : "time is up", n_jobs - n_ended, n_jobs);
      return guard.interrupted() ? ExitCode::kInterrupted : ExitCode::kFailed;
    }

    const double left = timeout_s ? std::max(0.0, *timeout_s - elapsed) : 1.0;
    guard.sleep_for(std::chrono::milliseconds(static_cast<int>(1000 * std::min(0.5, left))));
    try {
      for (Target& target : targets) refresh(session, target);
      last_answer = Clock::now();
    } catch (const Failure& failure) {
      if (failure.code != ExitCode::kNoDaemon || Clock::now() - last_answer > kDaemonMayBeAway) {
        progress.clear();
        throw;
      }
    }
  }
}

}  // namespace shaken::client
