#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/failure.h"
#include "base/paths.h"
#include "client/arguments.h"
#include "client/console.h"

namespace CLI {
class App;
}

namespace shaken::client {

/// What every verb may use.
struct Context {
  Console& console;
  std::string given_root;  ///< as given with --root, or empty
  const CLI::App& app;     ///< the whole command line, with the options of all verbs

  /// The daemon's root directory. Throws Failure (kBadInput) if there is none.
  std::filesystem::path root() const { return value_or_fail(data_root(given_root), ExitCode::kBadInput); }
};

inline constexpr const char* kCommonExitCodes = "0 done, 1 failed, 2 bad input";

struct VerbInfo {
  const char* name;
  const char* group;                 ///< heading in the help
  const char* summary;               ///< one line
  const char* examples;              ///< lines "  shaken verb ...   what it does"
  const char* exit_codes = nullptr;  ///< what each of them says; null: as of most verbs of its group
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

using Verbs = std::vector<std::unique_ptr<Verb>>;

/// The client's own verbs, in the order of the help.
Verbs make_verbs();

}  // namespace shaken::client
