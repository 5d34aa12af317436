#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>
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

constexpr std::size_t kDigits = 12;  ///< of the name of an unfinished file

/// Whether temporary_for makes such a name for a file called `name`.
bool is_temporary_of(std::string_view name, std::string_view temporary) {
  if (!temporary.starts_with(name)) return false;
  temporary.remove_prefix(name.size());
  if (temporary.size() != kDigits + 5 || temporary.front() != '.' || !temporary.ends_with(".tmp")) return false;
  return temporary.substr(1, kDigits).find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

std::filesystem::path temporary_for(const std::filesystem::path& file) {
  std::uint64_t random = 0;
  if (::getrandom(&random, sizeof random, 0) != sizeof random) random = std::random_device{}();
  const std::string ending = fmt::format(".{:0{}x}.tmp", random >> (64 - 4 * kDigits), kDigits);
  std::string name = file.filename().string();
  name.resize(std::min(name.size(), NAME_MAX - ending.size()));
  return file.parent_path() / (name + ending);
}

}  // namespace

void remove_unfinished(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path folder = file.parent_path();
  for (std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!is_temporary_of(file.filename().string(), entry->path().filename().string())) continue;
    std::error_code ignored;
    std::filesystem::remove(entry->path(), ignored);
  }
}

UnfinishedFile::UnfinishedFile(std::filesystem::path file) : file_(std::move(file)), path_(temporary_for(file_)) {}

UnfinishedFile::UnfinishedFile(UnfinishedFile&& other) noexcept
    : file_(std::move(other.file_)), path_(std::exchange(other.path_, {})) {}

UnfinishedFile::~UnfinishedFile() {
  if (!path_.empty()) ::unlink(path_.c_str());
}

Result<void> UnfinishedFile::replace(Lasting lasting) {
  const bool lasts = lasting == Lasting::kYes;
  // known before: nothing may go wrong for want of memory once the file is replaced
  const std::filesystem::path folder = lasts && file_.has_parent_path() ? file_.parent_path() : ".";
  if (auto done = lasts ? sync(path_, O_RDONLY) : Result<void>(); !done) return done;
  if (std::rename(path_.c_str(), file_.c_str()) != 0) return system_error("cannot replace " + file_.string());
  path_.clear();
  return lasts ? sync(folder, O_RDONLY | O_DIRECTORY) : Result<void>();
}

Result<void> write_file(const std::filesystem::path& file, std::string_view content) {
  Result<void> done = write_through(file, content);
  if (!done) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
  return done;
}

Result<void> write_file_atomically(const std::filesystem::path& file, std::string_view content, Lasting lasting) {
  UnfinishedFile unfinished(file);
  if (auto done = write_file(unfinished.path(), content); !done) return done;
  return unfinished.replace(lasting);
}

Result<ReplacementFile> ReplacementFile::create(const std::filesystem::path& file) {
  ReplacementFile next(file);
  next.out_ = open_file(next.unfinished_.path(), O_WRONLY | O_CREAT | O_EXCL);
  if (!next.out_) return system_error("cannot write " + file.string());
  return next;
}

Result<void> ReplacementFile::append(std::string_view piece) {
  if (!write_all(out_.value(), piece)) return system_error("cannot write " + file_.string());
  return {};
}

Result<void> ReplacementFile::finish() {
  if (!out_.close_now()) return system_error("cannot write " + file_.string());
  return unfinished_.replace();
}

namespace {

Result<std::string> read_all(int in, const std::filesystem::path& file, std::size_t most) {
  std::string content;
  char buffer[1 << 16];
  for (;;) {
    const ssize_t got = ::read(in, buffer, sizeof(buffer));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_error("cannot read " + file.string());
    if (got == 0) return content;
    content.append(buffer, static_cast<std::size_t>(got));
    if (content.size() > most)
      return Error{file.string() + " is longer than " + std::to_string(most >> 20) +
                   " MiB, the most that is read of it"};
  }
}

struct RegularFile {
  Descriptor in;
  std::int64_t size;
};

Result<RegularFile> open_regular(const std::filesystem::path& file) {
  Descriptor in = open_file(file, O_RDONLY | O_NONBLOCK);  // which changes nothing for a regular file
  if (!in) return system_error("cannot open " + file.string());
  struct stat about {};
  if (::fstat(in.value(), &about) != 0) return system_error("cannot read " + file.string());
  if (S_ISDIR(about.st_mode)) {
    errno = EISDIR;
    return system_error("cannot read " + file.string());
  }
  if (!S_ISREG(about.st_mode)) return Error{"cannot read " + file.string() + ": it is no regular file"};
  return RegularFile{std::move(in), about.st_size};
}

}  // namespace

Result<std::string> read_file(const std::filesystem::path& file) {
  return read_all(SHAKEN_TRY(open_regular(file)).in.value(), file, std::numeric_limits<std::size_t>::max());
}

Result<std::string> read_part(const std::filesystem::path& file, std::int64_t offset, std::size_t size) {
  const RegularFile opened = SHAKEN_TRY(open_regular(file));
  if (offset < 0) offset = std::max<std::int64_t>(0, opened.size + offset);
  std::string part(size, '\0');
  std::size_t n = 0;
  while (n < size) {
    const ssize_t got = ::pread(opened.in.value(), part.data() + n, size - n, offset + static_cast<std::int64_t>(n));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_error("cannot read " + file.string());
    if (got == 0) break;
    n += static_cast<std::size_t>(got);
  }
  part.resize(n);
  return part;
}

Result<std::string> read_input(const std::filesystem::path& file, std::size_t most) {
  const Descriptor in = open_file(file, O_RDONLY);
  if (!in) return system_error("cannot open " + file.string());
  return read_all(in.value(), file, most);
}

Result<std::string> read_standard_input(std::size_t most) { return read_all(STDIN_FILENO, "stdin", most); }

bool means_no_room(std::string_view message) {
  return message.find(std::strerror(ENOSPC)) != std::string_view::npos ||
         message.find(std::strerror(EDQUOT)) != std::string_view::npos;
}

FileAsOpened::FileAsOpened(std::filesystem::path path) : path_(std::move(path)) { ::stat(path_.c_str(), &about_); }

bool FileAsOpened::is_gone() const {
  struct stat now {};
  if (::stat(path_.c_str(), &now) != 0) return errno == ENOENT || errno == ENOTDIR;
  return now.st_dev != about_.st_dev || now.st_ino != about_.st_ino;
}

Result<bool> file_exists(const std::filesystem::path& file) {
  std::error_code error;
  const bool is_there = std::filesystem::exists(file, error);
  if (error) return Error{file.string() + ": " + error.message(), error.value()};
  return is_there;
}

bool may_pass(const Error& error) {
  static constexpr std::array kPassing{EIO,         ESTALE,       EINTR,     EAGAIN,   ENOMEM,    EMFILE,
                                       ENFILE,      EBUSY,        ETIMEDOUT, ENOLCK,   EHOSTDOWN, ENETDOWN,
                                       ENETUNREACH, EHOSTUNREACH, ENODEV,    ENOTCONN, EREMOTEIO};
  return std::any_of(kPassing.begin(), kPassing.end(), [&](int code) {
    return error.code == code || (error.code == 0 && error.message.find(std::strerror(code)) != std::string::npos);
  });
}

Result<void> make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Error{folder.string() + ": " + error.message(), error.value()};
  return {};
}

}  // namespace shaken
