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

#include "client/watch/keys.h"
#include "client/watch/steering.h"
#include "client/watch/terminal_session.h"

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
  EXPECT_TRUE(terminal.holds(
      [](TerminalSession& session) { return session.write("x") && session.read().empty() && session.has_keys(); }));
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

using Kind = Key::Kind;

Key letter(char character) { return {Kind::kCharacter, character}; }

const std::vector<std::string> kJobs{"aa", "bb", "cc"};

Steering pressed(Steering state, const std::string& letters, const Vec2& period = {1, 1}) {
  for (const char c : letters) state = steered(state, letter(c), kJobs, period);
  return state;
}

TEST(KeyReader, LettersAndArrows) {
  KeyReader reader;
  EXPECT_EQ(reader.add("q\x1b[A\x1bOB+\t\x1b[Z"),
            (std::vector<Key>{letter('q'), {Kind::kUp}, {Kind::kDown}, letter('+'), letter('\t'), {Kind::kBackTab}}));
}

TEST(KeyReader, AKeyMayComeInPieces) {
  KeyReader reader;
  EXPECT_TRUE(reader.add("\x1b").empty());
  EXPECT_TRUE(reader.is_waiting());
  EXPECT_TRUE(reader.add("[").empty());
  EXPECT_EQ(reader.add("Cn"), (std::vector<Key>{{Kind::kRight}, letter('n')}));
  EXPECT_FALSE(reader.is_waiting());
}

TEST(KeyReader, EscapeAloneIsAKeyOnceNothingFollows) {
  KeyReader reader;
  EXPECT_TRUE(reader.add("\x1b").empty());
  EXPECT_EQ(reader.flush(), std::vector<Key>{{Kind::kEscape}});
  EXPECT_TRUE(reader.flush().empty());
}

TEST(KeyReader, UnknownKeysVanishWhole) {
  KeyReader reader;
  // F5, Ctrl-Right, a mouse report, a paste's brackets, an umlaut: none of them is q or a digit.
  EXPECT_EQ(reader.add("\x1b[15~\x1b[1;5C\x1b[<0;3;4M\x1b[200~\xc3\xbc"), std::vector<Key>{{Kind::kRight}});
  // Nor does a sequence without an end fill the memory.
  for (int i = 0; i < 1000; ++i) reader.add("\x1b[1;");
  EXPECT_TRUE(reader.add("1").size() < 2);
}

TEST(Steering, TabAndNumbersSwitchRuns) {
  Steering state{.job = "aa"};
  EXPECT_EQ(pressed(state, "\t").job, "bb");
  EXPECT_EQ(pressed(state, "nnn").job, "aa");
  EXPECT_EQ(pressed(state, "p").job, "cc");
  EXPECT_EQ(steered(state, {Kind::kBackTab}, kJobs, Vec2(1, 1)).job, "cc");
  EXPECT_EQ(pressed(state, "3").job, "cc");
  EXPECT_EQ(pressed(state, "4").job, "aa") << "there is no fourth";
  state.job = "gone";
  EXPECT_EQ(pressed(state, "p").job, "aa");
  EXPECT_EQ(steered(state, letter('n'), {}, Vec2(1, 1)).job, "gone");
}

TEST(Steering, ZoomHasBoundsAndGoesBackToTheWholeBox) {
  Steering state = pressed({}, "++");
  EXPECT_DOUBLE_EQ(state.view.zoom, 1.5625);
  state = steered(state, {Kind::kRight}, kJobs, Vec2(1, 1));
  EXPECT_DOUBLE_EQ(state.view.x, 0.5 + 0.1 / 1.5625);
  state = pressed(state, "--");
  EXPECT_DOUBLE_EQ(state.view.zoom, 1);
  EXPECT_DOUBLE_EQ(state.view.x, 0.5);
  EXPECT_LE(pressed({}, std::string(100, '+')).view.zoom, 32);
  EXPECT_DOUBLE_EQ(pressed(pressed({}, "+++"), "0").view.zoom, 1);
}

TEST(Steering, ArrowsGoRoundAPeriodicBoxAndStopAtWalls) {
  Steering periodic, walled;
  for (int i = 0; i < 7; ++i) {
    periodic = steered(periodic, {Kind::kUp}, kJobs, Vec2(1, 1));
    walled = steered(walled, {Kind::kUp}, kJobs, Vec2(0, 0));
  }
  EXPECT_NEAR(periodic.view.y, 0.2, 1e-12);
  EXPECT_DOUBLE_EQ(walled.view.y, 1);
  Steering channel = steered({}, {Kind::kUp}, kJobs, Vec2(10, 0));
  for (int i = 0; i < 7; ++i)
    channel = steered(steered(channel, {Kind::kUp}, kJobs, Vec2(10, 0)), {Kind::kRight}, kJobs, Vec2(10, 0));
  EXPECT_NEAR(channel.view.x, 0.2, 1e-12);
  EXPECT_DOUBLE_EQ(channel.view.y, 1);
}

TEST(Steering, LettersToggle) {
  EXPECT_TRUE(pressed({}, " ").paused);
  EXPECT_FALSE(pressed({}, "  ").paused);
  EXPECT_EQ(pressed({}, "c").colouring, Colouring::kLayers);
  EXPECT_EQ(pressed({}, "ccccc").colouring, Colouring::kAuto);
  EXPECT_EQ(pressed({}, "b").grain, Grain::kBraille);
  EXPECT_EQ(pressed({}, "bb").grain, Grain::kBlocks);
  EXPECT_EQ(pressed({}, "bbb").grain, Grain::kBraille);
  EXPECT_FALSE(pressed({}, "d").shows_defects);
  EXPECT_TRUE(pressed({}, "o").numbers);
  EXPECT_TRUE(pressed({}, "q").quit);
  EXPECT_TRUE(pressed({}, "\f").redraw);
}

TEST(Steering, AnyKeyPutsTheHelpAway) {
  const Steering help = pressed({.job = "aa"}, "?");
  EXPECT_TRUE(help.help);
  const Steering after = pressed(help, "n");
  EXPECT_FALSE(after.help);
  EXPECT_EQ(after.job, "aa") << "and does nothing else";
  EXPECT_TRUE(pressed(help, "q").quit);
}

}  // namespace
}  // namespace shaken::client
