// trajectory.part: as it is (first byte 0), or as a header (up to the first line break) and frames that get the right
// lengths and hashes, so that what is behind those is reached.
#include <xxhash.h>

#include <nlohmann/json.hpp>

#include "base/core/state_io.h"
#include "base/files.h"
#include "base/scratch_folder.h"
#include "run/files/frame_log.h"
#include "tests/fuzz/fuzz_target.h"

using namespace shaken;

namespace {

void append(StateWriter& writer, std::string_view text) { writer.append(std::as_bytes(std::span(text))); }

void append_hash(StateWriter& writer, std::string_view text) { writer.put(XXH3_64bits(text.data(), text.size())); }

/// The file whose header is `header`, with `frames` cut into frames of as many rods as that says.
std::string file_of(std::string_view header, std::string_view frames) {
  StateWriter writer;
  append(writer, "SHKNFRAM");
  writer.put(std::uint32_t{1});
  writer.put(static_cast<std::uint32_t>(header.size()));
  append(writer, header);
  append_hash(writer, header);
  const auto json = nlohmann::json::parse(header, nullptr, false);
  std::int64_t n_rods = 0;
  if (json.is_object() && json.contains("n_rods") && json["n_rods"].is_number_integer()) n_rods = json["n_rods"];
  const std::size_t record = 16 + 52 * static_cast<std::size_t>(std::clamp<std::int64_t>(n_rods, 0, 100));
  for (; frames.size() >= record; frames.remove_prefix(record)) {
    append(writer, frames.substr(0, record));
    append_hash(writer, frames.substr(0, record));
  }
  append(writer, frames);
  const auto& bytes = writer.bytes();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ScratchFolder folder;
  if (size == 0) return 0;
  std::string_view text = fuzz::text_of(data, size).substr(1);
  std::string bytes(text);
  if (data[0] != 0) {
    const std::size_t line = std::min(text.find('\n'), text.size());
    bytes = file_of(text.substr(0, line), text.substr(std::min(line + 1, text.size())));
  }
  const auto file = folder.path() / "trajectory.part";
  fuzz::promise(static_cast<bool>(write_file(file, bytes)), "the file is written");
  const auto log = run::open_frame_log(file);
  if (!log) return 0;
  fuzz::promise(static_cast<bool>(run::check((*log)->header())), "a header that is taken is whole");
  const auto n_rods = static_cast<std::size_t>((*log)->header().n_rods);
  for (std::size_t k = 0; k < (*log)->n_frames(); ++k) {
    if (const auto frame = (*log)->frame(k)) {
      fuzz::promise(frame->position.size() == 3 * n_rods, "a frame has every rod");
    }
  }
  (void)run::FrameLog::reopen(file, (*log)->n_frames());
  return 0;
}
