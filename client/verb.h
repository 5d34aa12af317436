// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "base/failure.h"
#include "client/arguments.h"
#include "client/console.h"

namespace shaken::client {

/// What every verb may use.
struct Context {
  Console& console;
  std::filesystem::path root;  ///< the daemon's root directory
};

struct VerbInfo {
  const char* name;
  const char* group;     ///< heading in the help
  const char* summary;   ///< one line
  const char* examples;  ///< lines "  shaken verb ...   what it does"
};

/// One thing that the program can do. Its options are its members.
class Verb {
 public:
  virtual ~Verb() = default;
  virtual VerbInfo info() const = 0;
  virtual void declare(Arguments& arguments) = 0;
  /// Runs after the options have been read. May throw Failure.
  virtual ExitCode run(const Context& context) = 0;
};

/// The table of all verbs, in the order of the help.
std::vector<std::unique_ptr<Verb>> make_verbs();

}  // namespace shaken::client
