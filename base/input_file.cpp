// SPDX-License-Identifier: MIT
#include "base/input_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <vector>

#include "base/descriptor.h"

namespace shaken {
namespace {

Error too_large(const std::string& name, std::size_t most) {
  return {name + " is larger than " + std::to_string(most >> 20) + " MiB, the most that a scene may have"};
}

}  // namespace

Result<std::string> read_input_file(const std::filesystem::path& file, std::size_t most) {
  const Descriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!in) return system_error("cannot open " + file.string());
  std::string content;
  std::vector<char> buffer(std::size_t{1} << 16);
  for (;;) {
    const ssize_t got = ::read(in.value(), buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_error("cannot read " + file.string());
    if (got == 0) return content;
    content.append(buffer.data(), static_cast<std::size_t>(got));
    if (content.size() > most) return too_large(file.string(), most);
  }
}

Result<std::string> read_input(std::istream& in, const std::string& name, std::size_t most) {
  std::string content;
  std::vector<char> buffer(std::size_t{1} << 16);
  while (in) {
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    content.append(buffer.data(), static_cast<std::size_t>(in.gcount()));
    if (content.size() > most) return too_large(name, most);
  }
  return content;
}

}  // namespace shaken
