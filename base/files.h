// Whole files: written so that no crash leaves half of one, read, and the folders they lie in.
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "base/core/result.h"
#include "base/descriptor.h"

namespace shaken {

/// Whether what is written must outlast a loss of power from then on, which costs the writer a wait for the disk.
enum class Lasting { kNo, kYes };

/// Replaces `file` by `content` so that a reader, or a crash at any instant, sees the old file or the new, never a
/// mixture: writes an unfinished file beside it, fsync, rename, fsync of the folder. Returns the reason if the disk
/// refuses; the old file is then untouched. Of several writers at one time the last has its content there, whole.
Result<void> write_file_atomically(const std::filesystem::path& file, std::string_view content,
                                   Lasting lasting = Lasting::kYes);

/// The first step of the above alone: writes `content` without making it last, or removes what there is of it.
Result<void> write_file(const std::filesystem::path& file, std::string_view content);

/// The place beside `file` where its next content is prepared, under a name that no other object gets, on all machines
/// that share the disk. What was written there goes with this object unless it has replaced the file, so an exception
/// leaves nothing over.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(std::filesystem::path file);
  UnfinishedFile(UnfinishedFile&& other) noexcept;
  ~UnfinishedFile();

  const std::filesystem::path& path() const { return path_; }
  /// The content takes the file's place: rename, and where it has to last fsync before and of the folder afterwards.
  Result<void> replace(Lasting lasting = Lasting::kYes);

 private:
  std::filesystem::path file_, path_;
};

/// As write_file_atomically, for content that comes piece by piece: an unfinished file grows until `finish` puts it in
/// the place of FILE. If that never happens, FILE stays as it was, and the unfinished file goes with this object.
class ReplacementFile {
 public:
  static Result<ReplacementFile> create(const std::filesystem::path& file);

  Result<void> append(std::string_view piece);
  /// Nothing may be appended afterwards.
  Result<void> finish();

 private:
  explicit ReplacementFile(const std::filesystem::path& file) : file_(file), unfinished_(file) {}

  std::filesystem::path file_;
  UnfinishedFile unfinished_;
  Descriptor out_;
};

/// Removes what writers of `file` that were killed have left beside it. For one who knows that nobody else writes it.
void remove_unfinished(const std::filesystem::path& file);

/// The whole file, or why it cannot be read. A regular file only: a pipe or a device of that name could keep whoever
/// reads it for ever.
Result<std::string> read_file(const std::filesystem::path& file);

/// At most `size` bytes of a regular file from `offset` on, which counts from the file's end where it is negative.
/// Empty where the file ends before that.
Result<std::string> read_part(const std::filesystem::path& file, std::int64_t offset, std::size_t size);

/// The whole of what a user names, which may be a pipe or a device; an error beyond `most` bytes.
inline constexpr std::size_t kMostOfInput = std::size_t{16} << 20;
Result<std::string> read_input(const std::filesystem::path& file, std::size_t most = kMostOfInput);
/// The same of standard input.
Result<std::string> read_standard_input(std::size_t most = kMostOfInput);

/// Whether the system refused something for want of room on the disk: then its words for that are in the message.
bool means_no_room(std::string_view message);

/// The file at a path as it is now: whether that is another one later, or none.
class FileAsOpened {
 public:
  explicit FileAsOpened(std::filesystem::path path);
  const std::filesystem::path& path() const { return path_; }
  /// Whether it was removed, replaced, or moved with its folder. Where the system does not say, it was not.
  bool is_gone() const;

 private:
  std::filesystem::path path_;
  struct stat about_ {};
};

/// Whether a file is there; the error where the system does not say, as a network's disk may for a moment.
Result<bool> file_exists(const std::filesystem::path& file);

/// Whether an error is one of the system that may be gone another time: of a network's disk, of memory, of descriptors;
/// not that a file is not there. Libraries say it in words only.
bool may_pass(const Error& error);

/// Makes `folder` and those that lead to it, where they are missing.
Result<void> make_folder(const std::filesystem::path& folder);

}  // namespace shaken
