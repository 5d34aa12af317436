#pragma once

#include <cstddef>
#include <functional>

#include "base/core/result.h"
#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

/// How high the plots of a film reach in its later half, looked up in some of its frames: an axis that follows each
/// frame jumps from one to the next. What still settles (rods that start aligned have one bar of 100 %) may go beyond.
/// `picture`: of frame k, with those beside it.
Result<FilmAxes> film_axes(std::size_t n_frames, const std::function<Result<RodPicture>(std::size_t)>& picture,
                           const PictureStyle& style);

}  // namespace shaken::render
