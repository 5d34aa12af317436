// SPDX-License-Identifier: MIT
#include "render/make_movie.h"

#include <fmt/format.h>

#include "render/movie.h"
#include "render/png.h"

namespace shaken::render {

Result<void> make_movie(Painter& painter, const std::filesystem::path& file, const PictureStyle& style,
                        const MovieOptions& options, std::size_t n_frames,
                        const std::function<Result<RodPicture>(std::size_t)>& picture,
                        const std::function<bool(std::size_t)>& on_frame) {
  if (n_frames == 0) return Error{"there are no frames to make " + file.string() + " of"};
  if (options.keep_frames) {
    std::error_code code;
    std::filesystem::create_directories(*options.keep_frames, code);
    if (code) return Error{"cannot make the folder " + options.keep_frames->string() + ": " + code.message()};
  }
  Result<MovieWriter> movie = MovieWriter::create(file, style.width, style.height, options.fps, options.title);
  if (!movie) return movie.error();
  for (std::size_t i = 0; i < n_frames; ++i) {
    const Result<RodPicture> rods = picture(i);
    if (!rods) return rods.error();
    const Result<Image> image = painter.paint(*rods, style);
    if (!image) return image.error();
    if (options.keep_frames) {
      const auto name = *options.keep_frames / fmt::format("frame_{:06d}.png", i);
      if (auto done = write_png(name, *image, picture_texts(*rods)); !done) return done.error();
    }
    if (auto done = movie->add(*image); !done) return done.error();
    if (on_frame && !on_frame(i)) return Error{"stopped after " + std::to_string(i + 1) + " frames"};
  }
  return movie->finish();
}

}  // namespace shaken::render
