#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/colours.h"
#include "render/picture.h"
#include "render/style.h"

namespace shaken::render {

/// The shape of a colour scale.
enum class Scale {
  kLine,      ///< from low to high
  kHalfTurn,  ///< a circle on which half a turn is all: axes, which have no head
  kFullTurn,  ///< a circle
  kNames,     ///< no order: things that are told apart
};

/// One way to colour rods. All that the help, the legend and the documentation say of it follows from its row.
struct Colouring {
  const char* name;   ///< of --colour
  const char* doc;    ///< one line
  const char* title;  ///< of the legend
  const char* unit;   ///< of values; empty: a plain number
  Scale scale;
  Vec2 range;       ///< ends of the scale, in `unit`
  bool has_middle;  ///< 0 is drawn in the middle: a range of one's own must hold it there
  Asked asks;       ///< what has to be measured for it
  /// What colours rod `rod`, in `unit`; NaN where it has no such thing: then it gets its species' colour.
  double (*value)(const RodPicture& picture, std::size_t rod);
  Colour (*colour)(double value, const Vec2& range, Palette palette);
};

/// All of them, in the order of the help.
std::span<const Colouring> colourings();
/// The one of this name; null if there is none.
const Colouring* find_colouring(std::string_view name);
/// "auto" and the names of all.
std::vector<std::string> colour_names();

/// What "auto" stands for: by the angle to the director ("layers") where there is order, else by the angle in the box
/// ("angle"). There is order if S is 0.7 or more in nine of ten of the frames shown, whose S are `orders`, and no
/// defect is marked. Rods that are spheres are coloured by species.
std::string chosen_colour(const RodPicture& picture, std::span<const double> orders, bool defects_are_marked);

/// The colouring of a picture in a style that check() accepts.
const Colouring& colouring_of(const RodPicture& picture, const PictureStyle& style);
/// The ends of its scale.
Vec2 range_of(const Colouring& colouring, const PictureStyle& style);
/// The colour that rod `rod` has; `range` is that of its colouring.
Colour rod_colour(const RodPicture& picture, std::size_t rod, const Colouring& colouring, const Vec2& range,
                  Palette palette);

/// What a style needs to have measured.
Asked asked_by(const PictureStyle& style);

/// All of them as a table in Markdown (docs/pictures.md).
std::string colourings_as_markdown();

}  // namespace shaken::render
