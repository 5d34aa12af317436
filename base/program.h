// Of programs that include CLI11 anyway: its header costs seconds.
#pragma once

#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <string>

#include "base/failure.h"
#include "base/help_formatter.h"
#include "base/standard_streams.h"
#include "base/text.h"

namespace shaken {

/// A program and its command line.
class Program : public CLI::App {
 public:
  /// `examples` stand at the end of the help.
  Program(const char* name, const char* description, const char* examples) : CLI::App(description, name) {
    guard_standard_streams(name);
    formatter(std::make_shared<HelpFormatter>());
    footer(examples);
  }

  /// Parses the command line, does the work, and returns the exit code. What goes wrong is one line on stderr, "NAME:
  /// message", or several where a Failure has several. `words` says what is wrong with a command line; CLI11 does where
  /// there is none.
  int run(int argc, char** argv, const std::function<ExitCode()>& work,
          const std::function<std::string(const CLI::ParseError&)>& words = {}) {
    try {
      parse(argc, argv);
      return static_cast<int>(work());
    } catch (const CLI::ParseError& problem) {
      if (problem.get_exit_code() == 0) return exit(problem);  // --help, --version
      return failed((words ? words(problem) : problem.what()) + " (see `" + get_name() + " --help`)",
                    ExitCode::kBadInput);
    } catch (const Failure& failure) {
      return failed(failure.what(), failure.code);
    } catch (const std::bad_alloc&) {
      return failed("there is no memory left", ExitCode::kSystemFailed);
    } catch (const std::exception& problem) {
      return failed(problem.what(), ExitCode::kFailed);
    }
  }

 private:
  int failed(const std::string& message, ExitCode code) const {
    complain(get_name() + ": " + printable(message, Lines::kMany));
    return static_cast<int>(code);
  }
};

}  // namespace shaken
