// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/problem.h"
#include "server/queue.h"

namespace shaken::server {

/// The body of POST /v1/sweeps.
struct SubmitRequest {
  std::string text;                   ///< of a scene or sweep file
  std::string file = "request";       ///< its name, for messages
  std::vector<std::string> settings;  ///< "path=value"
  std::optional<int> replicas;
  std::string name;  ///< of the sweep; by default that of the file without folder and extension
  int priority = 0;  ///< higher ones are started first
};

/// Throws std::invalid_argument with a sentence for the user.
SubmitRequest parse_submit_request(std::string_view body);

/// The jobs that a request asks for, or all that is wrong with its text.
/// `runs`: folder of the run directories, where it is looked whether results are still there.
scene::Loaded<std::vector<NewJob>> expand(const SubmitRequest& request, const std::filesystem::path& runs);

}  // namespace shaken::server
