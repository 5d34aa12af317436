// SPDX-License-Identifier: MIT
#include "run/files/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

namespace shaken::run {
namespace {

Error system_error(const std::string& doing, const std::filesystem::path& path, int reason) {
  return {"cannot " + doing + " " + path.string() + ": " + std::strerror(reason)};
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int fd() const { return fd_; }
  bool good() const { return fd_ >= 0; }
  /// Closes now; network disks report lost writes only here. Returns false with errno set.
  bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

bool write_all(int fd, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(fd, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

std::optional<Error> write_through(const std::filesystem::path& file, std::string_view content) {
  Descriptor out(file, O_WRONLY | O_CREAT | O_TRUNC);
  if (!out.good() || !write_all(out.fd(), content) || !out.close()) return system_error("write", file, errno);
  return std::nullopt;
}

std::optional<Error> sync(const std::filesystem::path& path, int flags) {
  Descriptor opened(path, flags);
  if (!opened.good() || ::fsync(opened.fd()) != 0) return system_error("bring to the disk", path, errno);
  return std::nullopt;
}

}  // namespace

std::filesystem::path temporary_for(const std::filesystem::path& file) {
  std::filesystem::path temporary = file;
  temporary += ".tmp";
  return temporary;
}

std::optional<Error> replace_file(const std::filesystem::path& written, const std::filesystem::path& file) {
  std::optional<Error> error = sync(written, O_RDONLY);
  if (!error && std::rename(written.c_str(), file.c_str()) != 0) error = system_error("replace", file, errno);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(written, ignored);
    return error;
  }
  const std::filesystem::path folder = file.parent_path();
  return sync(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
}

std::optional<Error> write_file(const std::filesystem::path& file, std::string_view content) {
  std::optional<Error> error = write_through(file, content);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
  return error;
}

std::optional<Error> write_file_atomically(const std::filesystem::path& file, std::string_view content) {
  const std::filesystem::path temporary = temporary_for(file);
  if (auto error = write_file(temporary, content)) return error;
  return replace_file(temporary, file);
}

Result<std::string> read_file(const std::filesystem::path& file) {
  Descriptor in(file, O_RDONLY);
  if (!in.good()) return system_error("open", file, errno);
  std::string content;
  char buffer[1 << 16];
  for (;;) {
    const ssize_t got = ::read(in.fd(), buffer, sizeof(buffer));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_error("read", file, errno);
    if (got == 0) return content;
    content.append(buffer, static_cast<std::size_t>(got));
  }
}

}  // namespace shaken::run
