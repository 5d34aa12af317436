// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "render/painter.h"
#include "render/picture.h"
#include "sim/core/result.h"

namespace shaken::render {

struct MovieOptions {
  double fps = 30;                                   ///< frames per second of playing
  std::string title;                                 ///< in the file's metadata
  std::optional<std::filesystem::path> keep_frames;  ///< folder for frame_000000.png and so on; made if need be
};

/// Draws `n_frames` pictures and makes a movie of them. `picture(i)` gives frame i; `on_frame(i)`, if there is one, is
/// called when frame i is in the movie, and may return false to stop, which is an error ("stopped").
/// On any error no movie appears.
Result<void> make_movie(Painter& painter, const std::filesystem::path& file, const PictureStyle& style,
                        const MovieOptions& options, std::size_t n_frames,
                        const std::function<Result<RodPicture>(std::size_t)>& picture,
                        const std::function<bool(std::size_t)>& on_frame = {});

}  // namespace shaken::render
