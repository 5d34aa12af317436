#include "render/plane_layers.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "analysis/geometry/periodic.h"
#include "render/colourings.h"
#include "render/colours.h"
#include "render/marks.h"
#include "render/view.h"

namespace shaken::render {
namespace {

/// From the plane to the picture, and a clip to the box while it lives.
class Plane {
 public:
  Plane(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style)
      : cr_(canvas.cairo()),
        view_(view_of(picture, style)),
        scale_(layout.box_side / view_.side),
        box_{static_cast<double>(layout.box_x), static_cast<double>(layout.box_y), static_cast<double>(layout.box_side),
             static_cast<double>(layout.box_side)} {
    cairo_save(cr_);
    cairo_rectangle(cr_, box_.x, box_.y, box_.width, box_.height);
    cairo_clip(cr_);
  }
  Plane(const Plane&) = delete;
  Plane& operator=(const Plane&) = delete;
  ~Plane() { cairo_restore(cr_); }

  const View& view() const { return view_; }
  const Rect& box() const { return box_; }
  double scale() const { return scale_; }  ///< pixels per mm
  /// The pixel of a point that is given from the view's corner.
  Vec2 pixel(const Vec2& from_corner) const {
    return {box_.x + from_corner.x() * scale_, box_.bottom() - from_corner.y() * scale_};
  }

 private:
  cairo_t* cr_;
  View view_;
  double scale_;
  Rect box_;
};

/// Whether there is a director at the node nearest to `place`.
bool is_defined(const analysis::DirectorField& field, const Vec2& place) {
  const Vec2 node = place.cwiseQuotient(field.mesh());
  return field.is_defined(static_cast<int>(std::lround(node.x())), static_cast<int>(std::lround(node.y())));
}

/// How much of a director there is at `place`: 1 where all nodes around it have one, 0 where none has.
double defined_share(const analysis::DirectorField& field, const Vec2& place) {
  const double x = place.x() / field.mesh().x(), y = place.y() / field.mesh().y();
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const auto at = [&](int di, int dj) { return field.is_defined(i + di, j + dj) ? 1.0 : 0.0; };
  const double u = x - i, v = y - j;
  return (1 - v) * ((1 - u) * at(0, 0) + u * at(1, 0)) + v * ((1 - u) * at(0, 1) + u * at(1, 1));
}

void draw_order(const Canvas& canvas, const Plane& plane, const analysis::DirectorField& field, Theme theme) {
  // Nodes half a mesh apart in the view, or as many as pixels show.
  const View& view = plane.view();
  const int n = std::clamp(static_cast<int>(std::ceil(2 * view.side / field.mesh().minCoeff())), 8, 400);
  Image image(n + 1, n + 1);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const Vec2 place = view.corner + view.side / n * Vec2(i, n - j);
      const double order = defined_share(field, place) * 2 * field.q_at(place).norm();
      const Colour colour = order_background(order, theme);
      for (std::size_t c = 0; c < 3; ++c)
        image.pixel(i, j)[c] = static_cast<std::uint8_t>(std::lround(255 * colour[c]));
    }
  }
  canvas.spread(image, plane.box());
}

/// The arena as a path, with its inner wall if there is one; the region is what an even-odd fill would fill.
void arena_path(cairo_t* cr, const Plane& plane, const SideWalls& walls, const Box& box) {
  const Vec2 middle = plane.pixel(box.sides() / 2 - plane.view().corner);
  const double reach = walls.size / 2 * plane.scale();
  if (walls.arena == Arena::kSquare) {
    cairo_rectangle(cr, middle.x() - reach, middle.y() - reach, 2 * reach, 2 * reach);
    return;
  }
  if (walls.arena == Arena::kChannel) {  // its ends are out of sight
    cairo_rectangle(cr, plane.box().x - reach, middle.y() - reach, plane.box().width + 2 * reach, 2 * reach);
    return;
  }
  const double end = walls.has_length() ? walls.length / 2 * plane.scale() : 0.0;
  cairo_new_sub_path(cr);
  if (walls.arena == Arena::kWedge) {
    const double narrow = walls.narrow / 2 * plane.scale();
    cairo_move_to(cr, middle.x() - end, middle.y() - reach);
    cairo_line_to(cr, middle.x() + end, middle.y() - narrow);
    cairo_line_to(cr, middle.x() + end, middle.y() + narrow);
    cairo_line_to(cr, middle.x() - end, middle.y() + reach);
    cairo_close_path(cr);
    return;
  }
  if (walls.arena == Arena::kEllipse) {
    cairo_save(cr);
    cairo_translate(cr, middle.x(), middle.y());
    cairo_scale(cr, end, reach);
    cairo_arc(cr, 0, 0, 1, 0, 2 * kPi);
    cairo_restore(cr);
    return;
  }
  cairo_arc(cr, middle.x() + end, middle.y(), reach, -kPi / 2, kPi / 2);
  cairo_arc(cr, middle.x() - end, middle.y(), reach, kPi / 2, 3 * kPi / 2);
  cairo_close_path(cr);
  if (walls.arena != Arena::kAnnulus) return;
  cairo_new_sub_path(cr);
  cairo_arc(cr, middle.x(), middle.y(), walls.inner / 2 * plane.scale(), 0, 2 * kPi);
}

void draw_walls(const Canvas& canvas, const Plane& plane, const Cell& cell, const PageColours& colours, double unit,
                bool has_ground) {
  cairo_t* cr = canvas.cairo();
  cairo_rectangle(cr, plane.box().x, plane.box().y, plane.box().width, plane.box().height);
  arena_path(cr, plane, *cell.walls, cell.box);
  cairo_set_fill_rule(cr, CAIRO_FILL_RULE_EVEN_ODD);
  if (has_ground) {
    canvas.colour(colours.walls);
    cairo_fill(cr);
  }
  cairo_new_path(cr);
  cairo_set_fill_rule(cr, CAIRO_FILL_RULE_WINDING);
  arena_path(cr, plane, *cell.walls, cell.box);
  canvas.colour(colours.ink);
  cairo_set_line_width(cr, 1.5 * unit);
  cairo_stroke(cr);
}

void draw_posts(const Canvas& canvas, const Plane& plane, const StandingPosts& posts, const PageColours& colours,
                double unit, bool has_ground) {
  cairo_t* cr = canvas.cairo();
  const double radius = 0.5 * posts.diameter;
  cairo_set_line_width(cr, 1.5 * unit);
  for (const Vec2& centre : posts.centres) {
    for_images(plane.view(), centre, radius, [&](const Vec2& at) {
      const Vec2 middle = plane.pixel(at);
      cairo_new_path(cr);
      cairo_arc(cr, middle.x(), middle.y(), radius * plane.scale(), 0, 2 * kPi);
      canvas.colour(colours.walls);
      if (has_ground) cairo_fill_preserve(cr);
      canvas.colour(colours.ink);
      cairo_stroke(cr);
    });
  }
}

/// The points of all lines so far, found by place. Periodic.
class Occupied {
 public:
  Occupied(const Box& box, double distance)
      : box_(box), columns_(cells_along(box.x(), distance)), rows_(cells_along(box.y(), distance)) {
    in_cell_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  }

  void add(const Vec2& place) { cell(column(place), row(place)).push_back(wrapped(place)); }
  /// Whether a point lies nearer to `place` than `distance`, which is at most that given at the beginning.
  bool is_near(const Vec2& place, double distance) const {
    const Vec2 here = wrapped(place);
    const auto reach = [](int cells) { return std::min(1, (cells - 1) / 2); };
    for (int dj = -reach(rows_); dj <= reach(rows_); ++dj) {
      for (int di = -reach(columns_); di <= reach(columns_); ++di) {
        for (const Vec2& point : cell(column(here) + di, row(here) + dj)) {
          const Vec2 d = point - here;
          const Vec2 nearest(analysis::wrapped_difference(d.x(), box_.x()),
                             analysis::wrapped_difference(d.y(), box_.y()));
          if (nearest.squaredNorm() < distance * distance) return true;
        }
      }
    }
    return false;
  }

 private:
  static int cells_along(double side, double distance) {
    const int cells = static_cast<int>(side / distance);
    return cells < 3 ? 1 : cells;  // of two, each would be the other's neighbour on both sides
  }
  static int cell_along(double x, double side, int cells) {
    return std::min(static_cast<int>(analysis::wrapped(x, side) / side * cells), cells - 1);
  }
  Vec2 wrapped(const Vec2& place) const {
    return {analysis::wrapped(place.x(), box_.x()), analysis::wrapped(place.y(), box_.y())};
  }
  int column(const Vec2& place) const { return cell_along(place.x(), box_.x(), columns_); }
  int row(const Vec2& place) const { return cell_along(place.y(), box_.y(), rows_); }
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>((j + rows_) % rows_) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>((i + columns_) % columns_);
  }
  std::vector<Vec2>& cell(int i, int j) { return in_cell_[index(i, j)]; }
  const std::vector<Vec2>& cell(int i, int j) const { return in_cell_[index(i, j)]; }

  Box box_;
  int columns_, rows_;
  std::vector<std::vector<Vec2>> in_cell_;
};

/// The director at `place`, to the side of `before`; nothing where there is none.
std::optional<Vec2> director_at(const analysis::DirectorField& field, const Vec2& place, const Vec2& before) {
  constexpr double kLeast = 0.05;  // of S: below that the direction is noise
  const Vec2 q = field.q_at(place);
  if (2 * q.norm() < kLeast || !is_defined(field, place)) return std::nullopt;
  const double theta = std::atan2(q.y(), q.x()) / 2;
  const Vec2 n(std::cos(theta), std::sin(theta));
  return n.dot(before) < 0 ? Vec2(-n) : n;
}

void draw_bars(const Canvas& canvas, const Plane& plane, const analysis::DirectorField& field,
               const PageColours& colours, double unit) {
  constexpr double kAcross = 34;  // bars along each side of the view
  const View& view = plane.view();
  const double mesh = view.side / kAcross;
  cairo_t* cr = canvas.cairo();
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  const auto first = [&](double corner) { return std::floor(corner / mesh - 1); };
  for (double j = first(view.corner.y()); j * mesh < view.corner.y() + view.side; ++j) {
    for (double i = first(view.corner.x()); i * mesh < view.corner.x() + view.side; ++i) {
      const Vec2 place((i + 0.5) * mesh, (j + 0.5) * mesh);
      const std::optional<Vec2> n = director_at(field, place, Vec2(1, 0));
      if (!n) continue;
      const Vec2 from = plane.pixel(place - view.corner - 0.36 * mesh * *n);
      const Vec2 to = plane.pixel(place - view.corner + 0.36 * mesh * *n);
      canvas.colour(colours.ink, 0.25 + 0.75 * std::min(1.0, 2 * field.q_at(place).norm()));
      canvas.line(from.x(), from.y(), to.x(), to.y(), 2 * unit);
    }
  }
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
}

void draw_streamlines(const Canvas& canvas, const Plane& plane, const analysis::DirectorField& field,
                      const PageColours& colours, double unit) {
  cairo_t* cr = canvas.cairo();
  canvas.colour(colours.ink, 0.8);
  cairo_set_line_width(cr, 1.3 * unit);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  for (const Streamline& line : streamlines(field, plane.view().side / 44)) {
    Vec2 low = line.front(), high = line.front();
    for (const Vec2& point : line) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
    const Vec2 middle = (low + high) / 2;
    View view = plane.view();
    // the field goes on beyond the box, also where rods do not
    view.period = field.region().period();
    for_images(view, middle, (high - low).maxCoeff() / 2, [&](const Vec2& at) {
      for (const Vec2& point : line) {
        const Vec2 p = plane.pixel(at + point - middle);
        cairo_line_to(cr, p.x(), p.y());
      }
      cairo_stroke(cr);
    });
  }
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
}

/// The outline of a rod as it is seen from above, its beads being discs on a line that is `flat` times as long as the
/// rod: of one side, from tail to head, the place along that line and the half width.
std::vector<Vec2> half_outline(BeadRow beads, double flat) {
  constexpr int kSlices = 60;
  for (double& offset : beads.offset) offset *= flat;
  const double tail = beads.tail(), head = beads.head();
  std::vector<Vec2> outline;
  for (int k = 0; k <= kSlices; ++k) {
    // Closer together towards the round ends.
    const double x = (tail + head) / 2 - (head - tail) / 2 * std::cos(k * kPi / kSlices);
    double half = 0;
    for (std::size_t i = 0; i < beads.offset.size(); ++i) {
      const double d = x - beads.offset[i], square = beads.radius[i] * beads.radius[i] - d * d;
      if (square > 0) half = std::max(half, std::sqrt(square));
    }
    outline.emplace_back(x, half);
  }
  return outline;
}

}  // namespace

void draw_ground(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style) {
  const Plane plane(canvas, layout, picture, style);
  const PageColours colours = ground_colours(style);
  canvas.colour(colours.floor);
  if (!style.transparent || style.ground) canvas.fill(plane.box());
  if (style.background == Background::kOrder && picture.found.field)
    draw_order(canvas, plane, *picture.found.field, style.theme);
  const bool has_ground = !style.transparent || style.ground;
  if (picture.cell.walls) draw_walls(canvas, plane, picture.cell, colours, layout.unit, has_ground);
  draw_posts(canvas, plane, picture.cell.posts, colours, layout.unit, has_ground);
}

void draw_flat_rods(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style) {
  const Plane plane(canvas, layout, picture, style);
  const PageColours colours = page_colours(style.theme);
  const Colouring& colouring = colouring_of(picture, style);
  const Vec2 range = range_of(colouring, style);
  cairo_t* cr = canvas.cairo();
  cairo_set_line_width(cr, 0.5 * layout.unit);
  for (std::size_t i = 0; i < picture.n_rods(); ++i) {
    const Vec3& n = picture.frame.director[i];
    const double flat = n.head<2>().norm();
    const Vec2 along = flat > 1e-6 ? Vec2(n.head<2>() / flat) : Vec2(1, 0), across(-along.y(), along.x());
    const std::vector<Vec2> outline = half_outline(picture.cell.beads_of(i), flat);
    const Colour colour = rod_colour(picture, i, colouring, range, style.palette);
    for_images(plane.view(), picture.frame.position[i].head<2>(), std::abs(outline.front().x()) + outline.back().x(),
               [&](const Vec2& at) {
                 const auto add = [&](const Vec2& point, double side) {
                   const Vec2 p = plane.pixel(at + point.x() * along + side * point.y() * across);
                   cairo_line_to(cr, p.x(), p.y());
                 };
                 for (const Vec2& point : outline) add(point, 1);
                 for (auto point = outline.rbegin(); point != outline.rend(); ++point) add(*point, -1);
                 cairo_close_path(cr);
                 canvas.colour(colour, style.rods);
                 cairo_fill_preserve(cr);
                 canvas.colour(colours.ink, 0.6 * style.rods);
                 cairo_stroke(cr);
               });
  }
}

void draw_lines(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style) {
  if (style.lines == FieldLines::kNone || !picture.found.field) return;
  const Plane plane(canvas, layout, picture, style);
  (style.lines == FieldLines::kBars ? draw_bars : draw_streamlines)(canvas, plane, *picture.found.field,
                                                                    page_colours(style.theme), layout.unit);
}

void draw_tracks(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style) {
  const Plane plane(canvas, layout, picture, style);
  for (const DefectTrail& trail : picture.found.tracks) {
    const Colour colour = diverging_colour(trail.charge > 0 ? 1 : -1);
    const auto width_at = [&](double age) { return (2 + 3 * (1 - age)) * layout.unit; };
    for (std::size_t k = 1; k < trail.places.size(); ++k) {
      const DefectTrail::Place& from = trail.places[k - 1];
      const DefectTrail::Place& to = trail.places[k];
      const double age = (from.age + to.age) / 2;
      const Vec2 middle = (from.position + to.position) / 2, half = (to.position - from.position) / 2;
      for_images(plane.view(), middle, half.norm() + width_at(age) / plane.scale(), [&](const Vec2& at) {
        const Vec2 a = plane.pixel(at - half), b = plane.pixel(at + half);
        canvas.colour(colour, 0.85 * (1 - age));
        canvas.line(a.x(), a.y(), b.x(), b.y(), width_at(age));
      });
    }
  }
}

void draw_defects(const Canvas& canvas, const Layout& layout, const RodPicture& picture, const PictureStyle& style) {
  const Plane plane(canvas, layout, picture, style);
  const double unit = layout.unit * std::min(std::sqrt(std::max(style.zoom, 1.0)), 2.0);
  for (const analysis::Defect& defect : picture.found.defects) {
    for_images(plane.view(), defect.position, kMarkReach * unit / plane.scale(), [&](const Vec2& at) {
      const Vec2 p = plane.pixel(at);
      (defect.charge > 0 ? draw_plus_half : draw_minus_half)(canvas, p.x(), p.y(), defect.direction, unit);
    });
  }
}

void draw_displacements(const Canvas& canvas, const Layout& layout, const RodPicture& picture,
                        const PictureStyle& style) {
  const Plane plane(canvas, layout, picture, style);
  cairo_t* cr = canvas.cairo();
  const double unit = layout.unit * std::min(std::sqrt(std::max(style.zoom, 1.0)), 2.0);
  const double longest_head = 6 * unit, thickness = 1.3 * unit;
  const Colour ink = page_colours(style.theme).ink, page = page_colours(style.theme).page;
  for (std::size_t i = 0; i < picture.frame.displacement.size(); ++i) {
    const Vec2 way = picture.frame.displacement[i], middle = picture.frame.position[i].head<2>() - way / 2;
    const double length = way.norm() * plane.scale();  // [pixels]
    // A way through many boxes would be drawn in many pieces, and shows nothing.
    if (!(length >= 1) || way.norm() > 3 * picture.cell.box.longer()) continue;  // nor has one that is not known
    const double head = std::min(longest_head, length / 2);
    for_images(plane.view(), middle, way.norm() / 2 + longest_head / plane.scale(), [&](const Vec2& at) {
      const Vec2 tail = plane.pixel(at - way / 2), tip = plane.pixel(at + way / 2);
      const Vec2 along = (tip - tail) / length, across(-along.y(), along.x());
      // a rim of the page's colour keeps them apart from rods of any colour
      for (const bool rim : {true, false}) {
        canvas.colour(rim ? page : ink, rim ? 0.7 : 1);
        canvas.line(tail.x(), tail.y(), (tip - head * along).x(), (tip - head * along).y(),
                    thickness + (rim ? 2 : 0) * unit);
        const double rest = rim ? unit : 0;
        const Vec2 left = tip - (head + rest) * along + (0.45 * head + rest) * across,
                   right = tip - (head + rest) * along - (0.45 * head + rest) * across;
        cairo_move_to(cr, tip.x() + rest * along.x(), tip.y() + rest * along.y());
        cairo_line_to(cr, left.x(), left.y());
        cairo_line_to(cr, right.x(), right.y());
        cairo_close_path(cr);
        cairo_fill(cr);
      }
    });
  }
}

std::vector<Streamline> streamlines(const analysis::DirectorField& field, double distance) {
  const Box& box = field.region().box();
  const double step = distance / 4, near = distance / 2;
  const auto most = static_cast<std::size_t>(2 * box.longer() / step);  // steps of one line to either side
  constexpr std::size_t kOwn = 6;  // steps along a line that may be near to each other
  Occupied occupied(box, distance);
  std::vector<Streamline> lines;

  // From `seed` along `direction`, without the seed itself.
  const auto follow = [&](const Vec2& seed, const Vec2& direction, const Streamline& other_half) {
    Streamline line;
    Vec2 at = seed, before = direction;
    while (line.size() < most) {
      const std::optional<Vec2> here = director_at(field, at, before);
      if (!here) break;
      const std::optional<Vec2> half_way = director_at(field, at + step / 2 * *here, *here);
      if (!half_way) break;
      const Vec2 next = at + step * *half_way;
      if (occupied.is_near(next, near)) break;
      // A line that comes back to itself is closed enough.
      const auto meets = [&](const Streamline& part, std::size_t spared) {
        if (part.size() <= spared) return false;
        return std::any_of(part.begin(), part.end() - static_cast<std::ptrdiff_t>(spared), [&](const Vec2& point) {
          const Vec2 d(std::remainder(point.x() - next.x(), box.x()), std::remainder(point.y() - next.y(), box.y()));
          return d.squaredNorm() < near * near;
        });
      };
      if (meets(line, kOwn)) break;
      if (!other_half.empty() && line.size() > kOwn && meets(other_half, 0)) break;
      line.push_back(next);
      at = next;
      before = *half_way;
    }
    return line;
  };
  std::deque<std::size_t> to_surround;
  const auto begin_at = [&](const Vec2& seed) {
    if (occupied.is_near(seed, 0.99 * distance)) return;
    const std::optional<Vec2> n = director_at(field, seed, Vec2(1, 0));
    if (!n) return;
    const Streamline ahead = follow(seed, *n, {});
    Streamline line = follow(seed, -*n, ahead);
    std::reverse(line.begin(), line.end());
    line.push_back(seed);
    line.insert(line.end(), ahead.begin(), ahead.end());
    if (line.size() < 8) return;
    for (const Vec2& point : line) occupied.add(point);
    to_surround.push_back(lines.size());
    lines.push_back(std::move(line));
  };
  const auto surround = [&] {
    while (!to_surround.empty()) {
      const Streamline line = lines[to_surround.front()];
      to_surround.pop_front();
      for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        const Vec2 along = (line[k + 1] - line[k]).normalized();
        for (const double to : {-1.0, 1.0}) begin_at(line[k] + to * distance * Vec2(-along.y(), along.x()));
      }
    }
  };
  const auto seeds_along = [distance](double side) { return std::max(1, static_cast<int>(side / distance)); };
  const int columns = seeds_along(box.x()), rows = seeds_along(box.y());
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      begin_at({box.x() / columns * (i + 0.5), box.y() / rows * (j + 0.5)});
      surround();
    }
  }
  return lines;
}

}  // namespace shaken::render
