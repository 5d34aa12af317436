#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <set>

#include "base/clock.h"
#include "base/steadiness.h"
#include "base/table.h"
#include "base/text.h"
#include "client/live/target.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

using Align = Table::Align;

/// Columns of a sweep's name in the list of sweeps: one long name would move all others apart.
constexpr std::size_t kLongestName = 40;

Colour colour_of(std::string_view word) {
  const JobState state = job_state(word).value_or(JobState::kQueued);
  if (has_failed(state)) return Colour::kRed;
  if (state == JobState::kQueued) return Colour::kDim;
  if (state == JobState::kRunning) return Colour::kBlue;
  return state == JobState::kDone ? Colour::kGreen : Colour::kYellow;
}

/// Time to the end and when that is; empty if it is not known.
std::string eta_text(double seconds) {
  return seconds >= 0 ? fmt::format("{} ({})", duration_text(seconds), clock_text(seconds, utime_now())) : "";
}

std::string sweep_eta_text(const Json& sweep) {
  return sweep.at("n_ended") < sweep.at("n_jobs") ? eta_text(sweep.value("eta_s", -1.0)) : "";
}

/// The terms of a sweep: how many of it run at once, what it comes after, its stop rule; empty where there are none.
std::string terms_text(const Json& sweep) {
  std::vector<std::string> parts;
  if (const int n = number_of(sweep, "at_most"); n > 0) parts.push_back(fmt::format("at most {} at once", n));
  if (const auto after = sweep.find("after"); after != sweep.end() && !after->empty()) {
    std::string names;
    for (const Json& name : *after) {
      names += (names.empty() ? "after " : ", ") + printable(name.is_string() ? name.get<std::string>() : "?");
    }
    parts.push_back(names);
  }
  if (const std::string rule = text_of(sweep, "stop_if"); !rule.empty()) {
    parts.push_back(fmt::format("{} if {}", sweep.value("stopped", false) ? "stopped" : "stops", rule));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

/// How long the job will take still, or how long its attempts took together.
std::string time_text(const Json& job) {
  if (has_ended(job)) {
    // Counted by a clock that nobody sets; more than the time from the first start to the end would tell.
    const double wall = job.value("wall_s", 0.0);
    return wall > 0 ? "took " + duration_text(wall) : "";
  }
  const std::string eta = eta_text(job_eta(job));
  return eta.empty() ? "" : "ETA " + eta;
}

class Status : public Verb {
 public:
  VerbInfo info() const override {
    return {"status", kControlGroup, "Sweeps and jobs: states, progress, time to the end",
            "  shaken status                 all sweeps\n"
            "  shaken status s3              the jobs of sweep s3\n"
            "  shaken status 1f0c            one job, by the beginning of its id\n"
            "  shaken status s3 --failed     what failed, why, and where its log is\n"
            "  shaken status --json | jq .   for programs"};
  }

  void declare(Arguments& arguments) override {
    arguments.optional("ID", id_, "A sweep (id or name) or a job; all sweeps if left out", Names::kId);
    arguments.flag("--failed", failed_, "Only jobs that failed or were timed out, with the reason and the log's path");
    arguments.flag("--json", json_, "Print the daemon's answer as JSON");
  }

  ExitCode run(const Context& context) override {
    ApiClient session(context.root());
    if (failed_) return show_failed(session, context.console);
    if (id_.empty()) return show_sweeps(session, context.console);
    const Target target = find_target(session, id_);
    if (json_) {
      context.console.out << json_text(target.answer);
    } else if (target.is_sweep) {
      show_jobs(target, context.console);
    } else {
      show_job(target.answer.at("job"), context.console);
    }
    return ExitCode::kOk;
  }

 private:
  /// Where live state is handed on, if that is another place.
  static std::string also_at(const Json& status, const Json& lcm) {
    const std::string relay = text_of(status, "relay");
    return relay.empty() || relay == text_of(lcm, "url") ? "" : " and " + relay;
  }

  ExitCode show_sweeps(ApiClient& session, Console& console) const {
    const Json status = session.get("/v1/status");
    const Json answer = session.get("/v1/sweeps");
    if (json_) {
      console.out << json_text(Json{{"status", status}, {"sweeps", answer.at("sweeps")}});
      return ExitCode::kOk;
    }
    const Json& lcm = status.at("lcm");
    const bool lcm_ok = lcm.value("ok", false);
    console.out << fmt::format("shakend {} on {}, pid {}, up {}; {} slots; live state {}\n", text_of(status, "version"),
                               text_of(status, "host"), status.value("pid", 0),
                               duration_text(status.value("uptime_s", 0.0)), status.value("slots", 0),
                               lcm_ok ? "on " + text_of(lcm, "url") + also_at(status, lcm)
                                      : console.painted(Colour::kYellow, "off: " + text_of(lcm, "message")));
    if (answer.at("sweeps").empty()) {
      console.out << "No sweeps yet: `shaken submit FILE` makes one.\n";
      return ExitCode::kOk;
    }
    Table table({{"SWEEP"}, {"NAME"}, {"JOBS", Align::kRight}, {"PROGRESS"}, {"STATES"}, {"ETA"}});
    for (const Json& sweep : answer.at("sweeps")) {
      const double progress = sweep.value("progress", 0.0);
      const Json& counts = sweep.at("counts");
      const Colour colour = count_of(counts, has_failed) > 0 ? Colour::kRed : Colour::kPlain;
      table.add_row(
          {sweep.at("id").get<std::string>(), fitted(text_of(sweep, "name"), kLongestName),
           std::to_string(sweep.value("n_jobs", 0)),
           fmt::format("{} {:3.0f} %", console.painted(Colour::kBlue, bar_text(progress, 12)), 100 * progress),
           console.painted(colour, counts_text(counts)), sweep_eta_text(sweep)});
    }
    console.out << table.text(console.width);
    return ExitCode::kOk;
  }

  static void show_jobs(const Target& target, Console& console) {
    const Json& sweep = target.answer.at("sweep");
    const double progress = sweep.value("progress", 0.0);
    const std::string eta = sweep_eta_text(sweep);
    console.out << fmt::format("{}: {}\n{} {:3.0f} %{}{}\n", console.painted(Colour::kBold, target.title()),
                               counts_text(sweep.at("counts")), console.painted(Colour::kBlue, bar_text(progress, 24)),
                               100 * progress, eta.empty() ? "" : "  ETA ", eta);
    if (const std::string terms = terms_text(sweep); !terms.empty()) console.out << terms << '\n';
    Table table({{"JOB"}, {"STATE"}, {"DONE", Align::kRight}, {"S", Align::kRight}, {"TIME"}, {"POINT"}});
    std::set<Steadiness> met;
    for (const Json& job : jobs_of(target)) {
      const std::optional<MeanOrder> mean = mean_order(job);
      if (mean) met.insert(mean->steadiness);
      const std::string state = text_of(job, "state");
      const std::string reason = text_of(job, "reason");
      table.add_row({short_id(job.at("id").get<std::string>()), console.painted(colour_of(state), state),
                     fmt::format("{:.0f} %", 100 * job_fraction(job)),
                     mean              ? mark_of(mean->steadiness) + number_text(mean->value)
                     : state == "done" ? "-"
                                       : number_text(progress_number(job, "order_running_mean")),
                     time_text(job),
                     text_of(job, "label") + (reason.empty() ? "" : "  " + console.painted(Colour::kDim, reason))});
    }
    console.out << table.text(console.width);
    for (const Steadiness of : {Steadiness::kRelaxing, Steadiness::kNotKnown}) {
      if (met.contains(of)) console.out << mark_of(of) << " " << meaning_of(of) << "\n";
    }
  }

  static void show_job(const Json& job, Console& console) {
    const std::string state = text_of(job, "state");
    const auto line = [&](const char* title, const std::string& text) {
      if (!text.empty()) console.out << fmt::format("{:<12}{}\n", title, text);
    };
    line("job", job.at("id").get<std::string>());
    line("sweep", text_of(job, "sweep"));
    line("point", text_of(job, "label"));
    line("state", console.painted(colour_of(state), state));
    line("reason", text_of(job, "reason"));
    line("attempt", std::to_string(job.value("attempt", 0)));
    line("limits", limits_text(job));
    line("directory", text_of(job, "directory"));
    if (const double total = progress_number(job, "sim_time_total_s"); total > 0) {
      line("progress",
           fmt::format("{} {:.1f} %, {} of {} simulated",
                       console.painted(Colour::kBlue, bar_text(job_fraction(job), 24)), 100 * job_fraction(job),
                       duration_text(progress_number(job, "sim_time_s")), duration_text(total)));
      line("rods", number_text(progress_number(job, "n_rods")));
      if (!std::isnan(progress_number(job, "order")))
        line("order S", fmt::format("{} (running mean {})", number_text(progress_number(job, "order")),
                                    number_text(progress_number(job, "order_running_mean"))));
      line("overlap", number_text(progress_number(job, "max_overlap_mm")) + " mm at most");
    }
    if (const std::optional<MeanOrder> mean = mean_order(job)) {
      line("mean S",
           fmt::format("{}{} ({})", mark_of(mean->steadiness), number_text(mean->value), word_of(mean->steadiness)));
    }
    line("time", time_text(job));
  }

  ExitCode show_failed(ApiClient& session, Console& console) const {
    std::vector<Json> failed;
    for (const std::string& state : words_of(has_failed)) {
      const Json answer = id_.empty() ? session.get("/v1/jobs?state=" + url_encoded(state)) : Json();
      const std::vector<Json> jobs = id_.empty() ? std::vector<Json>(answer.at("jobs").begin(), answer.at("jobs").end())
                                                 : jobs_of(find_target(session, id_));
      for (const Json& job : jobs) {
        if (text_of(job, "state") == state) failed.push_back(job);
      }
    }
    if (json_) {
      console.out << json_text(Json{{"jobs", failed}});
      return ExitCode::kOk;
    }
    if (failed.empty()) console.out << "No failed jobs.\n";
    for (const Json& job : failed) {
      console.out << fmt::format("{}  {}  attempt {}\n  {}\n  log: {}/worker.log\n",
                                 console.painted(Colour::kRed, job.at("id").get<std::string>()), text_of(job, "label"),
                                 job.value("attempt", 0), text_of(job, "reason"), text_of(job, "directory"));
    }
    return ExitCode::kOk;
  }

  std::string id_;
  bool failed_ = false;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_status() { return std::make_unique<Status>(); }

}  // namespace shaken::client
