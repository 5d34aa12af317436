// SPDX-License-Identifier: MIT
#pragma once

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "client/program.h"

namespace shaken::client {

struct Outcome {
  ExitCode code;
  std::string out;
  std::string err;
};

/// The program as a shell would start it, with both outputs caught; neither is a terminal, but lines may have a width
/// as if there were one.
inline Outcome run_client(const std::vector<std::string>& arguments, int width = 0, Verbs verbs = make_verbs()) {
  std::ostringstream out;
  std::ostringstream err;
  Console console{.out = out, .err = err, .width = width};
  const ExitCode code = run_program(arguments, console, std::move(verbs));
  return {code, out.str(), err.str()};
}

}  // namespace shaken::client
