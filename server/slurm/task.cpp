#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "base/failure.h"
#include "base/program.h"
#include "base/standard_streams.h"
#include "base/text.h"
#include "run/files/directory.h"
#include "run/files/version.h"
#include "server/local_executor.h"
#include "server/slurm/batch.h"

namespace shaken::server::slurm {
namespace {

constexpr const char* kFooter =
    R"(Slurm starts it for shakend, as what a job array is made of; there is no need to start it by hand. It reads the
number of its task from SLURM_ARRAY_TASK_ID, does the runs that FOLDER/batch.json lists for it, and writes into
FOLDER/NUMBER.json how each of them ended. On SIGUSR1, which Slurm sends ahead of the end of its time, on SIGTERM, and
for a run that FOLDER/NUMBER.stop names, it lets the run that is at work write a checkpoint and end.

Exit codes: 0 every run has ended, or the time is over, 1 failed, 2 bad input, 143 the task was taken away.)";

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kLook{1000};         ///< from one look at what the daemon asks to the next
constexpr milliseconds kWordOfSlurm{5000};  ///< in which Slurm's signal arrives here, after it has stopped a worker
constexpr int kWritingTries = 60;
constexpr auto kStoppedCode = static_cast<int>(ExitCode::kStopped);

/// A number of the environment; `fallback` where there is none.
int variable(const char* name, int fallback) {
  const char* text = std::getenv(name);
  return text != nullptr ? number_in<int>(text).value_or(fallback) : fallback;
}

/// A task on a node of the cluster: starts its workers one after the other, hands on what Slurm and the daemon ask of
/// them, and writes down how they end. Blocks signals of this thread. Throws Failure if the batch has no such task or
/// has been withdrawn, or if the report cannot be written.
class Task {
 public:
  Task(BatchFolder folder, int number) : folder_(std::move(folder)), number_(number) {
    sigemptyset(&signals_);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGCHLD}) sigaddset(&signals_, signal);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    if (auto before = read_report(folder_.report(number))) report_ = std::move(*before);
    if (const char* job = std::getenv("SLURM_JOB_ID")) report_.slurm_job = job;
    report_.restarts = variable("SLURM_RESTART_COUNT", 0);
    std::array<char, 256> host{};
    gethostname(host.data(), host.size() - 1);
    report_.host = host.data();
  }

  ExitCode work() {
    const Batch batch = value_or_fail(read_batch(folder_));
    if (number_ < 0 || number_ >= static_cast<int>(batch.tasks.size())) {
      throw Failure(ExitCode::kBadInput, fmt::format("the batch has no task {}", number_));
    }
    write_down();
    LocalExecutor executor(batch.worker);
    const std::vector<Launch>& launches = batch.tasks[static_cast<std::size_t>(number_)];
    for (int place = 0; place < static_cast<int>(launches.size()); ++place) {
      if (report_.ends.contains(place)) continue;  // before the task was put back
      if (!std::filesystem::exists(folder_.plan())) throw Failure(ExitCode::kFailed, "the batch has been withdrawn");
      const auto end = run(executor, launches[static_cast<std::size_t>(place)], place);
      if (end) {
        report_.ends[place] = *end;
        write_down();
      }
      if (is_taken_) return ExitCode::kTerminated;
      if (time_is_over_) break;
    }
    return ExitCode::kOk;
  }

 private:
  /// How the worker ended; none if the task is taken from it.
  std::optional<WorkerEnd> run(LocalExecutor& executor, const Launch& launch, int place) {
    // A worker from before the task was put back may still be at it, on a node that Slurm has lost sight of. Whether
    // the directory can be locked at all is found by the worker, which says so.
    const run::RunDirectory directory{launch.directory};
    while (run::DirectoryLock::is_held(directory.lock())) {
      wait();
      if (is_taken_ || time_is_over_ || must_stop(place)) break;
    }
    if (is_taken_) return std::nullopt;
    if (time_is_over_ || must_stop(place)) return WorkerEnd{.exit_code = kStoppedCode};

    report_.begun.insert(place);
    write_down();
    const Result<int> pid = executor.start(launch);
    if (!pid) throw Failure(ExitCode::kFailed, pid.error().message);
    bool stop_asked = false;
    for (;;) {
      const WorkerReport report = executor.poll(*pid);
      if (report.phase == WorkerReport::Phase::kEnded) return judged(report.end, stop_asked);
      wait();
      if (is_taken_ || time_is_over_ || must_stop(place)) {
        if (!stop_asked) executor.stop(*pid);
        stop_asked = true;
      }
    }
  }

  /// A stop that nobody here has asked for was Slurm's, which has told the worker first.
  std::optional<WorkerEnd> judged(const WorkerEnd& end, bool stop_asked) {
    const bool is_stop = end.exit_code == kStoppedCode || end.signal == SIGTERM || end.signal == SIGKILL;
    for (const auto until = Clock::now() + kWordOfSlurm;
         is_stop && !stop_asked && !is_taken_ && Clock::now() < until;) {
      wait();
    }
    if (is_stop && is_taken_) return std::nullopt;
    return end;
  }

  /// Until a signal has arrived, or some time is over.
  void wait() {
    const timespec time{kLook.count() / 1000, (kLook.count() % 1000) * 1'000'000};
    const int signal = sigtimedwait(&signals_, nullptr, &time);
    if (signal == SIGTERM || signal == SIGINT || signal == SIGHUP) is_taken_ = true;
    if (signal == SIGUSR1) time_is_over_ = true;
  }

  bool must_stop(int place) const { return read_stop(folder_.stop(number_)).contains(place); }

  /// What is not written is lost; a full disk may have room again.
  void write_down() {
    Result<void> written = write_report(folder_.report(number_), report_);
    for (int tries = 0; !written && tries < kWritingTries; ++tries) {
      complain(written.error().message);
      std::this_thread::sleep_for(kLook);
      written = write_report(folder_.report(number_), report_);
    }
    done_or_fail(written);
  }

  BatchFolder folder_;
  int number_;
  TaskReport report_;
  sigset_t signals_{};
  bool is_taken_ = false;      ///< Slurm ends the task, or puts it back
  bool time_is_over_ = false;  ///< or will be soon
};

}  // namespace
}  // namespace shaken::server::slurm

int main(int argc, char** argv) {
  using namespace shaken::server::slurm;
  shaken::Program app("shaken-task", "Does one task of a batch of runs, one after the other, on a node of a cluster.",
                      kFooter);
  std::string folder;
  app.set_version_flag("--version", shaken::run::version());
  app.add_option("FOLDER", folder, "Of the batch, below slurm/ of the daemon's root")->type_name("DIR")->required();
  return app.run(argc, argv, [&] { return Task({folder}, variable("SLURM_ARRAY_TASK_ID", -1)).work(); });
}
