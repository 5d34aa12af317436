#pragma once

#include <istream>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "base/failure.h"

namespace shaken::client {

enum class Colour { kPlain, kGreen, kYellow, kRed, kBlue, kDim, kBold };

/// Where a verb writes, and what the other side can show. Results go to `out`, everything else to `err`.
struct Console {
  std::ostream& out;
  std::ostream& err;
  std::istream* in = nullptr;  ///< somebody who can be asked on `err` and answers here; null: nobody
  bool interactive = false;    ///< `out` is a terminal that can be redrawn
  bool err_is_terminal = false;
  bool colour = false;  ///< `out` understands colours and the user has not set NO_COLOR
  int width = 0;        ///< columns of the terminal; 0: not a terminal, lines may be of any length
  int height = 24;      ///< lines of the terminal
  /// Runs a program that goes on in place of this one, and returns its exit code.
  ExitCode (*run_instead)(const Console& console, const std::vector<std::string>& command) = nullptr;

  /// Asks `question`, to be answered with y or n; an empty answer, or none, is `otherwise`.
  bool agrees(const std::string& question, bool otherwise) const;
  /// Asks the terminal for its present size.
  void refresh_size();
  /// `text` in a colour, or as it is where colours are not wanted.
  std::string painted(Colour colour_wanted, std::string_view text) const;
};

/// The console of this process: stdout and stderr.
Console process_console();

}  // namespace shaken::client
