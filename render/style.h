// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "sim/core/result.h"
#include "sim/core/types.h"

namespace shaken::render {

enum class Theme {
  kLight,  ///< dark words on white
  kDark,   ///< for projectors
  kPrint,  ///< as kLight, on a white floor: for paper
};
/// What lies under the rods.
enum class Background {
  kNone,   ///< the floor
  kOrder,  ///< the local order S of the director field: dark where there is none
};
/// How the director field is drawn.
enum class FieldLines { kNone, kBars, kStreamlines };
enum class ViewPoint {
  kTop,  ///< from above, without perspective
  kGap,  ///< into the gap between the plates, in perspective
};

/// How rods are drawn, and what beside them. Its keys are those of style files and of the command line
/// (render/style_keys.h).
struct PictureStyle {
  int width = 1280;             ///< [pixels]
  int height = 720;             ///< [pixels]
  std::string colour = "auto";  ///< a row of colourings(), or "auto": chosen_colour() decides
  std::optional<Vec2> range;    ///< ends of its scale, in the colouring's unit; the colouring's own if not given
  Theme theme = Theme::kLight;
  double rods = 1;  ///< opacity of floor and rods over the background, in [0, 1]; at 0 no rod is drawn
  Background background = Background::kNone;
  FieldLines lines = FieldLines::kNone;
  bool mark_defects = true;
  double tracks = 0;         ///< for how long defects leave a track of where they were [s]; 0: none
  double displacements = 0;  ///< arrows from where each rod was so long before [s]; 0: none
  bool scale_bar = true;
  bool legend = true;
  bool caption = true;
  ViewPoint view = ViewPoint::kTop;
  std::optional<int> followed;  ///< a rod that stays in the middle; `focus` is then not asked
  bool whole = false;           ///< rods across the border of a periodic box are drawn once and whole, beyond its frame
  double zoom = 1.0;            ///< >= 1: shows a square of box_side / zoom
  Vec2 focus{0.5, 0.5};         ///< middle of the view, in box sides; a periodic box wraps round
  double fps = 30;              ///< frames per second of playing
  std::optional<double> speed;  ///< simulated seconds per second of playing; as the frames come if not given
};

/// What is wrong with a style, if anything.
Result<void> check(const PictureStyle& style);

}  // namespace shaken::render
