// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace shaken::bench {

/// Turns the words of options into values. What is wrong with them is collected, so that the user hears all of it at
/// once; in place of a value that was refused comes the lower limit, in a list of several nothing.
class OptionReader {
 public:
  double number(const std::string& option, const std::string& word, double low, double high);
  int whole(const std::string& option, const std::string& word, int low, int high);
  /// "4.5,2.5"
  std::vector<double> numbers(const std::string& option, const std::string& words, double low, double high);
  std::vector<int> wholes(const std::string& option, const std::string& words, int low, int high);

  void complain(std::string problem) { problems_.push_back(std::move(problem)); }
  /// Throws Failure with every problem on a line of its own, if there is any.
  void finish() const;

 private:
  std::optional<double> read(const std::string& option, const std::string& word, double low, double high, bool whole);

  std::vector<std::string> problems_;
};

}  // namespace shaken::bench
