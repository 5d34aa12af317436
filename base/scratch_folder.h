#pragma once

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace shaken {

/// A temporary folder that goes with the object. Throws std::system_error if there can be none.
class ScratchFolder {
 public:
  ScratchFolder() {
    const char* chosen = std::getenv("TMPDIR");
    const bool is_chosen = chosen != nullptr && *chosen != '\0';
    std::string name = (std::filesystem::path(is_chosen ? chosen : "/tmp") / "shaken.XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) {
      path_ = name;
      return;
    }
    const std::string what = "no folder can be made in " + std::filesystem::path(name).parent_path().string();
    throw std::system_error(errno, std::generic_category(), what + (is_chosen ? ", which TMPDIR names" : ""));
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace shaken
