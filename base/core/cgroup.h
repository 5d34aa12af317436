#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace shaken {

/// What a group of processes (cgroup) may use, and where the system says so.
struct CgroupLimit {
  std::string_view controller;  ///< "memory"
  const char* file;             ///< "memory.max"
  const char* file_of_v1;       ///< "memory.limit_in_bytes"
};

/// The files that say it of a group and of those around it, the outermost first; `line`: of /proc/self/cgroup, of
/// version 2 ("0::/a/b") or 1 ("4:memory:/a/b"). None if the line is about other controllers.
std::vector<std::filesystem::path> cgroup_files(const std::string& line, const CgroupLimit& limit);
/// Those of this process.
std::vector<std::filesystem::path> own_cgroup_files(const CgroupLimit& limit);

}  // namespace shaken
