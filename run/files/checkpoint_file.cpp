#include "run/files/checkpoint_file.h"

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string_view>

#include "base/core/state_io.h"
#include "base/files.h"
#include "run/files/hashed_bytes.h"

namespace shaken::run {
namespace {

constexpr std::string_view kCheckpointMagic = "SHKNCKPT";
constexpr std::uint32_t kCheckpointVersion = 1;

std::vector<std::byte> copy_of(std::span<const std::byte> bytes) { return {bytes.begin(), bytes.end()}; }

/// Calls take(bytes) for the pieces of a checkpoint file, one after the other. The arrays of the checkpoint are handed
/// over as they are: next to a gigabyte of measurements there is no second one.
template <class Take>
void each_piece(const std::string& run_id, const Checkpoint& checkpoint, const Take& take) {
  StateWriter times;
  times.put(checkpoint.cpu_seconds);
  times.put(checkpoint.wall_seconds);
  const auto length = [](const std::vector<std::byte>& bytes) {
    StateWriter writer;
    writer.put(static_cast<std::int64_t>(bytes.size()));
    return writer.take();
  };
  const std::vector<std::byte> simulation = length(checkpoint.simulation);
  const std::vector<std::byte> measurements = length(checkpoint.measurements);

  StateWriter head;
  head.append(bytes_of(kCheckpointMagic));
  head.put(kCheckpointVersion);
  head.put(static_cast<std::uint32_t>(run_id.size()));
  head.append(bytes_of(run_id));
  head.put(static_cast<std::int64_t>(times.bytes().size() + simulation.size() + checkpoint.simulation.size() +
                                     measurements.size() + checkpoint.measurements.size()));
  head.append(times.bytes());
  head.append(simulation);

  StreamedHash hash;
  for (const std::span<const std::byte> piece : {std::span(head.bytes()), std::span(checkpoint.simulation),
                                                 std::span(measurements), std::span(checkpoint.measurements)}) {
    hash.add(piece);
    take(piece);
  }
  StateWriter tail;
  tail.put(hash.value());
  take(std::span(tail.bytes()));
}

}  // namespace

Result<void> write_checkpoint(const RunDirectory& directory, const std::string& run_id, const Checkpoint& checkpoint) {
  const std::filesystem::path file = directory.checkpoint();
  ReplacementFile next = SHAKEN_TRY(ReplacementFile::create(file));
  Result<void> done;
  each_piece(run_id, checkpoint, [&](std::span<const std::byte> piece) {
    if (done) done = next.append(text_of(piece));
  });
  if (!done) return done;
  // The new one is written by now: should the machine stop between the renames, the previous one is whole.
  if (std::rename(file.c_str(), directory.previous_checkpoint().c_str()) != 0 && errno != ENOENT) {
    return system_error("cannot keep " + file.string());
  }
  return next.finish();
}

Result<Checkpoint> read_checkpoint(const std::filesystem::path& file, const std::string& run_id) {
  const std::string content = SHAKEN_TRY(read_file(file));
  const auto refuse = [&](const std::string& why) { return Error{file.string() + " " + why}; };

  constexpr std::size_t kHashBytes = sizeof(std::uint64_t);
  if (!content.starts_with(kCheckpointMagic) || content.size() < kCheckpointMagic.size() + kHashBytes) {
    return refuse("is not a checkpoint");
  }
  try {
    StateReader whole(bytes_of(content));
    const std::span<const std::byte> hashed = whole.bytes(content.size() - kHashBytes);
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
