#pragma once

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/process.h"
#include "base/scratch_folder.h"
#include "client/program.h"

namespace shaken::client {

struct Outcome {
  ExitCode code;
  std::string out;
  std::string err;
};

/// What the program becomes, with both outputs caught.
inline ExitCode run_beside(const Console& console, const std::vector<std::string>& command) {
  const ScratchFolder folder;
  const std::string errors = folder.path() / "errors";
  std::vector<std::string> words{"sh", "-c", "errors=$1; shift; exec \"$@\" 2>\"$errors\"", "sh", errors};
  words.insert(words.end(), command.begin(), command.end());
  const Captured ended = run_captured(words);
  console.out << ended.output;
  console.err << value_or_fail(read_file(errors), ExitCode::kFailed);
  return static_cast<ExitCode>(ended.exit_code);
}

/// The program as a shell would start it, with both outputs caught; neither is a terminal, but lines may have a width
/// as if there were one.
inline Outcome run_client(const std::vector<std::string>& arguments, int width = 0) {
  std::ostringstream out;
  std::ostringstream err;
  Console console{.out = out, .err = err, .width = width, .run_instead = run_beside};
  const ExitCode code = run_program(arguments, console);
  return {code, out.str(), err.str()};
}

/// What a verb prints on stdout that must have done its work.
inline std::string shown(const Outcome& outcome) {
  EXPECT_EQ(outcome.code, ExitCode::kOk) << outcome.err;
  return outcome.out;
}

}  // namespace shaken::client
