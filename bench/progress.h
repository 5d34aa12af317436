// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace shaken::bench {

/// "9.6 s", "3 min 20 s", "2 h 05 min".
std::string duration_text(double seconds);

/// How far a long piece of work is, on stderr: a line that is redrawn on a terminal, otherwise one now and then.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  /// Wipes the line off a terminal.
  ~ProgressLine();
  /// `fraction` of the work is done; the time left follows from the time taken.
  void show(double fraction);

 private:
  std::string what_;
  bool terminal_;
  double started_;
  double shown_;
};

}  // namespace shaken::bench
