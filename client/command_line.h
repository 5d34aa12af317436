#pragma once

#include <memory>
#include <string>
#include <vector>

#include "client/verb.h"

namespace CLI {
class App;
}

namespace shaken::client {

/// The verbs of a program and the CLI11 application that fills their options.
class CommandLine {
 public:
  explicit CommandLine(Verbs verbs);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
  ~CommandLine();

  /// The verb that `arguments` (without the program's name) call for, its options filled in; none if they asked for
  /// help or the version, which is then printed. Throws Failure (kBadInput) with a suggestion if they make no sense.
  Verb* parse(std::vector<std::string> arguments, Console& console);
  /// As given with --root, or empty.
  const std::string& root() const { return root_; }
  const CLI::App& app() const { return *app_; }

 private:
  std::unique_ptr<CLI::App> app_;
  Verbs verbs_;
  std::string root_;
};

}  // namespace shaken::client
