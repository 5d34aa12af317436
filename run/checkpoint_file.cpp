// SPDX-License-Identifier: MIT
#include "run/checkpoint_file.h"

#include <xxhash.h>

#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "base/files.h"

namespace shaken::run {
namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");

constexpr std::string_view kMagic = "SHKNCKPT";
constexpr std::uint32_t kVersion = 1;

template <class Number>
void put(std::string& out, Number number) {
  char bytes[sizeof(Number)];
  std::memcpy(bytes, &number, sizeof(Number));
  out.append(bytes, sizeof(Number));
}

template <class Length>
void put_bytes(std::string& out, const void* data, std::size_t size) {
  put(out, static_cast<Length>(size));
  out.append(static_cast<const char*>(data), size);
}

/// Takes parts off the front; once something does not fit, everything after fails too.
class Parts {
 public:
  explicit Parts(std::string_view rest) : rest_(rest) {}
  std::string_view bytes(std::uint64_t size) {
    if (size > rest_.size()) failed_ = true;
    if (failed_) return {};
    const std::string_view part = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return part;
  }
  template <class Number>
  Number number() {
    Number value{};
    const std::string_view part = bytes(sizeof(Number));
    if (!part.empty()) std::memcpy(&value, part.data(), sizeof(Number));
    return value;
  }
  /// Whether everything fitted and nothing is left.
  bool whole() const { return !failed_ && rest_.empty(); }

 private:
  std::string_view rest_;
  bool failed_ = false;
};

std::string payload_of(const Checkpoint& checkpoint) {
  std::string payload;
  put(payload, checkpoint.cpu_seconds);
  put(payload, checkpoint.wall_seconds);
  put_bytes<std::uint64_t>(payload, checkpoint.simulation.data(), checkpoint.simulation.size());
  put_bytes<std::uint64_t>(payload, checkpoint.measurements.data(), checkpoint.measurements.size());
  return payload;
}

std::vector<std::byte> to_bytes(std::string_view part) {
  const auto* begin = reinterpret_cast<const std::byte*>(part.data());
  return {begin, begin + part.size()};
}

}  // namespace

Result<void> write_checkpoint(const RunDirectory& directory, const std::string& run_id, const Checkpoint& checkpoint) {
  const std::string payload = payload_of(checkpoint);
  std::string content(kMagic);
  put(content, kVersion);
  put_bytes<std::uint32_t>(content, run_id.data(), run_id.size());
  put_bytes<std::uint64_t>(content, payload.data(), payload.size());
  put(content, static_cast<std::uint64_t>(XXH3_64bits(content.data(), content.size())));

  const std::filesystem::path file = directory.checkpoint();
  if (auto done = write_file(temporary_for(file), content); !done) return done.error();
  // The new one is written by now: should the machine stop between the renames, the previous one is whole.
  if (std::rename(file.c_str(), directory.previous_checkpoint().c_str()) != 0 && errno != ENOENT) {
    return Error{"cannot keep " + file.string() + ": " + std::strerror(errno)};
  }
  return replace_file(temporary_for(file), file);
}

Result<Checkpoint> read_checkpoint(const std::filesystem::path& file, const std::string& run_id) {
  const Result<std::string> content = read_file(file);
  if (!content) return content.error();
  const auto refuse = [&](const std::string& why) { return Error{file.string() + " " + why}; };

  constexpr std::size_t kHashBytes = sizeof(std::uint64_t);
  if (!content->starts_with(kMagic) || content->size() < kMagic.size() + kHashBytes) {
    return refuse("is not a checkpoint");
  }
  const std::string_view hashed = std::string_view(*content).substr(0, content->size() - kHashBytes);
  const auto stored_hash = Parts(std::string_view(*content).substr(hashed.size())).number<std::uint64_t>();
  if (stored_hash != XXH3_64bits(hashed.data(), hashed.size())) return refuse("is damaged");

  Parts parts(hashed);
  parts.bytes(kMagic.size());
  const auto version = parts.number<std::uint32_t>();
  if (version != kVersion)
    return refuse("is of version " + std::to_string(version) + ", which this program cannot read");
  const std::string_view owner = parts.bytes(parts.number<std::uint32_t>());
  if (owner != run_id) return refuse("belongs to run " + std::string(owner) + ", not to " + run_id);
  Parts payload(parts.bytes(parts.number<std::uint64_t>()));
  Checkpoint checkpoint;
  checkpoint.cpu_seconds = payload.number<double>();
  checkpoint.wall_seconds = payload.number<double>();
  checkpoint.simulation = to_bytes(payload.bytes(payload.number<std::uint64_t>()));
  checkpoint.measurements = to_bytes(payload.bytes(payload.number<std::uint64_t>()));
  if (!parts.whole() || !payload.whole()) return refuse("is damaged");
  return checkpoint;
}

}  // namespace shaken::run
