#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "server/daemon.h"
#include "server/queue/terms.h"

namespace shaken::server {

/// The command line of shakend.
class DaemonOptions {
 public:
  /// Declares the options; defaults are those of this machine.
  explicit DaemonOptions(CLI::App& app);

  /// What the command line asks for, once it is parsed. Throws Failure (kBadInput).
  DaemonConfig config() const;

 private:
  DaemonConfig config_;
  std::string root_;
  std::string executor_ = std::string(kLocal);
  double slurm_poll_ = 10;  ///< [s]
  CLI::Option* url_ = nullptr;
  bool no_lcm_ = false;
  bool web_ = false;
  int web_port_ = 8642;
  std::string relay_;
  bool relay_for_anyone_ = false;
};

}  // namespace shaken::server
