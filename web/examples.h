#pragma once

#include <filesystem>

#include "web/json_reply.h"

namespace shaken::web {

/// Scenes to begin from, [{"name", "text"}]: that of `shaken init`, and the files in the folder `configs`.
Json examples(const std::filesystem::path& configs);

}  // namespace shaken::web
