// HDF5 files that a few changed bytes make dangerous.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/files.h"

namespace shaken {

/// Where the objects of a file's first global heap begin ("GCOL": texts of variable length); npos if it has none. Each
/// has a head of 16 bytes: its index (u16; 0: what is free, the last), a count (u16), 4 unused bytes, its size (u64).
inline std::size_t heap_objects(const std::string& bytes) {
  const std::size_t heap = bytes.find("GCOL");
  return heap == std::string::npos ? heap : heap + 16;
}

inline std::uint64_t size_at(const std::string& bytes, std::size_t head) {
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data() + head + 8, sizeof(size));
  return size;
}

/// Says that the free rest of the heap has no bytes: HDF5 1.10 looks at it for ever. False if the file has no heap.
inline bool make_endless(const std::filesystem::path& file) {
  std::string bytes = read_file(file).value();
  std::size_t head = heap_objects(bytes);
  while (head != std::string::npos && head + 16 < bytes.size() && (bytes[head] != 0 || bytes[head + 1] != 0)) {
    head += 16 + (size_at(bytes, head) + 7) / 8 * 8;
  }
  if (head == std::string::npos || head + 16 >= bytes.size()) return false;
  std::memset(bytes.data() + head + 8, 0, 8);
  std::ofstream(file, std::ios::binary) << bytes;
  return true;
}

/// Says that the heap's first text is longer than all memory: HDF5 1.10 is ended by that. False if there is none.
inline bool make_fatal(const std::filesystem::path& file) {
  std::string bytes = read_file(file).value();
  const std::size_t head = heap_objects(bytes);
  if (head == std::string::npos) return false;
  std::memset(bytes.data() + head + 13, 0x7F, 2);
  std::ofstream(file, std::ios::binary) << bytes;
  return true;
}

}  // namespace shaken
