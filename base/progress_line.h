#pragma once

#include <iosfwd>
#include <string>

namespace shaken {

/// How far a long piece of work is: on a terminal one line that is written over, in a log a line now and then.
class ProgressLine {
 public:
  /// Writes to stderr; `what` is being done. Short work leaves no line in a log.
  explicit ProgressLine(std::string what);
  /// Writes to `out`; `width` columns of a terminal, 0 if they are not known. In a log there is a line at once and
  /// another `log_period` [s] after it at the earliest; if that is 0, there is none.
  ProgressLine(std::ostream& out, bool is_terminal, int width, double log_period);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  /// Wipes the line off a terminal.
  ~ProgressLine() { clear(); }

  /// Shows `text`, unless the last one is too young: a fifth of a second on a terminal.
  void show(const std::string& text);
  /// Shows "WHAT: 40 %, 3 min 20 s left"; the time left follows from the time taken so far.
  void show(double fraction);
  /// Shows `text` whatever the time, and ends the line, so that it stays.
  void end_with(const std::string& text);
  void clear();

 private:
  bool is_due();

  std::ostream* out_;
  std::string what_;
  bool is_terminal_;
  int width_;
  double period_;
  double begun_;
  double shown_;
  bool is_dirty_ = false;  ///< something stands in the terminal's line
};

}  // namespace shaken
