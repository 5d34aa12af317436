#include "render/notes.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "base/text.h"

namespace shaken::render {
std::string xml_text(const std::string& text) {
  std::string escaped;
  for (const char c : printable(text, Lines::kMany)) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      default:
        // XML 1.0 has no other control characters
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\t' || c == '\n') escaped += c;
    }
  }
  return escaped;
}

std::string notes_text(const Notes& notes) {
  std::string text;
  for (const auto& [key, value] : notes) text.append(text.empty() ? "" : "; ").append(key).append(": ").append(value);
  return text;
}

Result<void> add_words_to_svg(const std::filesystem::path& file, const std::string& title, const Notes& notes,
                              const std::string& elements) {
  std::ifstream in(file, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::size_t root = text.find("<svg"), end = root == std::string::npos ? root : text.find('>', root);
  if (!in || end == std::string::npos) return Error{"Cairo has written no SVG"};
  std::string words;
  if (!title.empty()) words += "\n<title>" + xml_text(title) + "</title>";
  if (!notes.empty()) words += "\n<desc>" + xml_text(notes_text(notes)) + "</desc>";
  text.insert(end + 1, words);
  if (const std::size_t last = text.rfind("</svg>"); last != std::string::npos) text.insert(last, elements);
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text << std::flush;
  if (!out) return Error{"no room on the disk"};
  return {};
}

Result<void> add_notes_to_gif(const std::filesystem::path& file, const Notes& notes) {
  constexpr char kTrailer = '\x3B';
  constexpr std::size_t kBlock = 255;  // a comment extension comes in blocks of so many bytes at most (GIF89a, 24)
  const std::string text = notes_text(notes);
  if (text.empty()) return {};
  std::fstream gif(file, std::ios::binary | std::ios::in | std::ios::out);
  gif.seekg(-1, std::ios::end);
  char last = 0;
  if (!gif.get(last) || last != kTrailer) return Error{"the encoder has written no whole GIF"};
  std::string extension("\x21\xFE", 2);
  for (std::size_t begin = 0; begin < text.size(); begin += kBlock) {
    const std::size_t n = std::min(kBlock, text.size() - begin);
    extension += static_cast<char>(n);
    extension.append(text, begin, n);
  }
  extension += '\0';
  extension += kTrailer;
  gif.seekp(-1, std::ios::end);
  gif.write(extension.data(), static_cast<std::streamsize>(extension.size()));
  gif.flush();
  if (!gif) return Error{"no room on the disk"};
  return {};
}

}  // namespace shaken::render
