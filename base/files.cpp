// SPDX-License-Identifier: MIT
#include "base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <system_error>

namespace shaken {
namespace {

bool write_all(int fd, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(fd, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

Descriptor open_file(const std::filesystem::path& path, int flags) {
  return Descriptor(::open(path.c_str(), flags | O_CLOEXEC, 0666));
}

Result<void> write_through(const std::filesystem::path& file, std::string_view content) {
  Descriptor out = open_file(file, O_WRONLY | O_CREAT | O_TRUNC);
  if (!out || !write_all(out.value(), content) || !out.close_now())
    return system_error("cannot write " + file.string());
  return {};
}

Result<void> sync(const std::filesystem::path& path, int flags) {
  const Descriptor opened = open_file(path, flags);
  if (!opened || ::fsync(opened.value()) != 0) return system_error("cannot bring to the disk " + path.string());
  return {};
}

}  // namespace

std::filesystem::path temporary_for(const std::filesystem::path& file) {
  std::filesystem::path temporary = file;
  temporary += ".tmp";
  return temporary;
}

Result<void> replace_file(const std::filesystem::path& written, const std::filesystem::path& file) {
  Result<void> done = sync(written, O_RDONLY);
  if (done && std::rename(written.c_str(), file.c_str()) != 0) done = system_error("cannot replace " + file.string());
  if (!done) {
    std::error_code ignored;
    std::filesystem::remove(written, ignored);
    return done;
  }
  const std::filesystem::path folder = file.parent_path();
  return sync(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
}

Result<void> write_file(const std::filesystem::path& file, std::string_view content) {
  Result<void> done = write_through(file, content);
  if (!done) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
  return done;
}

Result<void> write_file_atomically(const std::filesystem::path& file, std::string_view content) {
  const std::filesystem::path temporary = temporary_for(file);
  if (auto done = write_file(temporary, content); !done) return done.error();
  return replace_file(temporary, file);
}

Result<ReplacementFile> ReplacementFile::create(const std::filesystem::path& file) {
  Descriptor out = open_file(temporary_for(file), O_WRONLY | O_CREAT | O_TRUNC);
  if (!out) return system_error("cannot write " + file.string());
  return ReplacementFile(file, std::move(out));
}

ReplacementFile::~ReplacementFile() {
  if (!out_) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_for(file_), ignored);
}

Result<void> ReplacementFile::append(std::string_view piece) {
  if (!write_all(out_.value(), piece)) return system_error("cannot write " + file_.string());
  return {};
}

Result<void> ReplacementFile::finish() {
  const std::filesystem::path written = temporary_for(file_);
  if (!out_.close_now()) {
    const Error error = system_error("cannot write " + file_.string());
    std::error_code ignored;
    std::filesystem::remove(written, ignored);
    return error;
  }
  return replace_file(written, file_);
}

namespace {

Result<std::string> read_all(const Descriptor& in, const std::filesystem::path& file, std::size_t most) {
  std::string content;
  char buffer[1 << 16];
  for (;;) {
    const ssize_t got = ::read(in.value(), buffer, sizeof(buffer));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_error("cannot read " + file.string());
    if (got == 0) return content;
    content.append(buffer, static_cast<std::size_t>(got));
    if (content.size() > most)
      return Error{file.string() + " is longer than " + std::to_string(most >> 20) +
                   " MiB, the most that is read of it"};
  }
}

}  // namespace

Result<std::string> read_file(const std::filesystem::path& file) {
  const Descriptor in = open_file(file, O_RDONLY | O_NONBLOCK);  // which changes nothing for a regular file
  if (!in) return system_error("cannot open " + file.string());
  struct stat about {};
  if (::fstat(in.value(), &about) != 0) return system_error("cannot read " + file.string());
  if (S_ISDIR(about.st_mode)) {
    errno = EISDIR;
    return system_error("cannot read " + file.string());
  }
  if (!S_ISREG(about.st_mode)) return Error{"cannot read " + file.string() + ": it is no regular file"};
  return read_all(in, file, std::numeric_limits<std::size_t>::max());
}

Result<std::string> read_input(const std::filesystem::path& file, std::size_t most) {
  const Descriptor in = open_file(file, O_RDONLY);
  if (!in) return system_error("cannot open " + file.string());
  return read_all(in, file, most);
}

bool means_no_room(std::string_view message) {
  return message.find(std::strerror(ENOSPC)) != std::string_view::npos ||
         message.find(std::strerror(EDQUOT)) != std::string_view::npos;
}

Result<void> make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Error{folder.string() + ": " + error.message()};
  return {};
}

}  // namespace shaken
