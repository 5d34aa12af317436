#pragma once

#include "render/canvas.h"
#include "render/curve.h"
#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

/// S(t) so far, with a dot at the present, on an axis as long as the run.
Curve order_curve(const RodPicture& picture);
/// P(theta) of this instant, as a run measures it (analysis/angles.h) [1/degree], against degrees.
Curve angle_curve(const RodPicture& picture);
/// The points of the sweep, coloured by S, with a ring round this run's.
Curve sweep_curve(const Captions& captions);

/// Whether there is anything to draw for the inset that the style asks for.
bool has_inset(const RodPicture& picture, const PictureStyle& style);
/// The plot that the style asks for; on the rods it has a page of its own.
void draw_inset(const Canvas& canvas, const Rect& place, double unit, const RodPicture& picture,
                const PictureStyle& style, bool is_on_rods);

}  // namespace shaken::render
