// `shaken watch` on a terminal: what stands on the screen, what keys and sizes change, and what is left behind.
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>
#include <utmp.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include "tests/e2e/free_port.h"
#include "tests/e2e/run_command.h"
#include "tests/support/small_terminal.h"

namespace shaken::test {
namespace {

using std::chrono::seconds;
using std::chrono::steady_clock;

/// LCM's multicast may only be used where it cannot leave the machine.
bool has_own_network() { return std::getenv("SHAKEN_OWN_NETWORK") != nullptr; }

/// A program on a terminal of its own.
class OnTerminal {
 public:
  OnTerminal(const std::vector<std::string>& command, int columns, int lines, bool no_color = false)
      : screen_(columns, lines) {
    std::vector<char*> arguments;
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    winsize size{.ws_row = static_cast<unsigned short>(lines),
                 .ws_col = static_cast<unsigned short>(columns),
                 .ws_xpixel = 0,
                 .ws_ypixel = 0};
    // The other end is kept open too, so that its state can be asked for after the program's end.
    if (openpty(&master_, &slave_, nullptr, nullptr, &size) != 0) throw std::runtime_error("openpty failed");
    tcgetattr(slave_, &before_);
    pid_ = fork();
    if (pid_ == 0) {
      login_tty(slave_);
      setenv("TERM", "xterm-256color", 1);
      setenv("COLORTERM", "truecolor", 1);
      no_color ? setenv("NO_COLOR", "1", 1) : unsetenv("NO_COLOR");
      execv(arguments[0], arguments.data());
      _exit(127);
    }
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;
  ~OnTerminal() {
    if (!status_) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(master_);
    close(slave_);
  }

  void type(const std::string& keys) const {
    if (keys.empty()) return;
    ASSERT_EQ(write(master_, keys.data(), keys.size()), std::ssize(keys));
  }
  void send(int signal) const { kill(pid_, signal); }
  void resize(int columns, int lines) {
    const winsize size{.ws_row = static_cast<unsigned short>(lines),
                       .ws_col = static_cast<unsigned short>(columns),
                       .ws_xpixel = 0,
                       .ws_ypixel = 0};
    screen_.resize(columns, lines);
    ioctl(master_, TIOCSWINSZ, &size);  // tells the program by SIGWINCH
  }

  /// Whether `is_so` of the screen within a minute.
  bool shows(const std::function<bool(const SmallTerminal&)>& is_so) {
    const auto until = steady_clock::now() + seconds(60);
    while (!is_so(screen_)) {
      if (steady_clock::now() > until || !take()) return is_so(screen_);
    }
    return true;
  }
  bool shows(const std::string& text) {
    return shows([&](const SmallTerminal& screen) { return screen.text().find(text) != std::string::npos; });
  }
  bool hides(const std::string& text) {
    return shows([&](const SmallTerminal& screen) { return screen.text().find(text) == std::string::npos; });
  }
  /// Exit code, once the program has ended by itself; -1 if it does not.
  int wait() {
    const auto until = steady_clock::now() + seconds(60);
    while (!status_ && steady_clock::now() < until) take();
    while (take()) {
    }
    return status_ && WIFEXITED(*status_) ? WEXITSTATUS(*status_) : -1;
  }
  /// Asks for whole screens, none of which is read, until the program waits in a write. False if the kernel does not
  /// tell that it does.
  bool fill() const {
    const std::string state = "/proc/" + std::to_string(pid_) + "/wchan";
    const auto until = steady_clock::now() + seconds(20);
    while (steady_clock::now() < until) {
      type("\f");
      std::string where;
      std::getline(std::ifstream(state), where);
      if (where == "wait_woken") return true;  // tty_write's; poll has another
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
  /// As wait(), without reading anything.
  int wait_unread() {
    const auto until = steady_clock::now() + seconds(60);
    int status = 0;
    while (waitpid(pid_, &status, WNOHANG) != pid_) {
      if (steady_clock::now() > until) return -1;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    status_ = status;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  const SmallTerminal& screen() const { return screen_; }
  /// Whether everything is as it was before the program.
  void expect_given_back() const {
    EXPECT_FALSE(screen_.is_on_second_page());
    EXPECT_TRUE(screen_.shows_cursor());
    EXPECT_FALSE(screen_.is_updating());
    EXPECT_EQ(screen_.misunderstood(), "");
    termios after{};
    tcgetattr(slave_, &after);
    EXPECT_EQ(after.c_lflag, before_.c_lflag);
    EXPECT_EQ(after.c_iflag, before_.c_iflag);
    EXPECT_EQ(after.c_cc[VSUSP], before_.c_cc[VSUSP]);
    EXPECT_EQ(after.c_cc[VMIN], before_.c_cc[VMIN]);
  }

 private:
  /// What the program has written, after a short wait for it; false once there is nothing and it has ended.
  bool take() {
    if (int status = 0; !status_ && waitpid(pid_, &status, WNOHANG) == pid_) status_ = status;
    pollfd readable{master_, POLLIN, 0};
    if (poll(&readable, 1, status_ ? 0 : 20) <= 0) return !status_;
    std::array<char, 65536> bytes{};
    const ssize_t n = read(master_, bytes.data(), bytes.size());
    if (n <= 0) return false;
    screen_.write({bytes.data(), static_cast<std::size_t>(n)});
    return true;
  }

  SmallTerminal screen_;
  int master_ = -1;
  int slave_ = -1;
  pid_t pid_ = -1;
  termios before_{};
  std::optional<int> status_;
};

constexpr const char* kLongRun = R"({
  "rods": { "length": "4.5 mm", "area_fraction": 0.65 }, "box": { "side": "20 mm" },
  "time": { "measure": "600 s" }, "measure": { "order": { "every": "5 ms" } }, "movie": null, "trajectory": null })";

/// A daemon with a run that does not end.
class WatchOnATerminal : public ::testing::Test {
 protected:
  explicit WatchOnATerminal(const std::vector<std::string>& live = {}) {
    std::vector<std::string> command{program("shakend"), "--root", root(), "--slots", "1"};
    if (!live.empty()) {
      command.insert(command.end(), live.begin(), live.end());
    } else if (has_own_network()) {
      command.insert(command.end(), {"--lcm-url", "udpm://239.255.76.67:" + std::to_string(30000 + getpid() % 20000) +
                                                      "?ttl=0&recv_buf_size=2097152"});
    } else {
      command.emplace_back("--no-lcm");
    }
    daemon_ = std::make_unique<Process>(command, directory_.path() / "stdout");
    EXPECT_TRUE(daemon_->wait_for("shakend ready", seconds(20))) << daemon_->output();
    std::ofstream(directory_.path() / "long.json") << kLongRun;
    const Finished submitted = run_command(
        {program("shaken"), "submit", (directory_.path() / "long.json").string(), "--root", root()}, seconds(60));
    EXPECT_EQ(submitted.code, 0) << submitted.output;
  }
  ~WatchOnATerminal() override {
    daemon_->signal(SIGTERM);
    daemon_->wait(seconds(30));
  }
  std::string root() const { return directory_.path().string(); }
  std::vector<std::string> watch_command() const { return {program("shaken"), "watch", "--root", root()}; }

  ScratchFolder directory_;
  std::unique_ptr<Process> daemon_;
};

TEST_F(WatchOnATerminal, ShowsRodsAndObeysKeysAndSizes) {
  OnTerminal watch(watch_command(), 120, 40);
  ASSERT_TRUE(watch.shows("sim-s/s")) << watch.screen().text();
  EXPECT_TRUE(watch.screen().is_on_second_page());
  EXPECT_FALSE(watch.screen().shows_cursor());
  if (has_own_network()) {
    ASSERT_TRUE(watch.shows("▀")) << watch.screen().text();
    ASSERT_TRUE(watch.shows("to the director")) << watch.screen().text();
    watch.type("b");
    EXPECT_TRUE(watch.hides("▀")) << watch.screen().text();
    watch.type("ccc");
    EXPECT_TRUE(watch.shows("colours: tilt")) << watch.screen().text();
    watch.type(" ");
    EXPECT_TRUE(watch.shows("HELD")) << watch.screen().text();
    watch.type(" +");
    EXPECT_TRUE(watch.shows("zoom 1.2")) << watch.screen().text();
  } else {
    EXPECT_TRUE(watch.shows("no frame has come yet")) << watch.screen().text();
  }
  watch.type("?");
  EXPECT_TRUE(watch.shows("leave; the runs go on")) << watch.screen().text();
  watch.type("?");
  EXPECT_TRUE(watch.hides("leave; the runs go on")) << watch.screen().text();
  watch.type("o");
  EXPECT_TRUE(watch.shows("1 running")) << watch.screen().text();
  watch.type("o");
  watch.resize(50, 12);
  EXPECT_TRUE(watch.shows("one has 50x12")) << watch.screen().text();
  watch.resize(100, 30);
  EXPECT_TRUE(watch.shows("S(t)")) << watch.screen().text();
  watch.type("q");
  EXPECT_EQ(watch.wait(), 0);
  watch.expect_given_back();
  EXPECT_NE(watch.screen().text().find(" running "), std::string::npos) << "the last state stays on the screen";
}

/// Live state by way of a relay, which needs no network of its own.
class WatchThroughARelay : public WatchOnATerminal {
 protected:
  explicit WatchThroughARelay(const std::string& address = free_address())
      : WatchOnATerminal({"--relay", address, "--lcm-url", "tcpq://" + address}) {}
};

TEST_F(WatchThroughARelay, ShowsRods) {
  OnTerminal watch(watch_command(), 120, 40);
  ASSERT_TRUE(watch.shows("▀")) << watch.screen().text();
  EXPECT_TRUE(watch.shows("0 lost")) << watch.screen().text();
  watch.type("q");
  EXPECT_EQ(watch.wait(), 0);
  watch.expect_given_back();
}

TEST_F(WatchOnATerminal, SignalsGiveTheTerminalBack) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    OnTerminal watch(watch_command(), 100, 30);
    ASSERT_TRUE(watch.shows("? keys")) << watch.screen().text();
    watch.send(signal);
    EXPECT_EQ(watch.wait(), 130) << signal;
    watch.expect_given_back();
  }
  OnTerminal watch(watch_command(), 100, 30);
  ASSERT_TRUE(watch.shows("? keys")) << watch.screen().text();
  watch.type("\x03");
  EXPECT_EQ(watch.wait(), 130) << "Ctrl-C";
  watch.expect_given_back();
}

TEST_F(WatchOnATerminal, ATerminalThatTakesNothingDoesNotKeepItFromEnding) {
  OnTerminal watch(watch_command(), 200, 60);
  ASSERT_TRUE(watch.shows("? keys")) << watch.screen().text();
  // From here on nothing is read, while whole screens are asked for until nothing more can be written.
  if (!watch.fill()) GTEST_SKIP() << "whether a process waits in a write cannot be seen here";
  watch.send(SIGTERM);
  EXPECT_EQ(watch.wait_unread(), 130);
}

TEST_F(WatchOnATerminal, CtrlZGivesTheTerminalBackUntilItGoesOn) {
  OnTerminal watch(watch_command(), 100, 30);
  ASSERT_TRUE(watch.shows("? keys")) << watch.screen().text();
  watch.type("\x1a");
  // Nobody has put it into the background, so it goes on at once, with all of its screen.
  EXPECT_TRUE(watch.shows([](const SmallTerminal& screen) { return screen.n_visits() == 2; }));
  EXPECT_TRUE(watch.shows("? keys")) << watch.screen().text();
  watch.type("q");
  EXPECT_EQ(watch.wait(), 0);
  watch.expect_given_back();
}

TEST_F(WatchOnATerminal, WithoutColourThereIsNone) {
  OnTerminal watch(watch_command(), 120, 40, true);
  ASSERT_TRUE(watch.shows("sim-s/s")) << watch.screen().text();
  if (has_own_network()) {
    ASSERT_TRUE(watch.shows("t = ")) << watch.screen().text();
  }
  EXPECT_EQ(watch.screen().text().find("▀"), std::string::npos);
  for (int line = 0; line < 40; ++line) {
    for (int column = 0; column < 120; ++column) {
      EXPECT_EQ(watch.screen().at(column, line).fore, client::kOwnInk);
      EXPECT_EQ(watch.screen().at(column, line).back, client::kOwnInk);
    }
  }
}

TEST_F(WatchOnATerminal, AnEndByAnErrorGivesTheTerminalBack) {
  OnTerminal watch(watch_command(), 100, 30);
  ASSERT_TRUE(watch.shows("? keys")) << watch.screen().text();
  daemon_->signal(SIGTERM);
  EXPECT_EQ(watch.wait(), 3) << "no daemon listens";
  watch.expect_given_back();
}

}  // namespace
}  // namespace shaken::test
