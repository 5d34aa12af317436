#include <csignal>
#include <string>
#include <vector>

#include "base/standard_streams.h"
#include "client/program.h"

int main(int argc, char** argv) {
  shaken::guard_standard_streams("shaken");
  // A daemon or a pager that goes away must show as a failed write, not end the program half-way.
  std::signal(SIGPIPE, SIG_IGN);
  shaken::client::Console console = shaken::client::process_console();
  const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
  return static_cast<int>(shaken::client::run_program(arguments, console));
}
