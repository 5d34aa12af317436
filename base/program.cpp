// SPDX-License-Identifier: MIT
#include "base/program.h"

#include <cerrno>
#include <cstdio>
#include <iostream>

#include "base/descriptor.h"

namespace shaken {

void complain(std::string_view line) {
  std::fwrite(line.data(), 1, line.size(), stderr);
  std::fputc('\n', stderr);
}

Result<void> flush_standard_output() {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::cout.good() && std::ferror(stdout) == 0) return {};
  return system_error("cannot write to standard output");
}

}  // namespace shaken
