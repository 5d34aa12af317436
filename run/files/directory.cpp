#include "run/files/directory.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "base/files.h"

namespace shaken::run {

Result<DirectoryLock> DirectoryLock::acquire(const std::filesystem::path& lock_file) {
  Descriptor file(::open(lock_file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  if (!file) return system_error("cannot open " + lock_file.string());
  if (::flock(file.value(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return system_error("cannot lock " + lock_file.string());
    const Result<std::string> written = read_file(lock_file);
    std::string owner = written ? *written : "";
    owner.erase(owner.find_last_not_of('\n') + 1);
    return Error{lock_file.parent_path().string() + " is in use by process " + (owner.empty() ? "(unknown)" : owner)};
  }
  const std::string pid = std::to_string(::getpid()) + "\n";
  if (::ftruncate(file.value(), 0) != 0 ||
      ::pwrite(file.value(), pid.data(), pid.size(), 0) != static_cast<ssize_t>(pid.size())) {
    return system_error("cannot write " + lock_file.string());
  }
  return DirectoryLock(std::move(file));
}

bool DirectoryLock::is_held(const std::filesystem::path& lock_file) {
  const Descriptor file(::open(lock_file.c_str(), O_RDWR | O_CLOEXEC));
  return file && ::flock(file.value(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace shaken::run
