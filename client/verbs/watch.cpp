// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>

#include "base/interrupt.h"
#include "client/live.h"
#include "client/target.h"
#include "client/verbs/verbs.h"
#include "client/watch_view.h"
#include "proto/bus.h"

namespace shaken::client {
namespace {

using Clock = std::chrono::steady_clock;
using OpenedBus = Result<std::unique_ptr<proto::Bus>>;

/// Shows screens on a terminal's second page and gives the first one back when it goes.
class ScreenPage {
 public:
  explicit ScreenPage(Console& console) : console_(console) {
    if (console_.interactive) console_.out << "\x1b[?1049h\x1b[?25l" << std::flush;
  }
  ScreenPage(const ScreenPage&) = delete;
  ScreenPage& operator=(const ScreenPage&) = delete;
  ~ScreenPage() {
    if (console_.interactive) console_.out << "\x1b[?25h\x1b[?1049l" << std::flush;
  }
  void show(const std::vector<std::string>& lines) {
    console_.out << "\x1b[H";
    for (std::size_t i = 0; i < lines.size(); ++i) console_.out << (i > 0 ? "\r\n" : "") << lines[i] << "\x1b[K";
    console_.out << "\x1b[J" << std::flush;
  }

 private:
  Console& console_;
};

class Watch : public Verb {
 public:
  VerbInfo info() const override {
    return {"watch", kControlGroup, "Live: S(t), progress, collisions, defects, time to the end",
            "  shaken watch                  all that is queued or runs, of any sweep; else the newest sweep\n"
            "  shaken watch 1f0c             one job\n"
            "  shaken watch s3 --for 60      leaves after a minute; the jobs go on\n"
            "  shaken watch s3 | tee log     a line per second and job, where stdout is no terminal\n"
            "  shaken watch --every 60 > log a line per minute"};
  }

  void declare(Arguments& arguments) override {
    arguments.optional("ID", id_, "A sweep (id or name) or a job; all that runs if left out", Names::kId);
    arguments.option("--for", seconds_, "SECONDS", "Leave after this time");
    arguments.option("--every", every_, "SECONDS", "Between lines, where stdout is no terminal; 1 if left out");
    arguments.option("--lcm-url", lcm_url_, "URL", "The bus; the daemon's if left out");
  }

  ExitCode run(const Context& context) override {
    Console& console = context.console;
    if (every_ && !(*every_ > 0 && *every_ < 86400)) {
      throw Failure(ExitCode::kBadInput, "--every takes seconds between 0 and 86400");
    }
    ApiClient session(context.root());
    std::vector<Target> targets;
    if (!id_.empty()) {
      targets.push_back(find_target(session, id_));
    } else {
      add_unfinished_sweeps(session, targets);
      if (targets.empty()) targets.push_back(find_target_or_newest(session, ""));
    }
    LiveJobs jobs;
    note(targets, jobs);

    bool state_has_changed = false;  // as a message has it
    const OpenedBus bus = open_bus(session);
    if (bus) {
      bus.value()->subscribe<job_t>(
          proto::kJobChannel, [&](const job_t& message) { state_has_changed |= jobs.contradicts(message); }, 100);
      bus.value()->subscribe<observables_t>(
          proto::kObservablesChannel, [&jobs](const observables_t& message) { jobs.note(message); }, 500);
      bus.value()->subscribe<defects_t>(
          proto::kDefectsChannel, [&jobs](const defects_t& message) { jobs.note(message); }, 100);
    }

    if (!bus && !console.interactive) console.err << source_note(jobs, bus, {}) << "\n";
    const InterruptGuard guard;
    {
      ScreenPage page(console);
      follow(session, targets, jobs, bus, state_has_changed, guard, page, console);
    }
    for (const LiveJob& job : jobs.jobs()) console.out << watch_line(job) << "\n";
    return guard.interrupted() ? ExitCode::kInterrupted : ExitCode::kOk;
  }

 private:
  /// Adds the sweeps that have a job to be waited for and are not among `targets` yet, in the order submitted.
  static void add_unfinished_sweeps(ApiClient& session, std::vector<Target>& targets) {
    const Json answer = session.get("/v1/sweeps");
    for (const Json& sweep : answer.at("sweeps")) {
      const std::string id = sweep.at("id").get<std::string>();
      const Json& counts = sweep.at("counts");
      if (counts.value("queued", 0) + counts.value("running", 0) + counts.value("stopping", 0) == 0) continue;
      const bool is_known =
          std::any_of(targets.begin(), targets.end(), [&](const Target& t) { return t.sweep_id() == id; });
      if (!is_known) targets.push_back(find_target(session, id));
    }
  }

  static void note(const std::vector<Target>& targets, LiveJobs& jobs) {
    for (const Target& target : targets) {
      for (const Json& job : jobs_of(target)) jobs.note_api(job);
    }
  }

  static std::string title_of(const std::vector<Target>& targets) {
    if (targets.size() == 1) return targets.front().title();
    return fmt::format("{} sweeps", targets.size());
  }

  OpenedBus open_bus(ApiClient& session) const {
    std::string url = lcm_url_;
    if (url.empty()) {
      const Json lcm = session.get("/v1/status").at("lcm");
      if (!lcm.value("ok", false)) return Error{text_of(lcm, "message")};
      url = text_of(lcm, "url");
    }
    return proto::Bus::open(url);
  }

  /// Until the jobs have ended, the time is over, Ctrl-C, or nobody reads any more.
  void follow(ApiClient& session, std::vector<Target>& targets, LiveJobs& jobs, const OpenedBus& bus,
              bool& state_has_changed, const InterruptGuard& guard, ScreenPage& page, Console& console) const {
    static constexpr std::chrono::seconds kAskEvery{1};
    static constexpr std::chrono::milliseconds kAskAtMostEvery{200};
    static constexpr std::chrono::seconds kDaemonMayBeAway{10};
    const auto redraw_every =
        std::chrono::milliseconds(console.interactive ? 200 : static_cast<std::int64_t>(1000 * every_.value_or(1.0)));
    const Clock::time_point start = Clock::now();
    Clock::time_point last_answer = start;
    Clock::time_point last_question = start;
    Clock::time_point next_drawing = start;
    std::map<std::string, std::string> shown_state;

    for (;;) {
      const Clock::time_point now = Clock::now();
      if (now >= last_question + (state_has_changed ? kAskAtMostEvery : kAskEvery)) {
        last_question = now;
        state_has_changed = false;
        try {
          for (Target& target : targets) refresh(session, target);
          if (id_.empty()) add_unfinished_sweeps(session, targets);
          note(targets, jobs);
          last_answer = now;
        } catch (const Failure& failure) {
          if (failure.code != ExitCode::kNoDaemon || now - last_answer > kDaemonMayBeAway) throw;
        }
      }
      const bool over = jobs.all_ended() || guard.interrupted() || !console.out.good() ||
                        (seconds_ && std::chrono::duration<double>(now - start).count() >= *seconds_);
      if (now >= next_drawing || over) {
        next_drawing = now + redraw_every;
        if (console.interactive) {
          console.refresh_size();
          page.show(watch_screen(jobs, title_of(targets), source_note(jobs, bus, now - start), console));
        } else if (!over) {
          for (const LiveJob& job : jobs.jobs()) {
            // Jobs that wait or have ended are worth a line when that changes.
            std::string& shown = shown_state[job.id];
            if (job.is_running() || shown != job.state) console.out << watch_line(job) << "\n";
            shown = job.state;
          }
          console.out << std::flush;
        }
      }
      if (over) return;
      if (bus) {
        bus.value()->handle(50);
      } else {
        guard.sleep_for(std::chrono::milliseconds(50));
      }
    }
  }

  static std::string source_note(const LiveJobs& jobs, const OpenedBus& bus, Clock::duration watched) {
    if (!bus)
      return fmt::format("no live state ({}): asking the daemon once a second. Ctrl-C leaves", bus.error().message);
    const std::int64_t n = jobs.received();
    if (n == 0 && watched > std::chrono::seconds(3)) {
      return fmt::format("nothing heard on {} (has the scene a \"stream\" block?): asking the daemon. Ctrl-C leaves",
                         bus.value()->url());
    }
    return fmt::format("live over LCM: {} messages, {} lost. Ctrl-C leaves", n, jobs.lost());
  }

  std::string id_;
  std::optional<double> seconds_;
  std::optional<double> every_;
  std::string lcm_url_;
};

}  // namespace

std::unique_ptr<Verb> make_watch() { return std::make_unique<Watch>(); }

}  // namespace shaken::client
