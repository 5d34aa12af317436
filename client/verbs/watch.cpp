#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <memory>

#include "base/interrupt.h"
#include "base/text.h"
#include "client/live/live.h"
#include "client/live/target.h"
#include "client/verbs/verbs.h"
#include "client/watch/live_screen.h"
#include "client/watch/overview.h"
#include "proto/bus.h"

namespace shaken::client {
namespace {

using Clock = std::chrono::steady_clock;
using OpenedBus = Result<std::unique_ptr<proto::Bus>>;

/// The examples of the help.
std::string examples_text() {
  std::string text =
      "  shaken watch                  all that is queued or runs, of any sweep; else the newest sweep\n"
      "  shaken watch 1f0c             one job\n"
      "  shaken watch s3 --for 1min    leaves after a minute; the jobs go on\n"
      "  shaken watch s3 | tee log     a line per second and job, where stdout is no terminal\n"
      "  shaken watch --every 1min > log   a line per minute\n"
      "  NO_COLOR=1 shaken watch       in dots, without colours\n"
      "\nKeys, on a terminal:";
  for (const char* line : kWatchKeys) text += std::string("\n  ") + line;
  return text;
}

class Watch : public Verb {
 public:
  VerbInfo info() const override {
    static const std::string examples = examples_text();
    return {"watch", kControlGroup, "Live: the rods themselves, S(t), progress, defects, time to the end",
            examples.c_str()};
  }

  void declare(Arguments& arguments) override {
    arguments.optional("ID", id_, "A sweep (id or name) or a job; all that runs if left out", Names::kId);
    arguments.option("--for", for_, "TIME", "Leave after this time");
    arguments.option("--every", every_, "TIME", "Between lines, where stdout is no terminal; 1 s if left out");
    arguments.option("--lcm-url", lcm_url_, "URL", "The bus; the daemon's if left out");
  }

  ExitCode run(const Context& context) override {
    Console& console = context.console;
    if (!every_.empty()) line_every_ = duration_option("--every", every_);
    if (!for_.empty()) longest_ = duration_option("--for", for_);
    ApiClient session(context.root());
    std::vector<Target> targets;
    if (!id_.empty()) {
      targets.push_back(find_target(session, id_));
    } else {
      add_unfinished_sweeps(session, targets);
      if (targets.empty()) targets.push_back(newest_sweep(session));
    }
    LiveJobs jobs;
    note(targets, jobs);

    const InterruptGuard guard;
    bool state_has_changed = false;  // as a message has it
    const OpenedBus bus = open_bus(session);
    if (!bus && !console.interactive) console.err << source_note(jobs, bus, {}) << "\n";
    {
      std::optional<LiveScreen> screen;
      if (console.interactive) {
        console.out.flush();
        const ColourDepth depth = console.colour ? colour_depth(std::getenv) : ColourDepth::kNone;
        screen.emplace(ScreenSettings{.depth = depth, .is_remote = std::getenv("SSH_CONNECTION") != nullptr});
      }
      if (bus) listen(*bus.value(), jobs, screen ? &screen->rods() : nullptr, state_has_changed);
      follow(session, targets, jobs, bus, state_has_changed, guard, screen ? &*screen : nullptr, console);
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
      if (count_of(sweep.at("counts"), is_on_its_way) == 0) continue;
      const bool is_known =
          std::any_of(targets.begin(), targets.end(), [&](const Target& t) { return t.sweep_id() == id; });
      if (!is_known) targets.push_back(find_target(session, id));
    }
  }

  static Target newest_sweep(ApiClient& session) {
    const Json answer = session.get("/v1/sweeps");
    const Json& sweeps = answer.at("sweeps");
    if (!sweeps.empty()) return find_target(session, sweeps.back().at("id").get<std::string>());
    throw Failure(ExitCode::kBadInput, "nothing has been submitted yet: `shaken submit FILE` does");
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

  /// What messages change. They are handed on as long as the bus is asked for them.
  static void listen(proto::Bus& bus, LiveJobs& jobs, LiveRods* rods, bool& state_has_changed) {
    const auto changes = [&](const job_t& message) { state_has_changed |= jobs.contradicts(message); };
    const auto note_job = [&jobs](const auto& message) { jobs.note(message); };
    const auto note_rods = [rods](const auto& message) { rods->note(message); };
    bus.subscribe<job_t>(proto::kJobChannel, changes, 100);
    bus.subscribe<observables_t>(proto::kObservablesChannel, note_job, 500);
    bus.subscribe<defects_t>(proto::kDefectsChannel, note_job, 100);
    if (rods == nullptr) return;
    bus.subscribe<frame_static_t>(proto::kFrameStaticChannel, note_rods, 100);
    bus.subscribe<posts_t>(proto::kPostsChannel, note_rods, 100);
    bus.subscribe<sizes_t>(proto::kSizesChannel, note_rods, 100);
    bus.subscribe<frame_t>(proto::kFrameChannel, note_rods, 500);
  }

  /// Until the jobs have ended, the time is over, a key or Ctrl-C, or nobody reads any more. `screen` is null where
  /// stdout is no terminal.
  void follow(ApiClient& session, std::vector<Target>& targets, LiveJobs& jobs, const OpenedBus& bus,
              bool& state_has_changed, const InterruptGuard& guard, LiveScreen* screen, Console& console) const {
    static constexpr std::chrono::seconds kAskEvery{1};
    static constexpr std::chrono::milliseconds kAskAtMostEvery{200};
    static constexpr std::chrono::seconds kDaemonMayBeAway{10};
    static constexpr std::chrono::milliseconds kLongestWait{50};
    static constexpr int kMostMessages = 1000;  // before the screen has its turn again
    const auto line_every = std::chrono::milliseconds(static_cast<std::int64_t>(1000 * line_every_));
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
      if (jobs.all_ended() || guard.interrupted() || !console.out.good() ||
          (screen != nullptr && screen->has_ended()) ||
          (longest_ && std::chrono::duration<double>(now - start).count() >= *longest_)) {
        return;
      }
      if (now >= next_drawing) {
        next_drawing = now + line_every;
        if (screen != nullptr) {
          console.refresh_size();
          next_drawing = now + screen->draw(jobs, title_of(targets), source_note(jobs, bus, now - start),
                                            {console.width, console.height});
        } else {
          put_lines(jobs, shown_state, console);
        }
      }
      if (screen != nullptr) {
        if (screen->wait(bus ? bus.value()->descriptor() : -1, kLongestWait, jobs)) next_drawing = now;
        for (int i = 0; bus && i < kMostMessages && bus.value()->handle(0); ++i) {
        }
      } else if (bus) {
        bus.value()->handle(static_cast<int>(kLongestWait.count()));
      } else {
        guard.sleep_for(kLongestWait);
      }
    }
  }

  /// A line for each job that runs; those that wait or have ended are worth one when that changes.
  static void put_lines(const LiveJobs& jobs, std::map<std::string, std::string>& shown_state, Console& console) {
    for (const LiveJob& job : jobs.jobs()) {
      std::string& shown = shown_state[job.id];
      if (job.is_running() || shown != job.state) console.out << watch_line(job) << "\n";
      shown = job.state;
    }
    console.out << std::flush;
  }

  static std::string source_note(const LiveJobs& jobs, const OpenedBus& bus, Clock::duration watched) {
    if (!bus) return fmt::format("no live state ({}): asking the daemon once a second", bus.error().message);
    const std::int64_t n = jobs.received();
    if (n == 0 && watched > std::chrono::seconds(3)) {
      return fmt::format("nothing heard on {} (has the scene a \"stream\" block?): asking the daemon",
                         bus.value()->url());
    }
    return fmt::format("live over LCM: {} messages, {} lost", n, jobs.lost());
  }

  std::string id_;
  std::string for_;
  std::string every_;
  std::optional<double> longest_;  ///< [s]
  double line_every_ = 1;          ///< [s]
  std::string lcm_url_;
};

}  // namespace

std::unique_ptr<Verb> make_watch() { return std::make_unique<Watch>(); }

}  // namespace shaken::client
