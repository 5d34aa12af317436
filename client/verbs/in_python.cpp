#include "client/verbs/in_python.h"

#include <fmt/format.h>

#include <cstdlib>

#include "base/paths.h"
#include "base/plots_by_python.h"
#include "base/process.h"

namespace shaken::client {

std::string root_option(const Context& context) { return "--root=" + context.root().string(); }

ExitCode InPython::go_on(const Context& context, const std::string& part,
                         std::initializer_list<std::string> first) const {
  std::vector<std::string> command = python_command(part);
  command.insert(command.end(), first);
  command.insert(command.end(), words_.begin(), words_.end());
  setenv("SHAKEN_PROGRAM", sibling_program("shaken").c_str(), 1);
  setenv("SHAKEN_CONFIGS", shipped_configs().c_str(), 1);
  try {
    return context.console.run_instead(context.console, command);
  } catch (const Failure& failure) {
    throw Failure(ExitCode::kBadInput, fmt::format("`shaken {}` is done by Python: {} (`apt install python3`, or set "
                                                   "SHAKEN_PYTHON)",
                                                   info().name, failure.what()));
  }
}

}  // namespace shaken::client
