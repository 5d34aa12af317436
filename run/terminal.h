// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "run/files/progress.h"
#include "run/pace.h"

namespace shaken::run {

/// "3.2 s", "4 min 10 s", "2 h 05 min", "3 d 4 h".
std::string describe_duration(double seconds);

/// "[######----]  61.0 %  6.10 of 10 s  0.0123 s/s  ETA 5 min 17 s  S 0.913", without an end of line.
std::string describe_progress(const Progress& progress);

/// Shows progress on stderr: a bar that is redrawn on a terminal, otherwise a line every few seconds.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(bool quiet);
  void show(const Progress& progress);

 private:
  bool quiet_;
  bool terminal_;
  Pacer line_pacer_;
};

}  // namespace shaken::run
