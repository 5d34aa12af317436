// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "base/failure.h"

namespace CLI {
class App;
}  // namespace CLI

namespace shaken::bench {

/// What the program is to do once the command line has been read.
using Work = std::function<ExitCode()>;

/// Each adds one subcommand to `app`, which sets `work` if it is the one that the user asked for.
void add_speed(CLI::App& app, Work& work);
void add_analysis(CLI::App& app, Work& work);
void add_accuracy(CLI::App& app, Work& work);
void add_export(CLI::App& app, Work& work);
void add_looks(CLI::App& app, Work& work);
void add_effects(CLI::App& app, Work& work);
void add_hard(CLI::App& app, Work& work);

}  // namespace shaken::bench
