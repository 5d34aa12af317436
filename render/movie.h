// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "render/image.h"
#include "sim/core/result.h"

namespace shaken::render {

/// Encodes pictures as an mp4 that plays everywhere: H.264 (x264 veryfast, crf 20), yuv420p in BT.709, a key frame
/// every 60 frames, index at the front. One encoder thread, so equal pictures give an equal file.
/// The movie is written beside its final name and appears there only when it is complete.
class MovieWriter {
 public:
  /// Even width and height [pixels], fps in frames per second of playing.
  static Result<MovieWriter> create(const std::filesystem::path& file, int width, int height, double fps,
                                    const std::string& title = "");
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
