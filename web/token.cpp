// SPDX-License-Identifier: MIT
#include "web/token.h"

#include <sys/random.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "base/files.h"

namespace shaken::web {
namespace {

constexpr std::size_t kBytes = 16;

bool is_well_formed(std::string_view token) {
  return token.size() == 2 * kBytes && token.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace

Result<std::string> read_or_make_token(const std::filesystem::path& root) {
  const std::filesystem::path file = root / "web.token";
  std::error_code error;
  if (std::filesystem::exists(file, error)) {
    const Result<std::string> text = read_file(file);
    if (!text) return text.error();
    const std::string known = text->substr(0, text->find('\n'));
    if (is_well_formed(known)) return known;
    return Error{file.string() + " does not hold a token of 32 hex digits: remove it, and a new one is made"};
  }
  std::array<unsigned char, kBytes> random{};
  if (getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size())) {
    return Error{std::string("the system gives no random numbers: ") + std::strerror(errno)};
  }
  std::string token;
  for (const unsigned char byte : random) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  const mode_t before = umask(0077);
  const Result<void> written = write_file_atomically(file, token + "\n");
  umask(before);
  if (!written) return written.error();
  return token;
}

bool is_token(std::string_view given, std::string_view token) {
  if (given.size() != token.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < token.size(); ++i) {
    different |= static_cast<unsigned>(static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(token[i]));
  }
  return different == 0;
}

}  // namespace shaken::web
