#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "base/interrupt.h"
#include "base/keys/units.h"
#include "base/progress_line.h"
#include "base/text.h"
#include "client/verbs/verbs.h"
#include "proto/bus.h"
#include "proto/log_file.h"

namespace shaken::client {
namespace {

using Clock = std::chrono::steady_clock;

class ReplayLog : public Verb {
 public:
  VerbInfo info() const override {
    return {"replay-log", kControlGroup, "Sends an LCM log anew, of `shaken record` or lcm-logger",
            "  shaken replay-log run.lcmlog                           as it was\n"
            "  shaken replay-log run.lcmlog --from 2min --to 3min --speed 4\n"
            "  shaken replay-log run.lcmlog --lcm-url tcpq://127.0.0.1:7700",
            kCommonExitCodes};
  }

  void declare(Arguments& arguments) override {
    arguments.required("LOG", file_, "An LCM log", Names::kFile);
    arguments.option("--from", from_, "TIME", "Begins this long after the log's beginning, e.g. 90s");
    arguments.option("--to", to_, "TIME", "Ends this long after the log's beginning");
    arguments.option("--speed", speed_, "X", "Times as fast as it was; 1 if left out");
    arguments.option("--lcm-url", lcm_url_, "URL", "The bus; $LCM_DEFAULT_URL, else multicast, if left out");
  }

  ExitCode run(const Context& context) override {
    read_options();
    proto::LogReader log = value_or_fail(proto::LogReader::open(file_));
    const auto bus = value_or_fail(proto::Bus::open(lcm_url_.empty() ? proto::default_url() : lcm_url_));
    if (!log.first_utime()) throw Failure(ExitCode::kFailed, fmt::format("{} has no messages", printable(file_)));
    const auto first = static_cast<double>(*log.first_utime());
    const auto seconds_of = [&](const proto::LoggedMessage& message) {
      return (static_cast<double>(message.utime) - first) / kMicroseconds;
    };

    const InterruptGuard guard;
    if (from_seconds_ > 0)
      must(log.skip_to(*log.first_utime() + static_cast<std::int64_t>(from_seconds_ * kMicroseconds)));
    const Clock::time_point start = Clock::now();
    {
      ProgressLine progress("replaying");
      while (!guard.interrupted()) {
        const std::optional<proto::LoggedMessage> message = must(log.next());
        if (!message) break;
        const double at = seconds_of(*message);
        if (to_seconds_ && at > *to_seconds_) break;
        // In steps, so that a gap of hours can be seen and left.
        const auto due = start + seconds_in_clock((at - from_seconds_) / speed());
        while (!guard.interrupted() && Clock::now() < due) {
          progress.show(fmt::format("replaying: {} of the log, {:.0f} % read, {} messages sent", duration_text(at),
                                    100 * log.fraction(), bus->counters().published));
          const auto left = std::chrono::ceil<std::chrono::milliseconds>(due - Clock::now());
          guard.sleep_for(std::clamp(left, std::chrono::milliseconds(0), kLongestSleep));
        }
        if (guard.interrupted()) break;
        bus->publish_bytes(message->channel.c_str(), message->payload);
      }
    }
    const proto::BusCounters& counters = bus->counters();
    context.console.err << fmt::format("{} messages sent on {}\n", counters.published, printable(bus->url()));
    if (log.is_cut()) context.console.err << "the log ends within a message, which was left out\n";
    if (counters.publish_failures > 0) {
      throw Failure(ExitCode::kFailed, fmt::format("{} messages could not be sent", counters.publish_failures));
    }
    return guard.interrupted() ? ExitCode::kInterrupted : ExitCode::kOk;
  }

 private:
  static constexpr double kMicroseconds = 1e6;
  static constexpr double kLongestTime = 1e9;  ///< [s]; a forged time may ask for more
  static constexpr std::chrono::milliseconds kLongestSleep{200};

  static Clock::duration seconds_in_clock(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(seconds, kLongestTime)));
  }
  double speed() const { return speed_.value_or(1); }

  template <class T>
  T must(Result<T> result) const {
    if (!result) throw Failure(ExitCode::kFailed, fmt::format("{}: {}", printable(file_), result.error().message));
    if constexpr (!std::is_void_v<T>) return std::move(result).value();
  }

  void read_options() {
    std::string problems;
    const auto time = [&](const char* option, const std::string& text) -> std::optional<double> {
      if (text.empty()) return std::nullopt;
      const auto value = keys::parse_quantity(text, keys::Dimension::kTime);
      if (value && *value >= 0 && *value <= kLongestTime) return *value;
      problems += fmt::format("{}: {}\n", option, value ? "takes a time from 0 to 30 years" : value.error().message);
      return std::nullopt;
    };
    from_seconds_ = time("--from", from_).value_or(0);
    to_seconds_ = time("--to", to_);
    if (to_seconds_ && *to_seconds_ < from_seconds_) problems += "--from is later than --to\n";
    if (!(speed() >= 1e-3 && speed() <= 1e3)) problems += "--speed takes a number from 0.001 to 1000\n";
    if (problems.empty()) return;
    problems.pop_back();
    throw Failure(ExitCode::kBadInput, problems);
  }

  std::string file_, from_, to_, lcm_url_;
  std::optional<double> speed_;
  double from_seconds_ = 0;
  std::optional<double> to_seconds_;
};

}  // namespace

std::unique_ptr<Verb> make_replay_log() { return std::make_unique<ReplayLog>(); }

}  // namespace shaken::client
