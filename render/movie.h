#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/core/result.h"
#include "render/image.h"
#include "render/picture.h"

namespace shaken::render {

/// The endings of files that films can be written to: ".mp4, .webm or .gif".
std::string movie_endings();
/// Whether `file` has one of them.
bool is_movie_name(const std::filesystem::path& file);
/// Whether a film called `file` can have pictures of this size, all but .gif needing even numbers, and so many in a
/// second.
Result<void> check_movie(const std::filesystem::path& file, int width, int height, double fps);

/// Encodes pictures as a film, in the format that the file's ending names:
///   .mp4   plays everywhere: H.264 (x264 veryfast, crf 20, or 30 if `small`), yuv420p in BT.709, index at the front
///   .webm  for browsers: VP9 (crf 30, or 42)
///   .gif   for slides and web pages: 256 colours chosen anew for each frame; at most 50 frames per second
/// A key frame every 60 frames. One encoder thread, so equal pictures give an equal file. The film is written beside
/// its final name and appears there only when it is complete.
class MovieWriter {
 public:
  /// Width and height [pixels], even but for a GIF; fps in frames per second of playing. Title and notes go into the
  /// metadata, the notes as its comment; a GIF has no title.
  static Result<MovieWriter> create(const std::filesystem::path& file, int width, int height, double fps,
                                    const std::string& title = "", const Notes& notes = {}, bool small = false);
  MovieWriter(MovieWriter&&) noexcept;
  MovieWriter& operator=(MovieWriter&&) noexcept;
  /// Removes the unfinished file if finish() was not called or failed.
  ~MovieWriter();

  Result<void> add(const Image& image);
  /// Writes what the encoder still holds and gives the file its name.
  Result<void> finish();

 private:
  struct Impl;
  explicit MovieWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace shaken::render
