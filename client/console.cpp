#include "client/console.h"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <iostream>

#include "base/process.h"
#include "base/terminal.h"

namespace shaken::client {
namespace {

/// In the order of Colour.
constexpr std::array kEscapes{"", "\x1b[32m", "\x1b[33m", "\x1b[31m", "\x1b[36m", "\x1b[2m", "\x1b[1m"};

}  // namespace

void Console::refresh_size() {
  if (!interactive) return;
  if (const auto size = terminal_size(STDOUT_FILENO)) {
    width = size->columns;
    height = size->lines;
  }
}

std::string Console::painted(Colour colour_wanted, std::string_view text) const {
  if (!colour || colour_wanted == Colour::kPlain || text.empty()) return std::string(text);
  return kEscapes.at(static_cast<std::size_t>(colour_wanted)) + std::string(text) + "\x1b[0m";
}

bool Console::agrees(const std::string& question, bool otherwise) const {
  for (;;) {
    err << question << (otherwise ? " [Y/n] " : " [y/N] ") << std::flush;
    std::string answer;
    if (in == nullptr || !std::getline(*in, answer)) return otherwise;
    if (answer.empty()) return otherwise;
    if (answer == "y" || answer == "Y" || answer == "yes") return true;
    if (answer == "n" || answer == "N" || answer == "no") return false;
  }
}

Console process_console() {
  Console console{.out = std::cout, .err = std::cerr};
  console.run_instead = [](const Console&, const std::vector<std::string>& command) -> ExitCode { become(command); };
  const char* terminal = std::getenv("TERM");
  const bool dumb = terminal == nullptr || std::string_view(terminal) == "dumb";
  const char* no_colour = std::getenv("NO_COLOR");
  console.interactive = isatty(STDOUT_FILENO) == 1 && !dumb;
  console.err_is_terminal = isatty(STDERR_FILENO) == 1 && !dumb;
  if (isatty(STDIN_FILENO) == 1 && isatty(STDERR_FILENO) == 1) console.in = &std::cin;
  console.colour = console.interactive && (no_colour == nullptr || *no_colour == '\0');
  if (console.interactive) console.width = 80;
  console.refresh_size();
  return console;
}

}  // namespace shaken::client
