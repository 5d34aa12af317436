#include "render/colourings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/geometry/periodic.h"
#include "base/keys/markdown.h"

namespace shaken::render {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegree = kPi / 180;

bool has_axis(const RodPicture& picture, std::size_t rod) {
  const Vec3& n = picture.frame.director[rod];
  return picture.cell.beads_of(rod).has_axis() && (n.x() != 0 || n.y() != 0);
}

double in_plane(const RodPicture& picture, std::size_t rod) {
  return std::atan2(picture.frame.director[rod].y(), picture.frame.director[rod].x());
}

// The values.

double angle_to_director(const RodPicture& picture, std::size_t rod) {
  if (picture.cell.species_of(rod) != 0 || !has_axis(picture, rod)) return kNone;
  return analysis::fold_half_turn(in_plane(picture, rod) - picture.found.director_angle) / kDegree;
}

double angle_in_box(const RodPicture& picture, std::size_t rod) {
  if (picture.cell.species_of(rod) != 0 || !has_axis(picture, rod)) return kNone;
  const double angle = analysis::fold_half_turn(in_plane(picture, rod));
  return (angle < 0 ? angle + kPi : angle) / kDegree;
}

double heading(const RodPicture& picture, std::size_t rod) {
  if (!has_axis(picture, rod) || !picture.cell.beads_of(rod).is_polar()) return kNone;
  const double angle = in_plane(picture, rod);
  return (angle < 0 ? angle + 2 * kPi : angle) / kDegree;
}

double tilt(const RodPicture& picture, std::size_t rod) {
  return picture.cell.beads_of(rod).has_axis() ? picture.frame.director[rod].z() : kNone;
}

double speed(const RodPicture& picture, std::size_t rod) {
  if (picture.frame.velocity.empty() || !has_axis(picture, rod)) return kNone;
  return picture.frame.velocity[rod].dot(picture.frame.director[rod]);
}

double local_order(const RodPicture& picture, std::size_t rod) {
  if (!picture.found.field) return kNone;
  return 2 * picture.found.field->q_at(picture.frame.position[rod].head<2>()).norm();
}

double density(const RodPicture& picture, std::size_t rod) {
  return picture.found.density.empty() ? kNone : picture.found.density[rod];
}

double species(const RodPicture& picture, std::size_t rod) { return static_cast<double>(picture.cell.species_of(rod)); }

double number(const RodPicture& picture, std::size_t rod) { return static_cast<double>(picture.frame.track_of(rod)); }

// The colours.

Colour by_layer(double degrees, const Vec2&, Palette palette) { return layer_colour(degrees * kDegree, palette); }
Colour by_axis(double degrees, const Vec2&, Palette) { return wheel_colour(degrees * kDegree); }
Colour by_heading(double degrees, const Vec2&, Palette) { return heading_colour(degrees * kDegree); }
Colour by_sign(double value, const Vec2& range, Palette) { return diverging_colour(value / range.y()); }
Colour by_size(double value, const Vec2& range, Palette) {
  return sequential_colour((value - range.x()) / (range.y() - range.x()));
}
Colour by_name(double index, const Vec2&, Palette) { return name_colour(static_cast<std::size_t>(index)); }
Colour by_number(double index, const Vec2&, Palette) { return number_colour(static_cast<std::size_t>(index)); }

constexpr Asked kNothing{};
constexpr Asked kField{.field = true};
constexpr Asked kDensity{.density = true};

const Colouring kColourings[] = {
    {"angle",
     "the rod's axis in the box, on a circle where half a turn is all (head and tail are the same)",
     "Angle in the box",
     "\u00b0",
     Scale::kHalfTurn,
     {0, 180},
     false,
     kNothing,
     angle_in_box,
     by_axis},
    {"layers",
     "the angle \u03b8 to the nematic director: orange to its left, blue to its right, pale along it",
     "Angle to the director \u03b8",
     "\u00b0",
     Scale::kLine,
     {-90, 90},
     true,
     kNothing,
     angle_to_director,
     by_layer},
    {"heading",
     "where the rod's head points; rods that are the same fore and aft have none",
     "Heading",
     "\u00b0",
     Scale::kFullTurn,
     {0, 360},
     false,
     kNothing,
     heading,
     by_heading},
    {"tilt",
     "n_z, the sine of the angle to the plates: orange if the head is raised, blue if the tail is",
     "Tilt n_z, the head's rise",
     "",
     Scale::kLine,
     {-kFullTilt, kFullTilt},
     true,
     kNothing,
     tilt,
     by_sign},
    {"speed",
     "velocity along the rod's axis: orange towards its head, blue towards its tail",
     "Velocity along the axis",
     "mm/s",
     Scale::kLine,
     {-30, 30},
     true,
     kNothing,
     speed,
     by_sign},
    {"order",
     "the local order S of the director field at the rod's centre",
     "Local order S",
     "",
     Scale::kLine,
     {0, 1},
     false,
     kField,
     local_order,
     by_size},
    {"density",
     "the area fraction around the rod, weighted by a Gaussian of half a rod length",
     "Local area fraction",
     "",
     Scale::kLine,
     {0, 1},
     false,
     kDensity,
     density,
     by_size},
    {"species", "the rod's species", "Species", "", Scale::kNames, {0, 2}, false, kNothing, species, by_name},
    {"id",
     "a colour of its own for each rod, to follow it by eye",
     "Each rod its own",
     "",
     Scale::kNames,
     {0, 0},
     false,
     kNothing,
     number,
     by_number},
};

}  // namespace

std::span<const Colouring> colourings() { return kColourings; }

const Colouring* find_colouring(std::string_view name) {
  const auto* found =
      std::find_if(std::begin(kColourings), std::end(kColourings), [&](const Colouring& c) { return name == c.name; });
  return found == std::end(kColourings) ? nullptr : found;
}

std::vector<std::string> colour_names() {
  std::vector<std::string> names{"auto"};
  for (const Colouring& colouring : kColourings) names.emplace_back(colouring.name);
  return names;
}

std::string chosen_colour(const RodPicture& picture, std::span<const double> orders, bool defects_are_marked) {
  if (!picture.cell.has_axes()) return "species";
  const auto ordered = std::count_if(orders.begin(), orders.end(), [](double s) { return s >= kOrderOfLayers; });
  const bool is_ordered = !orders.empty() && 10 * static_cast<std::size_t>(ordered) >= 9 * orders.size();
  return is_ordered && !(defects_are_marked && !picture.found.defects.empty()) ? "layers" : "angle";
}

const Colouring& colouring_of(const RodPicture& picture, const PictureStyle& style) {
  const Colouring* colouring = find_colouring(
      style.colour == "auto" ? chosen_colour(picture, std::span(&picture.found.order, 1), style.mark_defects)
                             : style.colour);
  return colouring != nullptr ? *colouring : kColourings[0];
}

Vec2 range_of(const Colouring& colouring, const PictureStyle& style) { return style.range.value_or(colouring.range); }

Colour rod_colour(const RodPicture& picture, std::size_t rod, const Colouring& colouring, const Vec2& range,
                  Palette palette) {
  const double value = colouring.value(picture, rod);
  if (!std::isnan(value)) return colouring.colour(value, range, palette);
  const std::size_t species = picture.cell.species_of(rod);
  return species == 0 ? no_value_colour() : species_colour(species);
}

Asked asked_by(const PictureStyle& style) {
  Asked asked;
  if (const Colouring* colouring = find_colouring(style.colour)) asked = colouring->asks;
  asked.defects = style.mark_defects;
  asked.field = asked.field || style.background == Background::kOrder || style.lines != FieldLines::kNone;
  return asked;
}

std::string colourings_as_markdown() {
  std::string table = keys::table_head({"`--colour`", "what colours a rod", "scale"}) +
                      keys::table_line({"`auto`",
                                        "`layers` where there is order (S of 0.7 or more in nine of ten frames) and no "
                                        "defect is marked, else `angle`",
                                        ""});
  for (const Colouring& c : kColourings) {
    const char* space = std::string_view(c.unit).empty() ? "" : " ";
    const std::string scale =
        c.scale == Scale::kNames ? "" : fmt::format("{:g} to {:g}{}{}", c.range.x(), c.range.y(), space, c.unit);
    table += keys::table_line({fmt::format("`{}`", c.name), c.doc, scale});
  }
  return table;
}

}  // namespace shaken::render
