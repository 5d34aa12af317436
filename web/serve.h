#pragma once

#include <filesystem>
#include <string>

namespace shaken::web {

/// Serves the page of the daemon of `root` on a port of 127.0.0.1 (0: any that is free) until SIGINT or SIGTERM, and
/// prints its address. If the page is served already, it prints that address and returns. Live state comes from
/// `lcm_url`, from where the daemon sends it if that is empty, and not at all with `no_lcm`. Throws Failure.
void serve(const std::filesystem::path& root, int port, const std::string& lcm_url, bool no_lcm);

}  // namespace shaken::web
