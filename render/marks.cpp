#include "render/marks.h"

#include <cmath>

namespace shaken::render {
namespace {

constexpr Colour kBlack{0.06, 0.07, 0.09};
constexpr Colour kWhite{1, 1, 1};
constexpr Colour kRim{0.47, 0.47, 0.47};  // as far from white as from black, and so from every page
constexpr double kRimWidth = 3;           // of both rims, in units

/// Runs `outline` with the mark's own axes: x along its direction, lengths in units.
template <class Outline>
void in_mark_frame(const Canvas& canvas, double x, double y, double direction, double unit, const Outline& outline) {
  cairo_t* cr = canvas.cairo();
  cairo_save(cr);
  cairo_translate(cr, x, y);
  cairo_rotate(cr, -direction);  // the picture's y axis points down
  cairo_scale(cr, unit, unit);
  outline(cr);
  cairo_restore(cr);
}

/// Fills the present path with `inner` inside a rim of `outer`, so that the mark stands out on rods of any colour, and
/// that inside a grey one, so that its outline is seen on light and dark pages.
void fill_with_rim(const Canvas& canvas, const Colour& inner, const Colour& outer) {
  cairo_t* cr = canvas.cairo();
  for (const bool is_outer : {true, false}) {
    canvas.colour(is_outer ? kRim : outer);
    cairo_set_line_width(cr, 2 * (is_outer ? kRimWidth : 1.8));
    cairo_stroke_preserve(cr);
  }
  canvas.colour(inner);
  cairo_fill(cr);
}

}  // namespace

void draw_plus_half(const Canvas& canvas, double x, double y, double direction, double unit) {
  in_mark_frame(canvas, x, y, direction, unit, [&](cairo_t* cr) {
    // The tail's sides are tangents of the head.
    constexpr double kHead = 7.5, kTip = 34;
    const double touch = std::acos(kHead / kTip);
    cairo_arc(cr, 0, 0, kHead, touch, 2 * kPi - touch);
    cairo_line_to(cr, kTip, 0);
    cairo_close_path(cr);
    fill_with_rim(canvas, kBlack, kWhite);
    canvas.colour(kWhite);
    canvas.line(12, 0, 20, 0, 1.4);
    cairo_arc(cr, 0, 0, 2.2, 0, 2 * kPi);
    cairo_fill(cr);
  });
}

void draw_minus_half(const Canvas& canvas, double x, double y, double direction, double unit) {
  in_mark_frame(canvas, x, y, direction, unit, [&](cairo_t* cr) {
    constexpr double kArm = 17, kWaist = 5.2;
    for (int arm = 0; arm < 3; ++arm) {
      const double along = arm * 2 * kPi / 3, between = along + kPi / 3;
      const auto half_width = [&](double side) {
        cairo_line_to(cr, kArm * std::cos(along) - side * 1.5 * std::sin(along),
                      kArm * std::sin(along) + side * 1.5 * std::cos(along));
      };
      half_width(-1);
      half_width(+1);
      cairo_line_to(cr, kWaist * std::cos(between), kWaist * std::sin(between));
    }
    cairo_close_path(cr);
    fill_with_rim(canvas, kWhite, kBlack);
  });
}

}  // namespace shaken::render
