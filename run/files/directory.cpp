// SPDX-License-Identifier: MIT
#include "run/files/directory.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/files.h"

namespace shaken::run {

Result<DirectoryLock> DirectoryLock::acquire(const std::filesystem::path& lock_file) {
  const int fd = ::open(lock_file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (fd < 0) return Error{"cannot open " + lock_file.string() + ": " + std::strerror(errno)};
  DirectoryLock lock(fd);
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return Error{"cannot lock " + lock_file.string() + ": " + std::strerror(errno)};
    const Result<std::string> written = read_file(lock_file);
    std::string owner = written ? *written : "";
    owner.erase(owner.find_last_not_of('\n') + 1);
    return Error{lock_file.parent_path().string() + " is in use by process " + (owner.empty() ? "(unknown)" : owner)};
  }
  const std::string pid = std::to_string(::getpid()) + "\n";
  if (::ftruncate(fd, 0) != 0 || ::pwrite(fd, pid.data(), pid.size(), 0) != static_cast<ssize_t>(pid.size())) {
    return Error{"cannot write " + lock_file.string() + ": " + std::strerror(errno)};
  }
  return lock;
}

DirectoryLock::DirectoryLock(DirectoryLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

DirectoryLock& DirectoryLock::operator=(DirectoryLock&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

DirectoryLock::~DirectoryLock() {
  if (fd_ >= 0) ::close(fd_);  // and with it the lock
}

}  // namespace shaken::run
