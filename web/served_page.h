#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/core/result.h"
#include "run/files/directory.h"

namespace shaken::web {

/// That the page of a root directory is served: ROOT/web.lock is held meanwhile, and ROOT/web.address, which only its
/// owner can read, says where. So nobody has to ask whoever listens on a port, to whom a token must not be told.
class ServedPage {
 public:
  /// Fails where it is served already.
  static Result<ServedPage> claim(const std::filesystem::path& root);
  ServedPage(ServedPage&&) = default;
  /// The address goes with the object.
  ~ServedPage();
  Result<void> announce(const std::string& address) const;

 private:
  ServedPage(std::filesystem::path file, run::DirectoryLock lock) : file_(std::move(file)), lock_(std::move(lock)) {}
  std::filesystem::path file_;  ///< empty after a move
  run::DirectoryLock lock_;
};

/// Where it is served, with the token; nothing if that is not known yet.
std::optional<std::string> served_address(const std::filesystem::path& root);

}  // namespace shaken::web
