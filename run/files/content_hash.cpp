#include "run/files/content_hash.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/descriptor.h"
#include "base/files.h"
#include "run/files/directory.h"
#include "run/files/hashed_bytes.h"
#include "run/files/progress.h"

namespace shaken::run {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// By which a file is told from what had its name before.
struct Identity {
  dev_t device = 0;
  ino_t inode = 0;
  off_t size = 0;
  time_t seconds = 0;  ///< of the last change
  long nanoseconds = 0;

  bool operator==(const Identity&) const = default;
};

std::optional<Identity> identity_of(const fs::path& file) {
  struct stat now {};
  if (stat(file.c_str(), &now) != 0) return std::nullopt;
  return Identity{now.st_dev, now.st_ino, now.st_size, now.st_mtim.tv_sec, now.st_mtim.tv_nsec};
}

/// The files that this process has found whole.
class WholeFiles {
 public:
  bool contains(const fs::path& file, const Identity& identity) {
    const std::lock_guard lock(mutex_);
    const auto known = known_.find(file);
    return known != known_.end() && known->second == identity;
  }
  void add(const fs::path& file, const Identity& identity) {
    const std::lock_guard lock(mutex_);
    if (known_.size() >= kMost) known_.clear();
    known_[file] = identity;
  }

 private:
  static constexpr std::size_t kMost = 10'000;  // a page may be asked for ever more runs
  std::mutex mutex_;
  std::map<fs::path, Identity> known_;
};

WholeFiles& whole_files() {
  static WholeFiles files;
  return files;
}

/// What the summary beside `file` says of it, if it does.
std::optional<ContentHash> promised(const fs::path& file) {
  const Result<std::string> text = read_file(RunDirectory{file.parent_path()}.summary());
  if (!text) return std::nullopt;
  const Json summary = Json::parse(*text, nullptr, false);
  const auto files = summary.is_object() ? summary.find("files") : summary.end();
  if (files == summary.end() || !files->is_object()) return std::nullopt;
  const auto entry = files->find(file.filename().string());
  if (entry == files->end() || !entry->is_object()) return std::nullopt;
  const auto bytes = entry->find("bytes"), xxh3 = entry->find("xxh3");
  if (bytes == entry->end() || !bytes->is_number_unsigned() || xxh3 == entry->end() || !xxh3->is_string()) {
    return std::nullopt;
  }
  return ContentHash{bytes->get<std::uintmax_t>(), std::strtoull(xxh3->get<std::string>().c_str(), nullptr, 16)};
}

/// A worker that makes a run longer replaces its files one after the other, the summary last.
bool is_at_work(const fs::path& directory) {
  const Result<Progress> progress = read_progress(RunDirectory{directory}.progress());
  return progress && progress->state == "running";
}

}  // namespace

Result<ContentHash> content_hash(const fs::path& file) {
  const Descriptor in(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!in || fstat(in.value(), &status) != 0) return system_error("cannot read " + file.string());
  if (!S_ISREG(status.st_mode)) return Error{file.string() + " is no regular file"};
  std::vector<std::byte> piece(std::size_t{1} << 20);
  StreamedHash hash;
  ContentHash result;
  for (;;) {
    const ssize_t n = read(in.value(), piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return system_error("cannot read " + file.string());
    if (n == 0) break;
    hash.add(std::span(piece).first(static_cast<std::size_t>(n)));
    result.size += static_cast<std::uintmax_t>(n);
  }
  result.xxh3 = hash.value();
  return result;
}

Result<void> check_content(const fs::path& file) {
  // Twice, for both may be replaced between the look at the one and at the other.
  for (int attempt = 0; attempt < 2; ++attempt) {
    const std::optional<Identity> identity = identity_of(file);
    if (!identity || whole_files().contains(file, *identity)) return {};
    const std::optional<ContentHash> wanted = promised(file);
    if (!wanted) return {};
    const ContentHash found = SHAKEN_TRY(content_hash(file));
    if (found == *wanted) {
      whole_files().add(file, *identity);
      return {};
    }
  }
  if (is_at_work(file.parent_path())) return {};
  return Error{fmt::format(
      "{} is damaged: it is not the file that the run has written, as its hash in summary.json tells. Put a copy of it "
      "back; or remove summary.json beside it and submit the scene again, which makes the run's files anew",
      file.string())};
}

bool has_hash(const fs::path& file) { return promised(file).has_value(); }

void assume_whole(const fs::path& file) {
  if (const std::optional<Identity> identity = identity_of(file)) whole_files().add(file, *identity);
}

}  // namespace shaken::run
