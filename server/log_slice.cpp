#include "server/log_slice.h"

#include "base/files.h"

namespace shaken::server {
namespace {

/// Bytes at the end of `text` that begin a UTF-8 character without ending it.
std::size_t torn_tail(const std::string& text) {
  for (std::size_t back = 1; back <= 3 && back <= text.size(); ++back) {
    const auto byte = static_cast<unsigned char>(text[text.size() - back]);
    if (byte < 0x80) return 0;
    if (byte < 0xC0) continue;   // inside a character
    if (byte >= 0xF8) return 0;  // no UTF-8 at all
    const std::size_t length = byte >= 0xF0 ? 4 : byte >= 0xE0 ? 3 : 2;
    return length > back ? back : 0;
  }
  return 0;
}

}  // namespace

LogSlice read_slice(const std::filesystem::path& file, std::int64_t offset, std::int64_t limit) {
  const Result<std::string> part = read_part(file, offset, static_cast<std::size_t>(limit));
  std::string text = part ? *part : "";
  const std::size_t torn = torn_tail(text);
  if (torn < text.size()) text.erase(text.size() - torn);  // a tail alone is not UTF-8 and would never grow whole
  return {text, offset + static_cast<std::int64_t>(text.size())};
}

}  // namespace shaken::server
