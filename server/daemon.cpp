#include "server/daemon.h"

#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "base/failure.h"
#include "base/files.h"
#include "base/http/http_server.h"
#include "base/memory_reserve.h"
#include "base/process.h"
#include "base/slurm_conf.h"
#include "base/standard_streams.h"
#include "proto/relay/relay.h"
#include "run/files/directory.h"
#include "run/files/version.h"
#include "server/api.h"
#include "server/cleaning.h"
#include "server/daemon_info.h"
#include "server/local_executor.h"
#include "server/queue/queue.h"
#include "server/slurm/slurm_executor.h"
#include "server/status_publisher.h"
#include "server/submission.h"
#include "server/supervisor.h"
#include "server/web_program.h"

namespace shaken::server {
namespace {

using std::chrono::milliseconds;

/// Longest time in which a change in the queue is not seen; the end of a worker is seen at once.
constexpr milliseconds kRound{100};
/// For open connections at the end. Everything is on the disk by then.
constexpr milliseconds kLastAnswers{2000};
/// For a queue that cannot be written to let itself be written after all.
constexpr milliseconds kLastWrites{2000};
/// Slurm bounds what runs there, and its queue what is handed over.
constexpr int kManyTasks = 1'000'000;
/// As long as Slurm may take to hand on a request to stop.
constexpr milliseconds kGraceInSlurm{300'000};
constexpr std::size_t kLogBytes = std::size_t{10} << 20;
constexpr std::size_t kOldLogs = 2;

/// The signals that the main thread waits for; blocked in every thread.
class Signals {
 public:
  Signals() {
    sigemptyset(&set_);
    for (const int signal : {SIGTERM, SIGINT, SIGCHLD}) sigaddset(&set_, signal);
    struct sigaction hang_up {};
    sigaction(SIGHUP, nullptr, &hang_up);
    if (hang_up.sa_handler != SIG_IGN) sigaddset(&set_, SIGHUP);  // nohup asks to outlive the terminal
    pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
  }
  /// Waits for the end of a child, for a request to end, or for the timeout. True if the daemon is to end.
  bool wait(milliseconds timeout) const {
    const timespec time{timeout.count() / 1000, (timeout.count() % 1000) * 1'000'000};
    const int signal = sigtimedwait(&set_, nullptr, &time);
    return signal == SIGTERM || signal == SIGINT || signal == SIGHUP;
  }

 private:
  sigset_t set_{};
};

std::string host_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

/// Why the daemon cannot start in its root, with a remedy where one is known.
Failure cannot_start(const std::string& reason) {
  const bool is_fixed = reason.find(std::strerror(EROFS)) != std::string::npos;
  return {ExitCode::kFailed, reason + (means_no_room(reason) ? "; make room there, or choose another --root"
                                       : is_fixed            ? "; choose a --root that can be written"
                                                             : "")};
}

void make_private_directory(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw cannot_start("cannot make " + directory.string() + ": " + error.message());
  std::filesystem::permissions(directory, std::filesystem::perms::owner_all, error);
  if (error) throw cannot_start("cannot protect " + directory.string() + ": " + error.message());
}

std::filesystem::path log_file(const DaemonConfig& config) { return config.root / "shakend.log"; }

void start_log(const DaemonConfig& config) {
  const auto to_file =
      std::make_shared<spdlog::sinks::rotating_file_sink_mt>(log_file(config).string(), kLogBytes, kOldLogs);
  const auto logger = std::make_shared<spdlog::logger>("shakend", to_file);
  if (!config.quiet) logger->sinks().push_back(std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %l: %v");
  logger->set_level(spdlog::level::from_str(config.log_level));
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(logger);
}

std::vector<std::string> lcm_options(const std::string& url) {
  return url.empty() ? std::vector<std::string>{"--no-lcm"} : std::vector<std::string>{"--lcm-url", url};
}

std::vector<std::string> worker_options(const DaemonConfig& config, const std::string& lcm_url) {
  std::vector<std::string> options{"--threads", std::to_string(config.threads)};
  for (const std::string& word : lcm_options(lcm_url)) options.push_back(word);
  return options;
}

/// Where workers in Slurm send live state. Multicast from a node would reach nobody, and a tcpq address that nobody has
/// asked for may be one of this machine only: it stays where it arises, unless the user says where over TCP it is to
/// go.
std::string lcm_url_in_slurm(const DaemonConfig& config) {
  return config.lcm_url_is_asked_for && config.lcm_url.starts_with("tcpq://") ? config.lcm_url : "";
}

slurm::SlurmOptions slurm_options(const DaemonConfig& config, const std::filesystem::path& root) {
  slurm::SlurmOptions options;
  options.folder = root / "slurm";
  options.worker = config.worker;
  options.task = sibling_program("shaken-task");
  options.threads = config.threads;
  options.max_pending = config.max_pending;
  options.runs_per_task = config.runs_per_task;
  options.options = config.slurm_options;
  options.poll = config.slurm_poll;
  return options;
}

/// How the page of this daemon is started.
std::vector<std::string> web_command(const DaemonConfig& config, const std::filesystem::path& root) {
  std::vector<std::string> command{sibling_program("shaken-web").string(), "--root", root.string(), "--port",
                                   std::to_string(*config.web_port)};
  for (const std::string& word : lcm_options(config.lcm_url)) command.push_back(word);
  return command;
}

/// Listens for requests, anew if somebody removes or replaces the socket file, or if the system ends the listening: an
/// accept() that fails for want of memory or descriptors does.
class ControlSocket {
 public:
  ControlSocket(std::filesystem::path file, http::HttpServer::Handler handler)
      : file_(std::move(file)),
        handler_(std::move(handler)),
        server_(std::make_unique<http::HttpServer>(file_, handler_)) {}

  void check() {
    std::erase_if(former_, [](const auto& server) { return server->ended_within(milliseconds(0)); });
    const bool has_failed = server_ && server_->has_failed();
    if (server_ && server_->is_reachable() && !has_failed) return;
    if (server_) {
      spdlog::warn("{} {}: listening anew", file_.string(), has_failed ? "failed" : "was removed or replaced");
      server_->close();
      former_.push_back(std::move(server_));  // which may have to answer still
    }
    try {
      server_ = std::make_unique<http::HttpServer>(file_, handler_);
      last_failure_.clear();
    } catch (const std::exception& failure) {  // the folder is gone, too, or there is no thread; it may come back
      if (std::exchange(last_failure_, failure.what()) != failure.what()) spdlog::error("{}", failure.what());
    }
  }
  void close() {
    if (server_) server_->close();
  }
  /// After close(): whether every connection has ended within the time.
  bool ended_within(milliseconds timeout) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    const auto ended = [end](const auto& server) {
      const auto left = std::chrono::duration_cast<milliseconds>(end - std::chrono::steady_clock::now());
      return server->ended_within(std::max(left, milliseconds(0)));
    };
    return (!server_ || ended(server_)) && std::all_of(former_.begin(), former_.end(), ended);
  }

 private:
  std::filesystem::path file_;
  http::HttpServer::Handler handler_;
  std::unique_ptr<http::HttpServer> server_;
  std::vector<std::unique_ptr<http::HttpServer>> former_;
  std::string last_failure_;
};

/// The relay that the user asked for. What the daemon's own multicast carries goes through it too; where multicast
/// cannot start, and is only what is used if nothing is said, everybody's live state goes by way of the relay:
/// `config.lcm_url` is then its address. Throws Failure if it cannot listen.
std::unique_ptr<relay::Relay> start_relay(DaemonConfig& config) {
  std::unique_ptr<proto::Bus> bridged;
  // Only multicast: a tcpq address may be this relay's own, or another's that hands on what it gets from here.
  const bool is_multicast = config.lcm_url.starts_with("udpm://");
  if (is_multicast) {
    if (auto opened = proto::Bus::open(config.lcm_url)) bridged = std::move(opened).value();
  }
  const bool goes_by_relay = is_multicast && !bridged && !config.lcm_url_is_asked_for;
  auto relay = value_or_fail(relay::Relay::start(*config.relay, std::move(bridged)));
  if (goes_by_relay) {
    config.lcm_url = relay->address().url();
    spdlog::info("there is no multicast here: live state goes to {}", config.lcm_url);
  }
  return relay;
}

/// Does a part of each round. What it throws is logged, at most once a second, and the next round tries again: whatever
/// the system refuses for a moment, a daemon goes on.
class KeptGoing {
 public:
  template <class Part>
  void operator()(const char* name, const Part& part) {
    try {
      part();
    } catch (const std::exception& problem) {
      const auto now = std::chrono::steady_clock::now();
      if (now < next_word_) return;
      next_word_ = now + std::chrono::seconds(1);
      spdlog::error("{}: {}", name, problem.what());
    }
  }

 private:
  std::chrono::steady_clock::time_point next_word_{};
};

/// Waits until every worker has ended, or until a second signal has killed them. A queue that cannot take their ends
/// does not keep the daemon up: the next one finds out anew.
void stop_workers(Supervisor& supervisor, const Signals& signals) {
  KeptGoing keep_going;
  const auto step = [&] { keep_going("stopping", [&] { supervisor.step(); }); };
  supervisor.shut_down();
  step();
  std::optional<std::chrono::steady_clock::time_point> give_up;
  while (!supervisor.idle()) {
    if (supervisor.all_ended()) {
      const auto now = std::chrono::steady_clock::now();
      if (!give_up) give_up = now + kLastWrites;
      if (now >= *give_up) {
        spdlog::error("the queue cannot be written: how the workers ended, the next daemon will find out");
        return;
      }
    }
    if (signals.wait(kRound)) {
      spdlog::warn("second signal: killing the workers");
      supervisor.kill_all();
    }
    step();
  }
}

}  // namespace

void run_daemon(const DaemonConfig& asked_for) {
  forget_slurm_filters();
  DaemonConfig config = asked_for;
  if (access(config.worker.c_str(), X_OK) != 0) {
    throw Failure(ExitCode::kFailed, "there is no worker program at " + config.worker.string() +
                                         "; build or install it, or name it with --worker");
  }
  umask(0077);
  DaemonInfo info;
  info.root = std::filesystem::absolute(config.root).lexically_normal();
  make_private_directory(info.root);
  const std::filesystem::path lock_file = info.root / "shakend.lock";
  const auto lock = run::DirectoryLock::acquire(lock_file);
  if (!lock && run::DirectoryLock::is_held(lock_file)) {
    throw Failure(ExitCode::kFailed, "another shakend is at work: " + lock.error().message);
  }
  if (!lock) throw cannot_start(lock.error().message);
  make_private_directory(info.runs());
  start_log(config);
  const Signals signals;

  const std::unique_ptr<Queue> opened_queue = [&] {
    try {
      return std::make_unique<Queue>(info.root / "queue.db");
    } catch (const StorageError& problem) {
      throw cannot_start(problem.what());
    }
  }();
  Queue& queue = *opened_queue;
  const FileAsOpened queue_file(info.root / "queue.db"), lock_as_opened(lock_file);
  for (const std::string& id : queue.recover()) spdlog::info("job {}: was running when the daemon ended", id);

  if (queue.counts().total() == 0) {
    if (const std::size_t n = run_ids(info.runs()).size(); n > 0) {
      spdlog::warn(
          "{} is empty, but there are {} runs in {}: they are not lost. Submit their scenes again: what is done is "
          "found, and the rest goes on; or put a copy of the queue back. `shaken clean --dry-run` lists them",
          (info.root / "queue.db").string(), n, info.runs().string());
    }
  }

  info.version = run::version();
  info.host = host_name();
  info.pid = getpid();
  info.slots = config.slots;
  std::unique_ptr<relay::Relay> relay;
  if (config.relay) {
    relay = start_relay(config);
    info.relay_url = relay->address().url();
    spdlog::info("LCM messages are handed on at {}", relay->address().text());
  }
  info.lcm_url = config.lcm_url;
  std::unique_ptr<proto::Bus> bus;
  if (config.lcm_url.empty()) {
    info.lcm_message = "switched off by --no-lcm";
  } else if (auto opened = proto::Bus::open(config.lcm_url)) {
    info.lcm_ok = true;
    bus = std::move(opened).value();
  } else {
    info.lcm_message = opened.error().message;
    spdlog::warn("no live state: {}", info.lcm_message);
  }

  make_private_directory(info.root / "slurm");
  LocalExecutor executor(config.worker);
  SupervisorOptions options{info.runs(), config.slots, worker_options(config, config.lcm_url), config.grace};
  options.refuse = refuse_scene;
  options.least_room = static_cast<std::int64_t>(config.keep_free);
  SupervisorOptions in_slurm = options;
  in_slurm.slots = kManyTasks;
  in_slurm.worker_options = worker_options(config, lcm_url_in_slurm(config));
  in_slurm.grace = kGraceInSlurm;
  in_slurm.role = {std::string(kSlurm), config.slurm_is_default};
  options.role.is_default = !config.slurm_is_default;
  Supervisor supervisor(queue, executor, std::move(options));
  slurm::SlurmExecutor slurm_executor(slurm_options(config, info.root));
  Supervisor slurm_supervisor(queue, slurm_executor, std::move(in_slurm));
  slurm_supervisor.adopt();
  std::optional<StatusPublisher> publisher;
  KeptGoing keep_going;
  if (bus) keep_going("no live state", [&] { publisher.emplace(queue, std::move(bus), info); });
  const Api api(queue, info);
  ControlSocket control(info.socket(), [&api](const http::Request& request) { return api.handle(request); });

  spdlog::info("shakend {} ready: {} (pid {}), {} slots", info.version, info.root.string(), info.pid, info.slots);
  std::printf("shakend ready: %s (pid %d)%s\n", info.root.c_str(), info.pid,
              config.quiet ? (", log in " + log_file(config).string()).c_str() : "");
  // it goes on without whoever was to read that line
  if (const auto told = flush_standard_output(); !told) spdlog::warn("{}", told.error().message);

  std::optional<WebProgram> web;
  if (config.web_port) web.emplace(web_command(config, info.root));

  std::string lost;
  do {
    keep_going("runs", [&] { supervisor.step(); });
    keep_going("runs in Slurm", [&] { slurm_supervisor.step(); });
    keep_going("requests", [&] { control.check(); });
    if (web) keep_going("the page", [&] { web->check(); });
    for (const FileAsOpened* file : {&queue_file, &lock_as_opened}) {
      if (lost.empty() && file->is_gone()) lost = file->path().string() + " was removed or replaced";
    }
    keep_memory_in_reserve();
  } while (lost.empty() && !signals.wait(kRound));

  if (!lost.empty()) {
    lost += ": this daemon ends, and nothing is acknowledged any more";
    spdlog::error("{}", lost);
    queue.close(lost);
  }
  spdlog::info("stopping: workers write a checkpoint");
  if (web) web->request_stop();
  control.close();
  stop_workers(supervisor, signals);
  publisher.reset();
  web.reset();
  spdlog::info("stopped");
  if (!control.ended_within(kLastAnswers)) {
    // A client that keeps its connection busy must not keep the daemon up.
    spdlog::shutdown();
    std::_Exit(lost.empty() ? EXIT_SUCCESS : EXIT_FAILURE);
  }
  if (!lost.empty()) throw Failure(ExitCode::kFailed, lost);
}

}  // namespace shaken::server
