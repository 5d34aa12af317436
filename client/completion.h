#pragma once

#include <string>

namespace CLI {
class App;
}

namespace shaken::client {

/// A script that completes verbs, options, files and IDs of `app` in bash. IDs come from `shaken completion ids`.
std::string bash_completion(const CLI::App& app);
/// The same for zsh, through its bash emulation.
std::string zsh_completion(const CLI::App& app);

}  // namespace shaken::client
