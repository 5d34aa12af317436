#include "base/paths.h"

#include <cstdlib>

#include "base/text.h"

namespace shaken {
namespace {

std::filesystem::path shipped(const char* installed_name, const char* name_in_source_tree) {
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  const std::filesystem::path installed = program.parent_path().parent_path() / "share/shaken" / installed_name;
  return !failed && std::filesystem::is_directory(installed, failed)
             ? installed
             : std::filesystem::path(SHAKEN_SOURCE_DIR) / name_in_source_tree;
}

Result<std::filesystem::path> any_root(const std::string& given) {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value == nullptr ? "" : value);
  };
  if (!given.empty()) return std::filesystem::absolute(given);
  if (const auto root = variable("SHAKEN_ROOT"); !root.empty()) return std::filesystem::absolute(root);
  // relative ones would be another root in every folder; the XDG base directory specification has them ignored
  if (const auto data = variable("XDG_DATA_HOME"); data.is_absolute()) return data / "shaken";
  if (const auto home = variable("HOME"); home.is_absolute()) return home / ".local/share/shaken";
  return Error{"no root directory: set --root, SHAKEN_ROOT, or HOME to an absolute path"};
}

}  // namespace

Result<std::filesystem::path> data_root(const std::string& given) {
  Result<std::filesystem::path> root = any_root(given);
  // The daemon tells its clients where runs lie, in JSON, which has no other text.
  if (root && printable(root->string()) != root->string()) {
    return Error{"a root directory has a name of UTF-8 without control characters, not " + printable(root->string())};
  }
  return root;
}

std::filesystem::path shipped_configs() { return shipped("configs", "configs"); }

std::filesystem::path shipped_page() { return shipped("page", "web/page"); }

std::filesystem::path shipped_python() { return shipped("python", "python"); }

}  // namespace shaken
