// SPDX-License-Identifier: MIT
#include "client/watch/terminal_session.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>
#include <utmp.h>

#include <array>
#include <functional>
#include <utility>

namespace shaken::client {
namespace {

/// A terminal on which a child process has a session, and what it was set to before.
class Terminal {
 public:
  Terminal() {
    // The child's end is kept open too, so that its settings can be asked for after the child's end.
    EXPECT_EQ(openpty(&master_, &slave_, nullptr, nullptr, nullptr), 0);
    tcgetattr(slave_, &before_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  ~Terminal() {
    hang_up();
    close(slave_);
  }

  /// Runs `check` of a session in a process of its own. Its result, after the session's end.
  bool holds(const std::function<bool(TerminalSession&)>& check, bool hangs_up = false) {
    const pid_t child = fork();
    if (child == 0) {
      close(master_);
      login_tty(slave_);
      signal(SIGHUP, SIG_IGN);
      bool held = false;
      {
        TerminalSession session;
        held = check(session);
      }
      _exit(held ? 0 : 1);
    }
    std::array<char, 4096> bytes{};
    bool is_up = true;
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
      pollfd readable{master_, POLLIN, 0};
      const bool has_bytes = poll(&readable, 1, 10) == 1 && read(master_, bytes.data(), bytes.size()) > 0;
      if (has_bytes && hangs_up && std::exchange(is_up, false)) hang_up();  // it is on its second page by now
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
  bool is_as_before() const {
    termios after{};
    tcgetattr(slave_, &after);
    return after.c_lflag == before_.c_lflag && after.c_iflag == before_.c_iflag &&
           after.c_cc[VMIN] == before_.c_cc[VMIN] && after.c_cc[VSUSP] == before_.c_cc[VSUSP];
  }

 private:
  void hang_up() {
    if (master_ >= 0) close(std::exchange(master_, -1));
  }

  int master_ = -1;
  int slave_ = -1;
  termios before_{};
};

// Ctrl-C throws away what has been typed, so that poll() may know of something that read() does not find any more.
TEST(TerminalSession, GivesTheTerminalBackAfterNothingWasReadFromIt) {
  Terminal terminal;
  EXPECT_TRUE(terminal.holds([](TerminalSession& session) { return session.read().empty() && session.has_keys(); }));
  EXPECT_TRUE(terminal.is_as_before());
}

TEST(TerminalSession, HasNoKeysAfterTheTerminalHasHungUp) {
  Terminal terminal;
  const auto loses_keys = [](TerminalSession& session) {
    pollfd readable{STDIN_FILENO, POLLIN, 0};
    return session.has_keys() && poll(&readable, 1, 20000) == 1 && session.read().empty() && !session.has_keys();
  };
  EXPECT_TRUE(terminal.holds(loses_keys, true));
}

}  // namespace
}  // namespace shaken::client
