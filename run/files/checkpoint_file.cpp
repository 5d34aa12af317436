// SPDX-License-Identifier: MIT
#include "run/files/checkpoint_file.h"

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <span>
#include <string_view>

#include "base/files.h"
#include "run/files/hashed_bytes.h"
#include "sim/core/state_io.h"

namespace shaken::run {
namespace {

constexpr std::string_view kCheckpointMagic = "SHKNCKPT";
constexpr std::uint32_t kCheckpointVersion = 1;

std::vector<std::byte> copy_of(std::span<const std::byte> bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace

std::string as_bytes(const std::string& run_id, const Checkpoint& checkpoint) {
  StateWriter payload;
  payload.put(checkpoint.cpu_seconds);
  payload.put(checkpoint.wall_seconds);
  payload.put(checkpoint.simulation);
  payload.put(checkpoint.measurements);
  StateWriter content;
  content.append(bytes_of(kCheckpointMagic));
  content.put(kCheckpointVersion);
  content.put(static_cast<std::uint32_t>(run_id.size()));
  content.append(bytes_of(run_id));
  content.put(payload.bytes());
  content.put(hash_of(content.bytes()));
  return std::string(text_of(content.bytes()));
}

Result<void> write_checkpoint(const RunDirectory& directory, const std::string& run_id, const Checkpoint& checkpoint) {
  const std::filesystem::path file = directory.checkpoint();
  if (auto done = write_file(temporary_for(file), as_bytes(run_id, checkpoint)); !done) return done.error();
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
  if (!content->starts_with(kCheckpointMagic) || content->size() < kCheckpointMagic.size() + kHashBytes) {
    return refuse("is not a checkpoint");
  }
  try {
    StateReader whole(bytes_of(*content));
    const std::span<const std::byte> hashed = whole.bytes(content->size() - kHashBytes);
    std::uint64_t stored_hash = 0;
    whole.get(stored_hash);
    if (stored_hash != hash_of(hashed)) return refuse("is damaged");

    StateReader parts(hashed.subspan(kCheckpointMagic.size()));
    std::uint32_t version = 0;
    parts.get(version);
    if (version != kCheckpointVersion)
      return refuse("is of version " + std::to_string(version) + ", which this program cannot read");
    std::uint32_t owner_size = 0;
    parts.get(owner_size);
    const std::string owner(text_of(parts.bytes(owner_size)));
    if (owner != run_id) return refuse("belongs to run " + owner + ", not to " + run_id);
    StateReader payload(parts.bytes());
    parts.end();
    Checkpoint checkpoint;
    checkpoint.cpu_seconds = payload.real();
    checkpoint.wall_seconds = payload.real();
    checkpoint.simulation = copy_of(payload.bytes());
    checkpoint.measurements = copy_of(payload.bytes());
    payload.end();
    return checkpoint;
  } catch (const StateError&) {
    return refuse("is damaged");
  }
}

}  // namespace shaken::run
