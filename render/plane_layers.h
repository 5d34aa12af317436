#pragma once

#include <vector>

#include "render/canvas.h"
#include "render/picture.h"
#include "render/picture_layout.h"
#include "render/style.h"

namespace shaken::render {

/// Floor or background, what lies beyond side walls, and posts: all that is under the rods of a picture that does not
/// get them from the rods pass.
void draw_ground(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style);

/// The outlines of all rods seen from above, as areas without light and shadow.
void draw_flat_rods(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style);

/// The director field, as the style asks.
void draw_lines(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style);

/// Where defects were shortly before, and the defects.
void draw_tracks(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style);
void draw_defects(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style);

/// Arrows of true length that end at the rods' centres.
void draw_displacements(const Canvas& canvas, const Layout& layout, const RodPicture& picture,
                        const PictureStyle& style);

/// A curve along the director, its points one step apart, in a plane that goes on across the border of the box [mm].
using Streamline = std::vector<Vec2>;

/// Streamlines that are about `distance` apart [mm] and cover the field, found as Jobard & Lefer (1997) do: a line
/// begins at each seed that is far enough from all lines before, and ends where it would come nearer to one than half
/// of that, or where there is no director.
std::vector<Streamline> streamlines(const analysis::DirectorField& field, double distance);

}  // namespace shaken::render
