#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace shaken::server {

/// A piece of a growing text file.
struct LogSlice {
  std::string text;
  std::int64_t next = 0;  ///< the offset to ask for next [bytes]
};

/// At most `limit` bytes from `offset` on, ending between two UTF-8 characters. Empty if the file cannot be read
/// or ends before `offset`.
LogSlice read_slice(const std::filesystem::path& file, std::int64_t offset, std::int64_t limit);

}  // namespace shaken::server
