// SPDX-License-Identifier: MIT
#include "client/run_location.h"

#include "run/files/directory.h"

namespace shaken::client {

bool is_run_directory(const std::string& id) {
  std::error_code error;
  return std::filesystem::exists(run::RunDirectory{id}.scene(), error);
}

}  // namespace shaken::client
