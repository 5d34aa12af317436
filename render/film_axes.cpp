#include "render/film_axes.h"

#include <algorithm>

#include "render/inset.h"
#include "render/legend.h"

namespace shaken::render {
namespace {

constexpr std::size_t kLooks = 16;

void reach(FilmAxes& axes, const RodPicture& picture, const PictureStyle& style) {
  axes.share = std::max(axes.share, highest_bar(picture, style));
  if (style.inset == Inset::kAngles) {
    const Curve curve = angle_curve(picture);
    axes.density = std::max(axes.density, *std::max_element(curve.y.begin(), curve.y.end()));
  }
}

}  // namespace

Result<FilmAxes> film_axes(std::size_t n_frames, const std::function<Result<RodPicture>(std::size_t)>& picture,
                           const PictureStyle& style) {
  FilmAxes axes;
  if (!style.legend && style.inset != Inset::kAngles) return axes;
  const std::size_t first = n_frames / 2, n_later = n_frames - first, n_looks = std::min(kLooks, n_later);
  for (std::size_t k = 0; k < n_looks; ++k) {
    const RodPicture rods = SHAKEN_TRY(picture(first + k * n_later / n_looks));
    reach(axes, rods, style);
    for (const RodPicture& beside : rods.beside) reach(axes, beside, style);
  }
  return axes;
}

}  // namespace shaken::render
