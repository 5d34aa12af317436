#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "base/core/result.h"
#include "base/core/types.h"
#include "base/palettes.h"

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
  kTop,    ///< from above, without perspective
  kGap,    ///< into the gap between the plates, in perspective
  kOrbit,  ///< the whole box in perspective, from anywhere above the base
};

/// A defect that a view follows: of those with this charge in the frames that are looked at, the one that lives
/// longest, or after `rank` others.
struct FollowedDefect {
  double charge;
  std::size_t rank;
};

/// A small plot in a corner of the rods.
enum class Inset {
  kNone,
  kAngles,  ///< P(theta) of the instant
  kOrder,   ///< S(t)
  kSweep,   ///< the points of the sweep by their S, with a ring round the run's own
};

/// What light does to rods. What is off costs nothing.
struct Light {
  int samples = 3;        ///< along each side of a pixel, 1 to 3
  bool shadows = true;    ///< on the floor
  bool gloss = true;      ///< light that is thrown back as by a mirror
  bool occlusion = true;  ///< less light from the side, where neighbours are
  bool smooth = true;     ///< normals eased towards those of a smooth body: no strings of pearls
};

/// How rods are drawn, and what beside them. Its keys are those of style files and of the command line
/// (render/style_keys.h).
struct PictureStyle {
  int width = 1280;             ///< [pixels]
  int height = 720;             ///< [pixels]
  std::optional<double> dpi;    ///< pixels per inch that a PNG or a PDF has; if not given a PDF has 72
  std::string colour = "auto";  ///< a row of colourings(), or "auto": chosen_colour() decides
  std::optional<Vec2> range;    ///< ends of its scale, in the colouring's unit; the colouring's own if not given
  Palette palette = Palette::kSafe;
  Theme theme = Theme::kLight;
  bool transparent = false;      ///< no page, no floor: a picture is laid over something else
  std::optional<Colour> ground;  ///< of page, floor and what lies beyond walls; the theme's if not given. No key
  double rods = 1;               ///< opacity of floor and rods over the background, in [0, 1]; at 0 no rod is drawn
  Background background = Background::kNone;
  FieldLines lines = FieldLines::kNone;
  Light light;
  bool mark_defects = true;
  double tracks = 0;         ///< for how long defects leave a track of where they were [s]; 0: none
  double displacements = 0;  ///< arrows from where each rod was so long before [s]; 0: none
  Inset inset = Inset::kNone;
  bool scale_bar = true;
  bool legend = true;
  bool caption = true;
  ViewPoint view = ViewPoint::kTop;
  Vec2 orbit{-30, 35};                            ///< of kOrbit: azimuth and elevation of the eye [degrees]
  std::optional<int> followed;                    ///< a rod that stays in the middle; `focus` is then not asked
  std::optional<FollowedDefect> followed_defect;  ///< as `followed`; one of them at most
  bool whole = false;           ///< rods across the border of a periodic box are drawn once and whole, beyond its frame
  double zoom = 1.0;            ///< >= 1: shows a square of the longer side of the box / zoom
  Vec2 focus{0.5, 0.5};         ///< middle of the view, in box sides; a periodic box wraps round
  double fps = 30;              ///< frames per second of playing
  std::optional<double> speed;  ///< simulated seconds per second of playing; as the frames come if not given
  bool interpolate = true;      ///< frames of a film that lie between recorded ones; else the nearest is shown
  bool time_bar = true;         ///< at the lower edge of a film: how far it is
  bool small = false;           ///< a film of a smaller file: coarser where much moves
};

/// What is wrong with a style, if anything.
Result<void> check(const PictureStyle& style);

}  // namespace shaken::render
