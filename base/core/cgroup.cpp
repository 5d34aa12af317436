#include "base/core/cgroup.h"

#include <fstream>
#include <sstream>

namespace shaken {

std::vector<std::filesystem::path> cgroup_files(const std::string& line, const CgroupLimit& limit) {
  const std::size_t first = line.find(':');
  const std::size_t second = line.find(':', first + 1);
  if (first == std::string::npos || second == std::string::npos) return {};
  const bool is_unified = second == first + 1;
  bool is_meant = is_unified;
  std::istringstream controllers(line.substr(first + 1, second - first - 1));
  for (std::string name; std::getline(controllers, name, ',');) is_meant = is_meant || name == limit.controller;
  if (!is_meant) return {};
  std::filesystem::path group = "/sys/fs/cgroup";
  if (!is_unified) group /= limit.controller;
  const char* file = is_unified ? limit.file : limit.file_of_v1;
  std::vector<std::filesystem::path> files{group / file};
  for (const auto& part : std::filesystem::path(line.substr(second + 1)).relative_path()) {
    group /= part;
    files.push_back(group / file);
  }
  return files;
}

std::vector<std::filesystem::path> own_cgroup_files(const CgroupLimit& limit) {
  std::vector<std::filesystem::path> all;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    for (std::filesystem::path& file : cgroup_files(line, limit)) all.push_back(std::move(file));
  }
  return all;
}

}  // namespace shaken
