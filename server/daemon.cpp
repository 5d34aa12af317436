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
#include <span>
#include <utility>
#include <vector>

#include "base/failure.h"
#include "base/files.h"
#include "base/http/http_server.h"
#include "base/memory.h"
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

/// Where workers in Slurm send live state. Multicast from a node would reach nobody, and a tcpq address that nobody has
/// asked for may be one of this machine only: it stays where it arises, unless the user says where over TCP it is to
/// go.
std::string lcm_url_in_slurm(const DaemonConfig& config) {
  return config.lcm_url_is_asked_for && config.lcm_url.starts_with("tcpq://") ? config.lcm_url : "";
}

/// The options for runs on this machine, or for those in Slurm.
SupervisorOptions supervisor_options(const DaemonConfig& config, const DaemonInfo& info, bool in_slurm) {
  SupervisorOptions options{info.runs(), in_slurm ? kManyTasks : config.slots,
                            lcm_options(in_slurm ? lcm_url_in_slurm(config) : config.lcm_url),
                            in_slurm ? kGraceInSlurm : config.grace};
  options.worker_options.insert(options.worker_options.begin(), {"--threads", std::to_string(config.threads)});
  options.refuse = refuse_scene;
  options.least_room = static_cast<std::int64_t>(config.keep_free);
  if (in_slurm) options.role.name = kSlurm;
  options.role.is_default = in_slurm == config.slurm_is_default;
  return options;
}

slurm::SlurmOptions slurm_options(const DaemonConfig& config, const DaemonInfo& info) {
  return {.folder = info.root / "slurm",
          .worker = config.worker,
          .task = sibling_program("shaken-task"),
          .threads = config.threads,
          .max_pending = config.max_pending,
          .runs_per_task = config.runs_per_task,
          .options = config.slurm_options,
          .poll = config.slurm_poll};
}

/// How the page of this daemon is started.
std::vector<std::string> web_command(const DaemonConfig& config, const DaemonInfo& info) {
  std::vector<std::string> command = lcm_options(config.lcm_url);
  command.insert(command.begin(), {sibling_program("shaken-web").string(), "--root", info.root.string(), "--port",
                                   std::to_string(*config.web_port)});
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
    if (server_)
      spdlog::warn("{} {}: listening anew", file_.string(), has_failed ? "failed" : "was removed or replaced");
    close();
    try {
      server_ = std::make_unique<http::HttpServer>(file_, handler_);
      last_failure_.clear();
    } catch (const std::exception& failure) {  // the folder is gone, too, or there is no thread; it may come back
      if (std::exchange(last_failure_, failure.what()) != failure.what()) spdlog::error("{}", failure.what());
    }
  }
  void close() {
    if (!server_) return;
    server_->close();
    former_.push_back(std::move(server_));  // which may have to answer still
  }
  /// After close(): whether every connection has ended within the time.
  bool ended_within(milliseconds timeout) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    return std::ranges::all_of(former_, [end](const auto& server) {
      const auto left = std::chrono::duration_cast<milliseconds>(end - std::chrono::steady_clock::now());
      return server->ended_within(std::max(left, milliseconds(0)));
    });
  }

 private:
  std::filesystem::path file_;
  http::HttpServer::Handler handler_;
  std::unique_ptr<http::HttpServer> server_;
  std::vector<std::unique_ptr<http::HttpServer>> former_;
  std::string last_failure_;
};

/// The relay that the user asked for, if any. What the daemon's own multicast carries goes through it too; where
/// multicast cannot start, and is only what is used if nothing is said, everybody's live state goes by way of the
/// relay: `config.lcm_url` is then its address. Throws Failure if it cannot listen.
std::unique_ptr<relay::Relay> start_relay(DaemonConfig& config, DaemonInfo& info) {
  if (!config.relay) return nullptr;
  std::unique_ptr<proto::Bus> bridged;
  // Only multicast: a tcpq address may be this relay's own, or another's that hands on what it gets from here.
  const bool is_multicast = config.lcm_url.starts_with("udpm://");
  if (is_multicast) {
    if (auto opened = proto::Bus::open(config.lcm_url)) bridged = std::move(opened).value();
  }
  const bool goes_by_relay = is_multicast && !bridged && !config.lcm_url_is_asked_for;
  auto relay = value_or_fail(relay::Relay::start(*config.relay, std::move(bridged)));
  info.relay_url = relay->address().url();
  if (goes_by_relay) {
    config.lcm_url = info.relay_url;
    spdlog::info("there is no multicast here: live state goes to {}", config.lcm_url);
  }
  spdlog::info("LCM messages are handed on at {}", relay->address().text());
  return relay;
}

/// The bus of the live state; null where there is none, and `info` says why.
std::unique_ptr<proto::Bus> open_bus(const DaemonConfig& config, DaemonInfo& info) {
  info.lcm_url = config.lcm_url;
  auto opened = config.lcm_url.empty() ? Error{"switched off by --no-lcm"} : proto::Bus::open(config.lcm_url);
  info.lcm_ok = static_cast<bool>(opened);
  if (opened) return std::move(opened).value();
  info.lcm_message = opened.error().message;
  if (!config.lcm_url.empty()) spdlog::warn("no live state: {}", info.lcm_message);
  return nullptr;
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

/// The lock that makes this the only daemon of its root, whose folders are there afterwards.
run::DirectoryLock take_root(const DaemonInfo& info) {
  make_private_directory(info.root);
  auto lock = run::DirectoryLock::acquire(info.lock());
  if (!lock && run::DirectoryLock::is_held(info.lock())) {
    throw Failure(ExitCode::kFailed, "another shakend is at work: " + lock.error().message);
  }
  if (!lock) throw cannot_start(lock.error().message);
  for (const auto& folder : {info.runs(), info.root / "slurm"}) make_private_directory(folder);
  return std::move(lock).value();
}

std::unique_ptr<Queue> open_queue(const DaemonInfo& info) {
  try {
    return std::make_unique<Queue>(info.queue());
  } catch (const StorageError& problem) {
    throw cannot_start(problem.what());
  }
}

/// Takes over what a former daemon has left.
void recover(Queue& queue, const DaemonInfo& info) {
  for (const std::string& id : queue.recover()) spdlog::info("job {}: was running when the daemon ended", id);
  if (queue.counts().total() > 0) return;
  if (const std::size_t n = run_ids(info.runs()).size(); n > 0) {
    spdlog::warn(
        "{} is empty, but there are {} runs in {}: they are not lost. Submit their scenes again: what is done is "
        "found, and the rest goes on; or put a copy of the queue back. `shaken clean --dry-run` lists them",
        info.queue().string(), n, info.runs().string());
  }
}

/// All that the daemon does while it is up: runs here and in Slurm, live state, requests, the page.
class Services {
 public:
  Services(const DaemonConfig& config, const DaemonInfo& info, Queue& queue, std::unique_ptr<proto::Bus> bus)
      : executor_(config.worker),
        supervisor_(queue, executor_, supervisor_options(config, info, false)),
        slurm_executor_(slurm_options(config, info)),
        slurm_supervisor_(queue, slurm_executor_, supervisor_options(config, info, true)),
        api_(queue, info) {
    slurm_supervisor_.adopt();
    if (bus) keep_going_("no live state", [&] { publisher_.emplace(queue, std::move(bus), info); });
    control_.emplace(info.socket(), [this](const http::Request& request) { return api_.handle(request); });
    if (config.web_port) web_.emplace(web_command(config, info));
  }

  void step() {
    keep_going_("runs", [&] { supervisor_.step(); });
    keep_going_("runs in Slurm", [&] { slurm_supervisor_.step(); });
    keep_going_("requests", [&] { control_->check(); });
    if (web_) keep_going_("the page", [&] { web_->check(); });
  }

  /// Whether every connection has ended, too.
  bool stop(const Signals& signals) {
    spdlog::info("stopping: workers write a checkpoint");
    if (web_) web_->request_stop();
    control_->close();
    stop_workers(supervisor_, signals);
    publisher_.reset();
    web_.reset();
    spdlog::info("stopped");
    return control_->ended_within(kLastAnswers);
  }

 private:
  KeptGoing keep_going_;
  LocalExecutor executor_;
  Supervisor supervisor_;
  slurm::SlurmExecutor slurm_executor_;
  Supervisor slurm_supervisor_;
  std::optional<StatusPublisher> publisher_;
  Api api_;
  std::optional<ControlSocket> control_;
  std::optional<WebProgram> web_;
};

void say_ready(const DaemonConfig& config, const DaemonInfo& info) {
  spdlog::info("shakend {} ready: {} (pid {}), {} slots", info.version, info.root.string(), info.pid, info.slots);
  std::printf("shakend ready: %s (pid %d)%s\n", info.root.c_str(), info.pid,
              config.quiet ? (", log in " + log_file(config).string()).c_str() : "");
  // it goes on without whoever was to read that line
  if (const auto told = flush_standard_output(); !told) spdlog::warn("{}", told.error().message);
}

/// Until a signal asks for the end, or one of the files is gone without which nothing can be acknowledged: then why.
std::string serve(Services& services, std::span<const FileAsOpened> files, const Signals& signals) {
  do {
    services.step();
    for (const FileAsOpened& file : files) {
      if (!file.is_gone()) continue;
      return file.path().string() + " was removed or replaced: this daemon ends, and nothing is acknowledged any more";
    }
    keep_memory_in_reserve();
  } while (!signals.wait(kRound));
  return "";
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
  info.version = run::version();
  info.host = host_name();
  info.pid = getpid();
  info.root = std::filesystem::absolute(config.root).lexically_normal();
  info.slots = config.slots;
  const run::DirectoryLock lock = take_root(info);
  start_log(config);
  const Signals signals;

  const std::unique_ptr<Queue> queue = open_queue(info);
  const std::array files{FileAsOpened(info.queue()), FileAsOpened(info.lock())};
  recover(*queue, info);

  const std::unique_ptr<relay::Relay> relay = start_relay(config, info);
  Services services(config, info, *queue, open_bus(config, info));
  say_ready(config, info);

  const std::string lost = serve(services, files, signals);
  if (!lost.empty()) {
    spdlog::error("{}", lost);
    queue->close(lost);
  }
  if (!services.stop(signals)) {
    // A client that keeps its connection busy must not keep the daemon up.
    spdlog::shutdown();
    std::_Exit(lost.empty() ? EXIT_SUCCESS : EXIT_FAILURE);
  }
  if (!lost.empty()) throw Failure(ExitCode::kFailed, lost);
}

}  // namespace shaken::server
