#include <fmt/format.h>

#include <array>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "base/clock.h"
#include "base/interrupt.h"
#include "base/progress_line.h"
#include "base/text.h"
#include "client/live/target.h"
#include "client/verbs/verbs.h"
#include "proto/bus.h"
#include "proto/codec.h"
#include "proto/log_file.h"

namespace shaken::client {
namespace {

using Clock = std::chrono::steady_clock;

/// Bytes from "500MB", "2 GB" or "64000"; a kB has 1000. `option` is named in the message. Throws Failure (kBadInput)
/// for anything else, and unless it is at least one byte.
std::int64_t size_option(const std::string& option, const std::string& text) {
  constexpr std::array<std::pair<std::string_view, double>, 6> kUnits{
      {{"", 1}, {"B", 1}, {"kB", 1e3}, {"MB", 1e6}, {"GB", 1e9}, {"TB", 1e12}}};
  constexpr double kMost = 1e18;
  double number = 0;
  const char* const text_end = text.data() + text.size();
  const auto [number_end, problem] = std::from_chars(text.data(), text_end, number, std::chars_format::fixed);
  std::string_view unit(number_end, static_cast<std::size_t>(text_end - number_end));
  if (unit.starts_with(' ')) unit.remove_prefix(1);
  for (const auto& [name, bytes] : kUnits) {
    if (problem == std::errc() && unit == name && number * bytes >= 1 && number * bytes <= kMost) {
      return static_cast<std::int64_t>(number * bytes);
    }
  }
  throw Failure(ExitCode::kBadInput,
                fmt::format("{}: '{}' is no size (write 500MB, 2GB or 64000)", option, printable(text)));
}

class Record : public Verb {
 public:
  VerbInfo info() const override {
    return {"record", kControlGroup, "Live state as an LCM log, which lcm-logplayer plays too",
            "  shaken record -o night.lcmlog                 all that is live, until Ctrl-C\n"
            "  shaken record 1f0c                            one job, until it ends, into 1f0c.lcmlog\n"
            "  shaken record s3 --for 10min --size 500MB -o s3.lcmlog\n"
            "  shaken record --lcm-url tcpq://127.0.0.1:7700 -o far.lcmlog    another daemon's, by its relay\n"
            "  shaken replay-log run.lcmlog                  sends it anew"};
  }

  void declare(Arguments& arguments) override {
    arguments.list("JOB", ids_, "Sweeps or jobs; everything that is live if left out", Names::kId, 0);
    arguments.option("-o,--out", out_, "FILE", "The log to write; JOB.lcmlog or live.lcmlog if left out", Names::kFile);
    arguments.option("--for", for_, "TIME", "Ends after this time, e.g. 10min");
    arguments.option("--size", size_, "SIZE", "Ends before the file is larger; 10GB if left out");
    arguments.option("--lcm-url", lcm_url_, "URL", "The bus; the daemon's if left out");
    arguments.flag("--force", force_, "Replace a file that exists");
  }

  ExitCode run(const Context& context) override {
    read_options();
    // Only a named bus and no named job need no daemon.
    std::optional<ApiClient> session;
    if (lcm_url_.empty() || !ids_.empty()) session.emplace(context.root());
    std::vector<Target> targets;
    targets.reserve(ids_.size());
    for (const std::string& id : ids_) targets.push_back(find_target(*session, id));
    note_jobs(targets);
    const std::unique_ptr<proto::Bus> bus = open_bus(session);

    proto::LogWriter log = value_or_fail(proto::LogWriter::create(out_));
    std::optional<Error> failure;
    bool is_full = false;
    bus->subscribe_raw(
        "SHAKEN_.*",
        [&](std::string_view channel, std::span<const std::uint8_t> payload) {
          if (failure || is_full || !is_wanted(channel, payload)) return;
          is_full = log.bytes() + proto::LogWriter::size_of(channel, payload) > most_bytes_;
          if (is_full) return;
          if (const auto written = log.write(utime_now(), channel, payload); !written) failure = written.error();
        },
        kQueue);

    const InterruptGuard guard;
    const Clock::time_point start = Clock::now();
    std::optional<Clock::time_point> end;  // once the jobs have ended
    Clock::time_point next_question = start + kAskEvery;
    const char* reason = nullptr;
    {
      ProgressLine progress("recording");
      while (reason == nullptr) {
        bus->handle(kLongestWait);
        const Clock::time_point now = Clock::now();
        if (!targets.empty() && !end && now >= next_question) {
          next_question = now + kAskEvery;
          for (Target& target : targets) refresh(*session, target);
          if (note_jobs(targets)) end = now + kLastMessages;
        }
        const double seconds = std::chrono::duration<double>(now - start).count();
        if (failure)
          reason = "the disk takes no more";
        else if (is_full)
          reason = "the log has its size";
        else if (guard.interrupted())
          reason = "interrupted";
        else if (most_seconds_ && seconds >= *most_seconds_)
          reason = "the time is over";
        else if (end && now >= *end)
          reason = "the jobs have ended";
        progress.show(fmt::format("recording for {}: {}", duration_text(seconds), content_of(log)));
      }
    }
    if (!failure) done_or_fail(log.finish());
    context.console.err << fmt::format("{}: {}; {}\n", reason, printable(out_), content_of(log));
    if (n_refused_ > 0) {
      context.console.err << fmt::format("{} messages were left out: they are not what their channel says\n",
                                         n_refused_);
    }
    if (failure) throw Failure(ExitCode::kFailed, failure->message + "; what came before is kept");
    return guard.interrupted() ? ExitCode::kInterrupted : ExitCode::kOk;
  }

 private:
  static constexpr int kQueue = 10'000;
  static constexpr int kLongestWait = 50;  // [ms]
  static constexpr std::chrono::seconds kAskEvery{1};
  static constexpr std::chrono::milliseconds kLastMessages{1500};

  static std::string content_of(const proto::LogWriter& log) {
    return fmt::format("{} messages, {}", log.messages(), bytes_text(static_cast<double>(log.bytes())));
  }

  void read_options() {
    if (!for_.empty()) most_seconds_ = duration_option("--for", for_);
    if (!size_.empty()) most_bytes_ = size_option("--size", size_);
    std::error_code ignored;
    if (out_.empty()) out_ = (ids_.size() == 1 ? ids_.front() : "live") + ".lcmlog";
    if (std::filesystem::is_directory(out_, ignored)) {
      throw Failure(ExitCode::kBadInput, fmt::format("{} is a folder: give a name in it", printable(out_)));
    }
    if (std::filesystem::exists(out_, ignored) && !force_) {
      throw Failure(ExitCode::kBadInput, fmt::format("{} exists: --force replaces it", printable(out_)));
    }
  }

  /// Adds the ids of the targets' jobs; whether all of these have ended.
  bool note_jobs(const std::vector<Target>& targets) {
    bool have_ended = true;
    for (const Target& target : targets) {
      for (const Json& job : jobs_of(target)) {
        jobs_.insert(job.at("id").get<std::string>());
        have_ended = have_ended && has_ended(job);
      }
    }
    return have_ended;
  }

  std::unique_ptr<proto::Bus> open_bus(std::optional<ApiClient>& session) const {
    if (!lcm_url_.empty()) return value_or_fail(proto::Bus::open(lcm_url_));
    const Json lcm = session->get("/v1/status").at("lcm");
    if (!lcm.value("ok", false))
      throw Failure(ExitCode::kFailed, "the daemon sends nothing: " + text_of(lcm, "message"));
    return value_or_fail(proto::Bus::open(text_of(lcm, "url")));
  }

  bool is_wanted(std::string_view channel, std::span<const std::uint8_t> payload) {
    const std::optional<std::string> job = proto::job_of(channel, payload);
    if (!job) ++n_refused_;
    return job && (jobs_.empty() || jobs_.contains(*job));
  }

  std::vector<std::string> ids_;
  std::string out_, for_, size_, lcm_url_;
  bool force_ = false;
  std::optional<double> most_seconds_;
  std::int64_t most_bytes_ = 10'000'000'000;
  std::set<std::string> jobs_;  ///< that are wanted; empty: all
  std::int64_t n_refused_ = 0;
};

}  // namespace

std::unique_ptr<Verb> make_record() { return std::make_unique<Record>(); }

}  // namespace shaken::client
