#pragma once

#include <signal.h>
#include <termios.h>

#include <string>

#include "base/descriptor.h"

namespace shaken::client {

/// A terminal's second page, without a cursor, and its keys one by one and unseen; and all as it was when this goes.
/// Ctrl-C remains a signal. Without a terminal on stdin, or in the background, there are no keys.
class TerminalSession {
 public:
  TerminalSession();
  TerminalSession(const TerminalSession&) = delete;
  TerminalSession& operator=(const TerminalSession&) = delete;
  ~TerminalSession();

  /// Writes all of it, however long the terminal takes. If a signal comes meanwhile, or the terminal is gone, false,
  /// and what it has not taken yet is forgotten.
  bool write(const std::string& bytes);
  /// Whether nothing can be written any more.
  bool is_gone() const { return is_gone_; }
  /// Whether there are keys. Not after the terminal has hung up.
  bool has_keys() const { return has_keys_; }
  /// What has been typed; nothing where poll() knew of some that a signal has thrown away since (Ctrl-C does).
  std::string read();
  /// Readable when the terminal has another size; read by take_resizes().
  int resize_descriptor() const { return resizes_.value(); }
  void take_resizes() const;
  /// Gives the terminal back and stops the program, as Ctrl-Z does; returns when it goes on (`fg`).
  void suspend();

 private:
  void enter();
  void leave();

  bool has_keys_ = false;
  bool is_gone_ = false;
  bool has_settings_ = false;  ///< `before_` holds those that the terminal is to be given back with
  termios before_{};
  sigset_t signals_before_{};
  Descriptor resizes_;
};

}  // namespace shaken::client
