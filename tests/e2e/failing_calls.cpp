// Loaded before libc (LD_PRELOAD): the n-th change that the process makes to files below a folder goes wrong. So every
// instant can be tried at which a machine may stop, or a disk refuse, and none is left to chance.
//
//   SHAKEN_FAULT_BELOW=DIR   which files count
//   SHAKEN_FAULT=kill:N      the process is killed at the N-th change, before it is made
//   SHAKEN_FAULT=half:N      the same after half of the bytes, where the change is a write
//   SHAKEN_FAULT=lose:N      the power fails at the N-th change: files keep what they had at their last fsync
//   SHAKEN_FAULT=undo:N      the same, and what was renamed has its old name where its folder was not synced since
//   SHAKEN_FAULT=full:N      the N-th change and all later ones fail with ENOSPC; removing is still possible
//   SHAKEN_FAULT=once:N      the N-th change fails with EIO
//
// Or a call of one kind fails, wherever it is made:
//   SHAKEN_CALL_FAILS=CALL:ERRNO:N   the N-th CALL of the process fails with this number; CALL is accept, bind, open,
//                                    read, write, fsync, rename, stat, readdir, poll, thread, memory or wait; several,
//                                    between commas, are for one call each. N = 0 counts: at its end the process says
//                                    "CALL: so many calls" on stderr
//   SHAKEN_CALL_FAILS_IN=NAME        in programs of this name only, not in what they start
//   SHAKEN_CALL_FAILS_FROM=FILE      calls count only while this file is there
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <vector>

namespace {

enum class Fault { kNone, kKill, kHalf, kLose, kUndo, kFull, kOnce };

struct Order {
  Fault fault = Fault::kNone;
  long number = 0;
  const char* below = nullptr;
};

const Order& order() {
  static const Order kOrder = [] {
    Order order;
    const char* text = getenv("SHAKEN_FAULT");
    order.below = getenv("SHAKEN_FAULT_BELOW");
    if (text == nullptr || order.below == nullptr) return order;
    if (strncmp(text, "kill:", 5) == 0) order.fault = Fault::kKill;
    if (strncmp(text, "half:", 5) == 0) order.fault = Fault::kHalf;
    if (strncmp(text, "lose:", 5) == 0) order.fault = Fault::kLose;
    if (strncmp(text, "undo:", 5) == 0) order.fault = Fault::kUndo;
    if (strncmp(text, "full:", 5) == 0) order.fault = Fault::kFull;
    if (strncmp(text, "once:", 5) == 0) order.fault = Fault::kOnce;
    order.number = atol(text + 5);
    return order;
  }();
  return kOrder;
}

std::atomic<bool> is_over{false};  // the power has failed, and what is written now is what the disk had

bool counts(const char* path) {
  return order().fault != Fault::kNone && !is_over && strncmp(path, order().below, strlen(order().below)) == 0;
}

std::string path_of(int fd) {
  char link[64], path[4096];
  snprintf(link, sizeof(link), "/proc/self/fd/%d", fd);
  const ssize_t length = readlink(link, path, sizeof(path) - 1);
  return length <= 0 ? "" : std::string(path, static_cast<size_t>(length));
}

bool counts(int fd) { return order().fault != Fault::kNone && !is_over && counts(path_of(fd).c_str()); }

std::optional<std::string> content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return {};
  return std::string(std::istreambuf_iterator<char>(in), {});
}

/// What is not on the disk yet, although the system shows it.
class Unsynced {
 public:
  /// Is to be called before a change of its content.
  void change(const std::string& path) {
    if (is_kept() && !on_disk_.contains(path)) on_disk_.emplace(path, content_of(path).value_or(""));
  }
  /// Before `from` is renamed.
  void rename(const std::string& from, const std::string& to) {
    if (!is_kept()) return;
    const auto changed = on_disk_.find(to);
    renames_.push_back({from, to, changed == on_disk_.end() ? content_of(to) : changed->second});
    on_disk_.erase(to);
    if (auto content = on_disk_.extract(from)) {
      content.key() = to;
      on_disk_.insert(std::move(content));
    }
  }
  void sync(const std::string& path) {
    on_disk_.erase(path);
    std::erase_if(renames_, [&](const Rename& one) { return one.to.substr(0, one.to.rfind('/')) == path; });
  }
  void remove(const std::string& path) { on_disk_.erase(path); }
  void lose() {
    is_over = true;
    for (const auto& [path, content] : on_disk_) std::ofstream(path, std::ios::binary) << content;
    if (order().fault != Fault::kUndo) return;
    for (auto one = renames_.rbegin(); one != renames_.rend(); ++one) {
      if (const auto content = content_of(one->to)) std::ofstream(one->from, std::ios::binary) << *content;
      ::unlink(one->to.c_str());
      if (one->replaced) std::ofstream(one->to, std::ios::binary) << *one->replaced;
    }
  }
  std::mutex mutex;

 private:
  struct Rename {
    std::string from, to;
    std::optional<std::string> replaced;
  };
  static bool is_kept() { return order().fault == Fault::kLose || order().fault == Fault::kUndo; }

  std::map<std::string, std::string> on_disk_;  // of files that were changed since
  std::vector<Rename> renames_;
};

Unsynced& unsynced() {
  static Unsynced one;
  return one;
}

/// Counts a change; kills the process, or says with errno that the change shall fail, if it is its turn.
bool fails() {
  static std::atomic<long> changes{0};
  const long number = ++changes;
  const Order& now = order();
  if (number == now.number) dprintf(STDERR_FILENO, "fault met\n");
  if (now.fault == Fault::kFull && number >= now.number) return errno = ENOSPC, true;
  if (number != now.number) return false;
  if (now.fault == Fault::kOnce) return errno = EIO, true;
  if (now.fault == Fault::kLose || now.fault == Fault::kUndo) unsynced().lose();
  if (now.fault == Fault::kKill || now.fault == Fault::kLose || now.fault == Fault::kUndo) raise(SIGKILL);
  return now.fault == Fault::kHalf;
}

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

template <class Write>
ssize_t guarded_write(int fd, size_t size, Write write) {
  if (!counts(fd)) return write(size);
  const std::lock_guard lock(unsynced().mutex);
  if (!fails()) return unsynced().change(path_of(fd)), write(size);
  if (order().fault == Fault::kHalf) {
    write(size / 2);
    raise(SIGKILL);
  }
  return -1;
}

/// The result of a change that is made or not; `note` tells of it before it is made.
template <class Change, class Note>
int guarded(bool counted, Change change, Note note) {
  if (!counted) return change();
  const std::lock_guard lock(unsynced().mutex);
  if (!fails()) return note(), change();
  if (order().fault == Fault::kHalf) raise(SIGKILL);
  return -1;
}

/// Whether SHAKEN_CALL_FAILS means calls of this process, at this time.
bool is_meant() {
  static const char* const in = getenv("SHAKEN_CALL_FAILS_IN");
  static const char* const from = getenv("SHAKEN_CALL_FAILS_FROM");
  const int before = errno;
  const bool is =
      (in == nullptr || strcmp(program_invocation_short_name, in) == 0) && (from == nullptr || access(from, F_OK) == 0);
  errno = before;
  return is;
}

/// Whether this call of `name` is the one that is to fail; errno then says how.
bool call_fails(const char* name, std::atomic<long>& calls) {
  const size_t length = strlen(name);
  for (const char* order = getenv("SHAKEN_CALL_FAILS"); order != nullptr;) {
    const char* next = strchr(order, ',');
    if (strncmp(order, name, length) == 0 && order[length] == ':') {
      char* end = nullptr;
      const long error = strtol(order + length + 1, &end, 10);
      if (*end != ':' || !is_meant() || ++calls != atol(end + 1)) return false;
      static const char met[] = "fault met\n";
      syscall(SYS_write, STDERR_FILENO, met, sizeof(met) - 1);  // which asks for no memory
      errno = static_cast<int>(error);
      return true;
    }
    order = next == nullptr ? nullptr : next + 1;
  }
  return false;
}

std::atomic<long> accepts{0}, opens{0}, reads{0}, writes{0}, fsyncs{0}, renames{0}, stats{0}, readdirs{0}, polls{0},
    binds{0}, threads{0}, allocations{0}, waits{0};

/// Says how many calls there were of the kind that is counted.
struct Count {
  ~Count() {
    const char* order = getenv("SHAKEN_CALL_FAILS");
    const char* number = order == nullptr ? nullptr : strrchr(order, ':');
    if (number == nullptr || strcmp(number, ":0") != 0 || !is_meant()) return;
    const long all = accepts + opens + reads + writes + fsyncs + renames + stats + readdirs + polls + binds + threads +
                     allocations + waits;
    dprintf(STDERR_FILENO, "%.*s: %ld calls\n", static_cast<int>(strchr(order, ':') - order), order, all);
  }
} count;

/// The mode of an open(), which is there only where a file may be made.
template <class Open>
int guarded_open(int flags, va_list arguments, Open open) {
  const bool has_mode = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
  const mode_t mode = has_mode ? va_arg(arguments, mode_t) : 0;
  return call_fails("open", opens) ? -1 : open(mode);
}

}  // namespace

extern "C" {

int bind(int fd, const sockaddr* address, socklen_t size) noexcept {
  static const auto next = real<int (*)(int, const sockaddr*, socklen_t)>("bind");
  return call_fails("bind", binds) ? -1 : next(fd, address, size);
}

int accept(int fd, sockaddr* address, socklen_t* size) {
  static const auto next = real<int (*)(int, sockaddr*, socklen_t*)>("accept");
  return call_fails("accept", accepts) ? -1 : next(fd, address, size);
}

int accept4(int fd, sockaddr* address, socklen_t* size, int flags) {
  static const auto next = real<int (*)(int, sockaddr*, socklen_t*, int)>("accept4");
  return call_fails("accept", accepts) ? -1 : next(fd, address, size, flags);
}

int open(const char* path, int flags, ...) {
  static const auto next = real<int (*)(const char*, int, ...)>("open");
  va_list arguments;
  va_start(arguments, flags);
  const int fd = guarded_open(flags, arguments, [&](mode_t mode) { return next(path, flags, mode); });
  va_end(arguments);
  return fd;
}

int open64(const char* path, int flags, ...) {
  static const auto next = real<int (*)(const char*, int, ...)>("open64");
  va_list arguments;
  va_start(arguments, flags);
  const int fd = guarded_open(flags, arguments, [&](mode_t mode) { return next(path, flags, mode); });
  va_end(arguments);
  return fd;
}

int poll(pollfd* descriptors, nfds_t n, int timeout) {
  static const auto next = real<int (*)(pollfd*, nfds_t, int)>("poll");
  return call_fails("poll", polls) ? -1 : next(descriptors, n, timeout);
}

ssize_t write(int fd, const void* data, size_t size) {
  static const auto next = real<ssize_t (*)(int, const void*, size_t)>("write");
  if (call_fails("write", writes)) return -1;
  return guarded_write(fd, size, [&](size_t n) { return next(fd, data, n); });
}

ssize_t pwrite(int fd, const void* data, size_t size, off_t offset) {
  static const auto next = real<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
  return guarded_write(fd, size, [&](size_t n) { return next(fd, data, n, offset); });
}

ssize_t pwrite64(int fd, const void* data, size_t size, off64_t offset) {
  static const auto next = real<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64");
  if (call_fails("write", writes)) return -1;
  return guarded_write(fd, size, [&](size_t n) { return next(fd, data, n, offset); });
}

int ftruncate(int fd, off_t length) noexcept {
  static const auto next = real<int (*)(int, off_t)>("ftruncate");
  return guarded(
      counts(fd), [&] { return next(fd, length); }, [&] { unsynced().change(path_of(fd)); });
}

int ftruncate64(int fd, off64_t length) noexcept {
  static const auto next = real<int (*)(int, off64_t)>("ftruncate64");
  return guarded(
      counts(fd), [&] { return next(fd, length); }, [&] { unsynced().change(path_of(fd)); });
}

ssize_t read(int fd, void* data, size_t size) {
  static const auto next = real<ssize_t (*)(int, void*, size_t)>("read");
  return call_fails("read", reads) ? -1 : next(fd, data, size);
}

ssize_t pread(int fd, void* data, size_t size, off_t offset) {
  static const auto next = real<ssize_t (*)(int, void*, size_t, off_t)>("pread");
  return call_fails("read", reads) ? -1 : next(fd, data, size, offset);
}

ssize_t pread64(int fd, void* data, size_t size, off64_t offset) {
  static const auto next = real<ssize_t (*)(int, void*, size_t, off64_t)>("pread64");
  return call_fails("read", reads) ? -1 : next(fd, data, size, offset);
}

int stat(const char* path, struct stat* about) noexcept {
  static const auto next = real<int (*)(const char*, struct stat*)>("stat");
  return call_fails("stat", stats) ? -1 : next(path, about);
}

int fstat(int fd, struct stat* about) noexcept {
  static const auto next = real<int (*)(int, struct stat*)>("fstat");
  return call_fails("stat", stats) ? -1 : next(fd, about);
}

int fstatat(int folder, const char* path, struct stat* about, int flags) noexcept {
  static const auto next = real<int (*)(int, const char*, struct stat*, int)>("fstatat");
  return call_fails("stat", stats) ? -1 : next(folder, path, about, flags);
}

dirent* readdir(DIR* folder) {
  static const auto next = real<dirent* (*)(DIR*)>("readdir");
  return call_fails("readdir", readdirs) ? nullptr : next(folder);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*begin)(void*),
                   void* argument) noexcept {
  static const auto next = real<int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create");
  return call_fails("thread", threads) ? errno : next(thread, attributes, begin, argument);
}

int waitid(idtype_t kind, id_t id, siginfo_t* about, int options) {
  static const auto next = real<int (*)(idtype_t, id_t, siginfo_t*, int)>("waitid");
  return call_fails("wait", waits) ? -1 : next(kind, id, about, options);
}

pid_t waitpid(pid_t child, int* status, int options) {
  static const auto next = real<pid_t (*)(pid_t, int*, int)>("waitpid");
  return call_fails("wait", waits) ? -1 : next(child, status, options);
}

int fsync(int fd) {
  static const auto next = real<int (*)(int)>("fsync");
  if (call_fails("fsync", fsyncs)) return -1;
  // what a killed process has written, the system keeps: to bring it to the disk would only take time
  return guarded(
      counts(fd), [&] { return order().below == nullptr ? next(fd) : 0; }, [&] { unsynced().sync(path_of(fd)); });
}

int rename(const char* from, const char* to) noexcept {
  static const auto next = real<int (*)(const char*, const char*)>("rename");
  if (call_fails("rename", renames)) return -1;
  return guarded(
      counts(to), [&] { return next(from, to); }, [&] { unsynced().rename(from, to); });
}

int remove(const char* path) noexcept {
  static const auto next = real<int (*)(const char*)>("remove");
  if (order().fault == Fault::kFull) return next(path);
  return guarded(
      counts(path), [&] { return next(path); }, [&] { unsynced().remove(path); });
}

}  // extern "C"

/// C++'s memory: what a library in C does without it is its own affair. A refusal is what it is in libstdc++: the
/// handler is asked first, and then it is tried again.
void* operator new(size_t size) {
  if (call_fails("memory", allocations)) {
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
  if (void* memory = malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { free(memory); }
void operator delete(void* memory, size_t) noexcept { free(memory); }
