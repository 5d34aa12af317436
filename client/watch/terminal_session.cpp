#include "client/watch/terminal_session.h"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <iterator>

namespace shaken::client {
namespace {

constexpr const char* kEnter = "\x1b[?1049h\x1b[?25l\x1b[2J";
constexpr const char* kLeave = "\x1b[?2026l\x1b[0m\x1b[?25h\x1b[?1049l";

sigset_t resize_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGWINCH);
  return set;
}

bool has_hung_up(int terminal) {
  pollfd asked{terminal, POLLIN, 0};
  return poll(&asked, 1, 0) == 1 && (asked.revents & (POLLHUP | POLLERR)) != 0;
}

}  // namespace

TerminalSession::TerminalSession() {
  // As a descriptor, a signal cannot come between a look and the wait for the next.
  const sigset_t set = resize_signals();
  sigprocmask(SIG_BLOCK, &set, &signals_before_);
  resizes_ = Descriptor(signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC));
  has_settings_ =
      isatty(STDIN_FILENO) == 1 && tcgetpgrp(STDIN_FILENO) == getpgrp() && tcgetattr(STDIN_FILENO, &before_) == 0;
  has_keys_ = has_settings_;
  enter();
}

TerminalSession::~TerminalSession() {
  leave();
  sigprocmask(SIG_SETMASK, &signals_before_, nullptr);
}

void TerminalSession::enter() {
  if (has_settings_) {
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    raw.c_iflag &= ~static_cast<tcflag_t>(IXON | ICRNL);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    raw.c_cc[VSUSP] = _POSIX_VDISABLE;  // Ctrl-Z is a key: the terminal must be given back first
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  write(kEnter);
}

void TerminalSession::leave() {
  write(kLeave);
  if (!has_settings_ || tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_) == 0) return;
  tcsetattr(STDIN_FILENO, TCSANOW, &before_);  // a signal came while it waited for the terminal to take its output
}

bool TerminalSession::write(const std::string& bytes) {
  const ssize_t n = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
  if (n == std::ssize(bytes)) return true;
  // A terminal takes all, unless a signal comes. What nobody reads shall not keep it from being given back.
  is_gone_ = n < 0 && errno != EINTR;
  tcflush(STDOUT_FILENO, TCOFLUSH);
  return false;
}

std::string TerminalSession::read() {
  std::array<char, 256> bytes{};
  const ssize_t n = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (n == 0 && has_hung_up(STDIN_FILENO)) has_keys_ = false;
  return n > 0 ? std::string(bytes.data(), static_cast<std::size_t>(n)) : std::string();
}

void TerminalSession::take_resizes() const {
  signalfd_siginfo ignored{};
  while (::read(resizes_.value(), &ignored, sizeof ignored) > 0) {
  }
}

void TerminalSession::suspend() {
  leave();
  raise(SIGTSTP);
  enter();
}

}  // namespace shaken::client
