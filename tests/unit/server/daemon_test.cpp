// The program shakend, from start to end, with scripts for workers.
#include "server/daemon.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <signal.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "base/process.h"
#include "server/queue/sqlite.h"
#include "tests/support/lazy_server.h"
#include "tests/unit/server/server_support.h"

namespace shaken::server {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

/// One shakend in a directory of its own.
class Daemon {
 public:
  Daemon(const std::filesystem::path& root, const std::vector<std::string>& options) : root_(root) {
    int ends[2];
    EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
    out_ = ends[0];
    const std::string errors = root.string() + ".err";
    std::vector<std::string> words{SHAKEND, "--root", root.string()};
    words.insert(words.end(), options.begin(), options.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      dup2(ends[1], STDOUT_FILENO);
      dup2(open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
      execv(SHAKEND, arguments.data());
      _exit(127);
    }
    close(ends[1]);
  }
  ~Daemon() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(out_);
  }

  /// The first line of its output; empty if it ends without.
  std::string first_line() const {
    std::string line;
    for (char c = 0; read(out_, &c, 1) == 1 && c != '\n';) line += c;
    return line;
  }
  std::string errors() const { return read_text(root_.string() + ".err"); }
  void send(int signal) const { ::kill(pid_, signal); }
  /// Waits for its end; the exit code, or minus the signal that killed it.
  int wait() {
    int status = 0;
    EXPECT_TRUE(eventually([&] { return waitpid(pid_, &status, WNOHANG) == pid_; })) << errors();
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  int pid() const { return pid_; }

  json call(const std::string& path, const std::optional<json>& body = std::nullopt) const {
    httplib::Client client((root_ / "shakend.sock").string());
    client.set_address_family(AF_UNIX);
    const auto result = body ? client.Post(path, body->dump(), "application/json") : client.Get(path);
    return result ? json::parse(result->body) : json();
  }
  json job() const { return call("/v1/jobs").at("jobs").at(0); }

 private:
  std::filesystem::path root_;
  int out_ = -1;
  pid_t pid_ = -1;
};

class DaemonTest : public testing::Test {
 protected:
  ~DaemonTest() override { unsetenv("FAKE_WORKER"); }

  Daemon daemon(const std::vector<std::string>& more = {}) {
    std::vector<std::string> options{"--no-lcm", "--worker", worker_.string()};
    options.insert(options.end(), more.begin(), more.end());
    return {directory_ / "root", options};
  }
  static bool becomes(const Daemon& daemon, const std::string& state) {
    return eventually([&] { return daemon.job()["state"] == state; });
  }
  /// Whether the worker of a job listens to signals.
  static bool is_up(const json& job) {
    return job["pid"] != 0 && std::filesystem::exists(std::filesystem::path(job["directory"]) / "up");
  }
  /// Waits until that of the only job does; returns its pid.
  static int up(const Daemon& daemon) {
    EXPECT_TRUE(eventually([&] { return is_up(daemon.job()); })) << daemon.errors();
    return daemon.job()["pid"];
  }

  /// Submits a job, once the daemon is ready; returns the pid of its worker.
  static int run_one(const Daemon& daemon) {
    EXPECT_THAT(daemon.first_line(), StartsWith("shakend ready"));
    daemon.call("/v1/sweeps", json{{"text", "{}"}});
    return up(daemon);
  }

  ScratchFolder directory_;
  std::filesystem::path worker_ = write_fake_worker(directory_.path());
};

TEST_F(DaemonTest, RunsAJobAndStopsInOrder) {
  setenv("FAKE_WORKER", "done", 1);
  Daemon shakend = daemon();
  EXPECT_EQ(shakend.first_line(),
            "shakend ready: " + (directory_ / "root").string() + " (pid " + std::to_string(shakend.pid()) + ")");
  EXPECT_EQ(shakend.call("/v1/status")["pid"], shakend.pid());
  EXPECT_EQ(shakend.call("/v1/sweeps", json{{"text", "{}"}})["counts"]["new"], 1);
  EXPECT_TRUE(becomes(shakend, "done"));
  EXPECT_EQ(shakend.call("/v1/results")["rows"][0]["summary"]["n_rods"], 7);
  shakend.send(SIGTERM);
  EXPECT_EQ(shakend.wait(), 0);
  EXPECT_FALSE(std::filesystem::exists(directory_ / "root" / "shakend.sock"));
  EXPECT_EQ(read_text(directory_ / "root" / "shakend.log"), shakend.errors());
  EXPECT_EQ(std::filesystem::status(directory_ / "root").permissions(), std::filesystem::perms::owner_all);
}

TEST_F(DaemonTest, ASecondOneRefusesAndNamesTheFirst) {
  Daemon first = daemon();
  ASSERT_THAT(first.first_line(), StartsWith("shakend ready"));
  Daemon second = daemon();
  EXPECT_EQ(second.first_line(), "");
  EXPECT_EQ(second.wait(), 1);
  EXPECT_THAT(second.errors(), HasSubstr("process " + std::to_string(first.pid())));
  EXPECT_EQ(first.call("/v1/status")["pid"], first.pid()) << "the first one goes on";
}

TEST_F(DaemonTest, StoppingItStopsTheWorkersAndTheNextOneGoesOn) {
  setenv("FAKE_WORKER", "run", 1);
  {
    Daemon shakend = daemon();
    const int worker = run_one(shakend);
    shakend.send(SIGTERM);
    EXPECT_EQ(shakend.wait(), 0);
    EXPECT_NE(kill(worker, 0), 0);
  }
  setenv("FAKE_WORKER", "done", 1);
  Daemon next = daemon();
  next.first_line();
  EXPECT_TRUE(becomes(next, "done"));
  EXPECT_EQ(next.job()["attempt"], 2);
}

TEST_F(DaemonTest, AfterAKillTheNextOneStartsTheJobAgain) {
  setenv("FAKE_WORKER", "run", 1);
  int worker = 0;
  {
    Daemon shakend = daemon();
    worker = run_one(shakend);
    shakend.send(SIGKILL);
    EXPECT_EQ(shakend.wait(), -SIGKILL);
  }
  setenv("FAKE_WORKER", "done", 1);
  Daemon next = daemon();
  EXPECT_THAT(next.first_line(), StartsWith("shakend ready"));
  EXPECT_TRUE(becomes(next, "done"));
  EXPECT_EQ(next.job()["attempt"], 2);
  EXPECT_TRUE(eventually([&] { return kill(worker, 0) != 0; })) << "the old worker was told by the kernel";
}

TEST_F(DaemonTest, ASecondSignalKillsDeafWorkers) {
  setenv("FAKE_WORKER", "deaf", 1);
  Daemon shakend = daemon();
  const int worker = run_one(shakend);
  shakend.send(SIGINT);
  EXPECT_TRUE(eventually([&] { return shakend.errors().find("stopping") != std::string::npos; }));
  EXPECT_EQ(kill(worker, 0), 0);
  shakend.send(SIGINT);
  EXPECT_EQ(shakend.wait(), 0);
  EXPECT_NE(kill(worker, 0), 0);
}

// However many workers it has: the end of each is seen before that of the first is written.
TEST_F(DaemonTest, AQueueThatCannotBeWrittenDoesNotKeepItUp) {
  for (const int n_workers : {1, 2, 8}) {
    setenv("FAKE_WORKER", "run", 1);
    Daemon shakend = daemon({"--slots", std::to_string(n_workers)});
    shakend.first_line();
    for (int seed = 1; seed <= n_workers; ++seed)
      shakend.call("/v1/sweeps", json{{"text", R"({"time": {"seed": )" + std::to_string(seed) + "}}"}});
    json jobs;
    ASSERT_TRUE(eventually([&] {
      jobs = shakend.call("/v1/jobs").at("jobs");
      return std::count_if(jobs.begin(), jobs.end(), is_up) == n_workers;
    })) << shakend.errors();
    Database other(directory_ / "root" / "queue.db");
    other.execute("BEGIN IMMEDIATE");
    shakend.send(SIGTERM);
    EXPECT_EQ(shakend.wait(), 0) << n_workers;
    for (const json& job : jobs) EXPECT_NE(kill(job["pid"], 0), 0) << n_workers;
    EXPECT_THAT(shakend.errors(), HasSubstr("the next daemon will find out"));
    other.execute("ROLLBACK");
  }
  setenv("FAKE_WORKER", "done", 1);
  Daemon next = daemon();
  next.first_line();
  EXPECT_TRUE(becomes(next, "done"));
}

// Small supervisors and scripts do: the system then does not say how children end.
TEST_F(DaemonTest, AParentThatIgnoresTheEndsOfItsChildrenChangesNothing) {
  setenv("FAKE_WORKER", "done", 1);
  std::signal(SIGCHLD, SIG_IGN);
  Daemon shakend = daemon();
  std::signal(SIGCHLD, SIG_DFL);
  shakend.first_line();
  shakend.call("/v1/sweeps", json{{"text", "{}"}});
  EXPECT_TRUE(becomes(shakend, "done")) << shakend.errors();
  shakend.send(SIGTERM);
  EXPECT_EQ(shakend.wait(), 0);
}

// What would be written into a file that has no name any more would be acknowledged, and lost.
TEST_F(DaemonTest, AQueueOrALockThatGoesAwayEndsIt) {
  setenv("FAKE_WORKER", "run", 1);
  const auto root = directory_ / "root";
  const auto move = [](const auto& file) { std::filesystem::rename(file, file.string() + ".away"); };
  const std::vector<std::function<void()>> losses{[&] { std::filesystem::remove(root / "queue.db"); },
                                                  [&] { std::filesystem::remove(root / "shakend.lock"); },
                                                  [&] {
                                                    move(root / "queue.db");
                                                    write_text(root / "queue.db", "");
                                                  },
                                                  [&] { move(root); }};
  for (std::size_t k = 0; k < losses.size(); ++k) {
    Daemon shakend = daemon();
    const int worker = run_one(shakend);
    losses[k]();
    const json answer = shakend.call("/v1/sweeps", json{{"text", R"({"time": {"seed": 7}})"}});
    EXPECT_TRUE(k == 1 || !answer.contains("counts")) << answer;
    EXPECT_EQ(shakend.wait(), 1);
    EXPECT_THAT(shakend.errors(), HasSubstr(k == 1 ? "shakend.lock was removed or replaced" : "queue.db was removed"));
    EXPECT_NE(kill(worker, 0), 0);
    std::filesystem::remove_all(root);
  }
}

TEST_F(DaemonTest, AnAcceptThatFailsEndsNothing) {
  for (const int error : {ENFILE, ENOMEM, ECONNABORTED, EMFILE}) {
    setenv("LD_PRELOAD", SHAKEN_FAILING_CALLS, 1);
    setenv("SHAKEN_CALL_FAILS", ("accept:" + std::to_string(error) + ":1").c_str(), 1);
    Daemon shakend = daemon();
    unsetenv("LD_PRELOAD");
    unsetenv("SHAKEN_CALL_FAILS");
    shakend.first_line();
    EXPECT_TRUE(eventually([&] { return shakend.call("/v1/status")["pid"] == shakend.pid(); }))
        << std::strerror(error) << "\n"
        << shakend.errors();
    EXPECT_THAT(shakend.errors(), HasSubstr("fault met"));
    shakend.send(SIGTERM);
    EXPECT_EQ(shakend.wait(), 0);
  }
}

/// A daemon one of whose calls fails once, from when it works on.
class Afflicted {
 public:
  Afflicted(const std::string& call, int error, int n, int slots, const std::filesystem::path& folder,
            const std::string& worker)
      : n_jobs_(slots + 2),
        about_(call + " fails with " + std::strerror(error) + ", call " + std::to_string(n) + ", " +
               std::to_string(slots) + " slots") {
    std::filesystem::create_directories(folder);
    const std::filesystem::path begun = folder / "begun";
    const std::vector<std::pair<const char*, std::string>> orders{
        {"LD_PRELOAD", SHAKEN_FAILING_CALLS},
        {"SHAKEN_CALL_FAILS", call + ":" + std::to_string(error) + ":" + std::to_string(n)},
        {"SHAKEN_CALL_FAILS_IN", "shakend"},
        {"SHAKEN_CALL_FAILS_FROM", begun.string()}};
    for (const auto& [name, value] : orders) setenv(name, value.c_str(), 1);
    daemon_.emplace(folder / "root",
                    std::vector<std::string>{"--no-lcm", "--worker", worker, "--slots", std::to_string(slots)});
    for (const auto& [name, value] : orders) unsetenv(name);
    EXPECT_THAT(daemon_->first_line(), StartsWith("shakend ready")) << told();
    write_text(begun, "");
    // What is refused for that one call is asked again, as a user does.
    const json sweep{{"text", json{{"sweep", {{"replicas", n_jobs_}}}}.dump()}};
    EXPECT_TRUE(eventually([&] { return daemon_->call("/v1/sweeps", sweep).contains("counts"); })) << told();
  }
  /// All its jobs are done, and it ends when it is asked to.
  void survives() {
    EXPECT_TRUE(eventually([&] { return n_done() == n_jobs_; })) << n_done() << " of " << n_jobs_ << ": " << told();
    daemon_->send(SIGTERM);
    EXPECT_EQ(daemon_->wait(), 0) << told();
  }
  bool has_met_it() const { return daemon_->errors().find("fault met") != std::string::npos; }

 private:
  int n_done() const {
    const json status = daemon_->call("/v1/status");
    return status.contains("jobs") ? status["jobs"].value("done", 0) : 0;
  }
  std::string told() const { return about_ + "\n" + daemon_->errors(); }

  int n_jobs_;
  std::string about_;
  std::optional<Daemon> daemon_;
};

// Disks, limits and signals make calls fail once that did well before and do well afterwards.
TEST_F(DaemonTest, NoCallThatFailsOnceEndsItOrLosesAJob) {
  setenv("FAKE_WORKER", "done", 1);
  const std::map<std::string, std::vector<int>> errors{{"open", {EMFILE, ENFILE, ENOMEM, ESTALE, EINTR}},
                                                       {"write", {EIO, ENOSPC, EINTR}},
                                                       {"fsync", {EIO, ENOSPC}},
                                                       {"poll", {ENOMEM, EINTR}}};
  int k = 0, n_met = 0;
  for (const auto& [call, reasons] : errors) {
    int n = 0;
    for (const int error : reasons) {
      ++n;  // which call it is
      std::vector<std::unique_ptr<Afflicted>> daemons;
      for (const int slots : {1, 2, 8}) {
        const std::filesystem::path folder = directory_ / std::to_string(++k);
        daemons.push_back(std::make_unique<Afflicted>(call, error, n, slots, folder, worker_.string()));
      }
      for (const auto& daemon : daemons) daemon->survives();
      for (const auto& daemon : daemons) n_met += daemon->has_met_it() ? 1 : 0;
    }
  }
  EXPECT_EQ(n_met, k) << "faults that were met";
}

TEST_F(DaemonTest, WhatStandsInThePlaceOfItsSocketForAWhileEndsNothing) {
  Daemon shakend = daemon();
  shakend.first_line();
  const std::filesystem::path socket = directory_ / "root" / "shakend.sock";
  std::filesystem::create_directories(directory_ / "other");
  write_text(directory_ / "other" / "file", "");
  ASSERT_TRUE(eventually([&] {  // again, where the daemon was faster and listens anew
    std::error_code taken;
    std::filesystem::remove(socket);
    std::filesystem::rename(directory_ / "other", socket, taken);
    return !taken;
  }));
  EXPECT_TRUE(eventually([&] { return shakend.errors().find("cannot remove") != std::string::npos; }));
  std::filesystem::remove_all(socket);
  EXPECT_TRUE(eventually([&] { return shakend.call("/v1/status")["pid"] == shakend.pid(); })) << shakend.errors();
  shakend.send(SIGTERM);
  EXPECT_EQ(shakend.wait(), 0);
}

TEST_F(DaemonTest, TheEndOfItsTerminalStopsItUnlessUnderNohup) {
  Daemon shakend = daemon();
  shakend.first_line();
  shakend.send(SIGHUP);
  EXPECT_EQ(shakend.wait(), 0);

  setenv("FAKE_WORKER", "done", 1);
  signal(SIGHUP, SIG_IGN);
  Daemon under_nohup = daemon();
  signal(SIGHUP, SIG_DFL);
  under_nohup.first_line();
  under_nohup.send(SIGHUP);
  under_nohup.call("/v1/sweeps", json{{"text", "{}"}});
  EXPECT_TRUE(becomes(under_nohup, "done"));
}

TEST_F(DaemonTest, AClientThatStaysDoesNotKeepItUp) {
  Daemon shakend = daemon();
  shakend.first_line();
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strcpy(address.sun_path, (directory_ / "root" / "shakend.sock").c_str());
  ASSERT_EQ(connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  std::atomic<bool> enough = false;
  std::thread dripping([&] {
    send(fd, "GET /v1/status HTTP/1.1\r\nX: ", 28, MSG_NOSIGNAL);
    while (!enough) {
      send(fd, "x", 1, MSG_NOSIGNAL);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
  shakend.send(SIGTERM);
  EXPECT_EQ(shakend.wait(), 0);
  enough = true;
  dripping.join();
  close(fd);
}

TEST_F(DaemonTest, WithoutLcmItSaysSoAndWorksOn) {
  setenv("FAKE_WORKER", "done", 1);
  Daemon shakend(directory_ / "root", {"--worker", worker_.string(), "--lcm-url", "nonsense://"});
  shakend.first_line();
  const json lcm = shakend.call("/v1/status")["lcm"];
  EXPECT_EQ(lcm["ok"], false);
  EXPECT_THAT(lcm["message"].get<std::string>(), HasSubstr("nonsense://"));
  EXPECT_THAT(shakend.errors(), HasSubstr("no live state"));
  shakend.call("/v1/sweeps", json{{"text", "{}"}});
  EXPECT_TRUE(becomes(shakend, "done"));
}

TEST_F(DaemonTest, ASocketThatWasRemovedIsMadeAnew) {
  Daemon shakend = daemon();
  shakend.first_line();
  const auto socket = directory_ / "root" / "shakend.sock";
  for (const bool replaced : {false, true}) {
    std::filesystem::remove(socket);
    if (replaced) write_text(socket, "no socket");
    EXPECT_TRUE(eventually([&] { return shakend.call("/v1/status").is_object(); })) << shakend.errors();
    EXPECT_EQ(shakend.call("/v1/status")["pid"], shakend.pid());
    EXPECT_EQ(std::filesystem::status(socket).permissions(),
              std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  }
  EXPECT_THAT(shakend.errors(), HasSubstr("listening anew"));
  shakend.send(SIGTERM);
  EXPECT_EQ(shakend.wait(), 0);
  EXPECT_FALSE(std::filesystem::exists(socket));
}

TEST_F(DaemonTest, AnEmptyQueueBesideRunsIsToldAndTheirResultsAreFound) {
  setenv("FAKE_WORKER", "done", 1);
  {
    Daemon shakend = daemon();
    shakend.first_line();
    EXPECT_THAT(shakend.errors(), testing::Not(HasSubstr("is empty")));
    shakend.call("/v1/sweeps", json{{"text", "{}"}});
    EXPECT_TRUE(becomes(shakend, "done"));
    shakend.send(SIGTERM);
    EXPECT_EQ(shakend.wait(), 0);
  }
  setenv("FAKE_WORKER", "fail", 1);
  for (const bool missing : {true, false}) {
    for (const char* name : {"queue.db", "queue.db-wal", "queue.db-shm"}) {
      std::filesystem::remove(directory_ / "root" / name);
    }
    if (!missing) write_text(directory_ / "root" / "queue.db", "");
    Daemon next = daemon();
    EXPECT_THAT(next.first_line(), StartsWith("shakend ready"));
    EXPECT_THAT(next.errors(), HasSubstr("queue.db is empty, but there are 1 runs in "));
    const json answer = next.call("/v1/sweeps", json{{"text", "{}"}});
    EXPECT_EQ(answer["counts"]["found"], 1);
    EXPECT_EQ(next.job()["state"], "done");
    EXPECT_EQ(next.job()["attempt"], 0) << "nothing was run";
  }
}

TEST_F(DaemonTest, ARelayTellsItsAddressAndATakenOneIsSaid) {
  // The address of LCM is one where nothing listens: no multicast leaves this machine.
  const std::vector<std::string> options{"--worker", worker_.string(), "--lcm-url", "tcpq://127.0.0.1:1", "--relay"};
  const auto with = [&](const std::string& address) {
    std::vector<std::string> all = options;
    all.push_back(address);
    return all;
  };
  Daemon shakend(directory_ / "root", with("127.0.0.1:0"));
  EXPECT_THAT(shakend.first_line(), StartsWith("shakend ready"));
  const std::string url = shakend.call("/v1/status")["relay"];
  EXPECT_THAT(url, StartsWith("tcpq://127.0.0.1:"));
  Daemon second(directory_ / "other", with(url.substr(std::string("tcpq://").size())));
  EXPECT_EQ(second.wait(), 1);
  EXPECT_THAT(second.errors(), HasSubstr("the relay cannot listen at 127.0.0.1:"));
  EXPECT_THAT(second.errors(), HasSubstr("Address already in use"));
}

TEST_F(DaemonTest, ALiveStateServerThatSaysNothingKeepsItNeitherFromStartingNorFromEnding) {
  const LazyServer server;
  Daemon shakend(directory_ / "root", {"--worker", worker_.string(), "--lcm-url", server.url()});
  EXPECT_THAT(shakend.first_line(), StartsWith("shakend ready"));
  shakend.send(SIGTERM);
  EXPECT_EQ(shakend.wait(), 0);
}

TEST_F(DaemonTest, ALiveStateServerThatTakesNothingDoesNotKeepItFromEnding) {
  LazyServer server;
  Daemon shakend(directory_ / "root", {"--worker", worker_.string(), "--lcm-url", server.url()});
  server.greet();
  EXPECT_THAT(shakend.first_line(), StartsWith("shakend ready"));
  // More changes than the buffers on the way hold.
  for (int k = 0; k < 10; ++k) {
    const json scene{{"scene", {{"time", {{"seed", 1'000'000 * k}}}}}, {"sweep", {{"replicas", 2000}}}};
    EXPECT_EQ(shakend.call("/v1/sweeps", json{{"text", scene.dump()}})["counts"]["new"], 2000);
  }
  shakend.send(SIGTERM);
  EXPECT_EQ(shakend.wait(), 0);
}

// In a namespace with a disk of its own, which only root may make.
TEST_F(DaemonTest, ADiskThatIsFullOrCannotBeWrittenIsNamed) {
  const std::string root = (directory_ / "disk").string();
  std::filesystem::create_directory(root);
  const auto start = [&](const std::string& mount) {
    return run_captured(
        {"unshare", "-m", "sh", "-c",
         mount + " && exec " + SHAKEND + " --no-lcm --quiet --root " + root + "/root --worker " + worker_.string()},
        CaptureLimits{.time = std::chrono::seconds(60)});
  };
  if (run_captured({"unshare", "-m", "mount", "-t", "tmpfs", "-o", "size=64k", "none", root}).exit_code != 0) {
    GTEST_SKIP() << "no disk can be mounted here";
  }
  const std::string disk = "mount -t tmpfs -o size=64k none " + root + " && mkdir -m 700 " + root + "/root";
  const std::string fill = " && { head -c 100000 /dev/zero > " + root + "/rest 2>/dev/null || true; }";
  for (const std::string before :
       {"", " && echo 1 > /root/shakend.lock && mkdir /root/runs && : > /root/shakend.log"}) {
    const std::string prepared = std::regex_replace(before, std::regex(" /root"), " " + root + "/root");
    const Captured full = start(disk + prepared + fill);
    EXPECT_EQ(full.exit_code, 1) << full.output;
    EXPECT_THAT(full.output, HasSubstr("No space left on device")) << before;
    EXPECT_THAT(full.output, HasSubstr("; make room there")) << before;
    EXPECT_THAT(full.output, testing::Not(HasSubstr("another shakend")));
  }
  const Captured fixed = start(disk + " && mount -o remount,ro " + root);
  EXPECT_EQ(fixed.exit_code, 1) << fixed.output;
  EXPECT_THAT(fixed.output, HasSubstr("choose a --root that can be written"));
}

TEST_F(DaemonTest, WhatCannotStartSaysWhy) {
  Daemon no_worker(directory_ / "root", {"--no-lcm", "--worker", "/nonexistent/worker"});
  EXPECT_EQ(no_worker.wait(), 1);
  EXPECT_THAT(no_worker.errors(), HasSubstr("/nonexistent/worker"));
  const std::filesystem::path old = directory_ / "old";
  std::filesystem::create_directory(old);
  Database(old / "queue.db").execute("PRAGMA user_version = 4");
  Daemon cannot_read(old, {"--no-lcm", "--worker", worker_.string()});
  EXPECT_EQ(cannot_read.wait(), 1);
  EXPECT_THAT(cannot_read.errors(), HasSubstr("queue.db has schema version 4"));

  Daemon no_root("/dev/null/root", {"--no-lcm", "--worker", worker_.string()});
  EXPECT_EQ(no_root.wait(), 1);

  Daemon no_slots(directory_ / "root", {"--slots", "0"});
  EXPECT_EQ(no_slots.wait(), 2);
  EXPECT_THAT(no_slots.errors(), HasSubstr("--slots"));

  Daemon open_relay(directory_ / "root", {"--relay", "0.0.0.0:7700"});
  EXPECT_EQ(open_relay.wait(), 2);
  EXPECT_THAT(open_relay.errors(), HasSubstr("--relay-for-anyone"));
  Daemon named_relay(directory_ / "root", {"--relay", "desk:7700"});
  EXPECT_EQ(named_relay.wait(), 2);
  EXPECT_THAT(named_relay.errors(), HasSubstr("'desk:7700'"));

  std::filesystem::create_directories(directory_ / "root");
  write_text(directory_ / "root" / "queue.db", std::string(8192, 'x'));
  Daemon damaged = daemon();
  EXPECT_EQ(damaged.wait(), 1);
  EXPECT_THAT(damaged.errors(), HasSubstr("queue.db"));
}

}  // namespace
}  // namespace shaken::server
