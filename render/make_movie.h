#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "base/core/result.h"
#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

struct MovieOptions {
  std::string title;                                 ///< in the file's metadata
  Notes notes;                                       ///< in the file's metadata
  std::optional<std::filesystem::path> keep_frames;  ///< folder for frame_000000.png and so on; made if need be
  int n_threads = 1;                                 ///< that draw; reading and encoding go on meanwhile
};

/// What a film is written to: a file of one of movie_endings(); "-", which is stdout, for raw frames (8-bit RGB, rows
/// from top to bottom, without anything between); or a folder, named with a "/" at its end, for frame_000000.png and so
/// on. Says what else is wrong with a name.
Result<void> check_movie_name(const std::string& out);

/// Draws `n_frames` pictures and makes a movie of them. `picture(i)` gives frame i, and is called in this thread, in
/// order; `on_frame(i)`, if there is one, is called when frame i is in the movie, and may return false to stop, which
/// is an error ("stopped"). The movie does not depend on the number of threads. On any error no movie appears.
Result<void> make_movie(const std::string& out, const PictureStyle& style, const MovieOptions& options,
                        std::size_t n_frames, const std::function<Result<RodPicture>(std::size_t)>& picture,
                        const std::function<bool(std::size_t)>& on_frame = {});

/// How high the plots of a film reach in its later half, looked up in some of its frames: an axis that follows each
/// frame jumps from one to the next. What still settles (rods that start aligned have one bar of 100 %) may go beyond.
/// `picture`: of frame k, with those beside it.
Result<FilmAxes> film_axes(std::size_t n_frames, const std::function<Result<RodPicture>(std::size_t)>& picture,
                           const PictureStyle& style);

}  // namespace shaken::render
