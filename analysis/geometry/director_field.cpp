#include "analysis/geometry/director_field.h"

#include <algorithm>
#include <cmath>

#include "analysis/geometry/periodic.h"
#include "base/core/box_grids.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// The Gaussian is cut here, in standard deviations.
constexpr double kCut = 4.0;

/// i modulo n, in [0, n).
int wrapped(int i, int n) {
  const int remainder = i % n;
  return remainder < 0 ? remainder + n : remainder;
}

/// The grid lines that one place reaches in one direction, and their weights.
struct Reach {
  std::vector<int> node;
  std::vector<double> weight;
};

/// `place` in meshes; lines beyond the border are those of the other side, or none.
void fill_reach(Reach& reach, double place, double mesh, int n, double smoothing, bool periodic) {
  reach.node.clear();
  reach.weight.clear();
  // At most n lines, the nearest ones: in a small box each line is then met by the nearest image only.
  const double half_width = std::min(kCut * smoothing / mesh, periodic ? 0.5 * n : 2.0 * n);
  const auto first = static_cast<int>(std::ceil(place - half_width));
  int last = static_cast<int>(std::floor(place + half_width));
  if (periodic) last = std::min(last, first + n - 1);
  for (int i = first; i <= last; ++i) {
    if (!periodic && (i < 0 || i >= n)) continue;
    const double distance = (i - place) * mesh / smoothing;
    reach.node.push_back(wrapped(i, n));
    reach.weight.push_back(std::exp(-0.5 * distance * distance));
  }
}

/// What the Gaussian about each node finds of the nodes within the region (rows * columns).
std::vector<double> covered(const std::vector<bool>& inside, const Grid& grid, const Vec2& mesh, double smoothing,
                            const std::array<bool, 2>& periodic) {
  const auto m = static_cast<std::size_t>(grid.columns), n = static_cast<std::size_t>(grid.rows);
  std::vector<double> rows(m * n, 0.0), all(m * n, 0.0);
  Reach reach;
  for (std::size_t i = 0; i < m; ++i) {
    fill_reach(reach, static_cast<double>(i), mesh.x(), grid.columns, smoothing, periodic[0]);
    for (std::size_t k = 0; k < reach.node.size(); ++k) {
      const auto from = static_cast<std::size_t>(reach.node[k]);
      for (std::size_t j = 0; j < n; ++j) {
        if (inside[j * m + from]) rows[j * m + i] += reach.weight[k];
      }
    }
  }
  for (std::size_t j = 0; j < n; ++j) {
    fill_reach(reach, static_cast<double>(j), mesh.y(), grid.rows, smoothing, periodic[1]);
    for (std::size_t k = 0; k < reach.node.size(); ++k) {
      const std::size_t from = static_cast<std::size_t>(reach.node[k]) * m;
      for (std::size_t i = 0; i < m; ++i) all[j * m + i] += reach.weight[k] * rows[from + i];
    }
  }
  return all;
}

double theta_of(const Vec2& q) { return fold_half_turn(0.5 * std::atan2(q.y(), q.x())); }

}  // namespace

Grid::Grid(const Box& box, double mesh) {
  SHAKEN_CHECK(box.shorter() > 0.0 && mesh > 0.0, "box and mesh must be positive");
  SHAKEN_CHECK(box.longer() / mesh <= kMostGridNodes, "the mesh is too fine for the box");
  const Vec2 nodes = grid_nodes(box, mesh);
  columns = static_cast<int>(nodes.x());
  rows = static_cast<int>(nodes.y());
}

DirectorField::DirectorField(std::span<const Vec3> positions, std::span<const Vec3> directors, const Region& region,
                             const Grid& grid, double smoothing)
    : grid_(grid), region_(region), smoothing_(smoothing) {
  SHAKEN_CHECK(positions.size() == directors.size(), "one position for each director");
  SHAKEN_CHECK(std::min(grid.columns, grid.rows) >= 2 && smoothing > 0.0, "grid and smoothing must be positive");
  const std::size_t n_nodes = grid.nodes();
  const Vec2 box = region.box().sides(), mesh = this->mesh();
  const std::array periodic{region.period().x() > 0, region.period().y() > 0};
  q_xx_.assign(n_nodes, 0.0);
  q_xy_.assign(n_nodes, 0.0);
  std::vector<double> weight(n_nodes, 0.0);
  double rods = 0;
  Reach x, y;
  for (std::size_t i_rod = 0; i_rod < positions.size(); ++i_rod) {
    const Vec2 angle = double_angle(directors[i_rod]);
    if (angle == Vec2::Zero()) continue;
    rods += 1;
    // A Gaussian is a product, so a rod costs exponentials for its lines only, not for its nodes.
    const Vec2 at = positions[i_rod].head<2>();
    const Vec2 place = at - box.cwiseProduct(at.cwiseQuotient(box).array().floor().matrix());
    fill_reach(x, place.x() / mesh.x(), mesh.x(), grid.columns, smoothing, periodic[0]);
    fill_reach(y, place.y() / mesh.y(), mesh.y(), grid.rows, smoothing, periodic[1]);
    for (std::size_t b = 0; b < y.node.size(); ++b) {
      const std::size_t row = index(0, y.node[b]);
      for (std::size_t a = 0; a < x.node.size(); ++a) {
        const double w = x.weight[a] * y.weight[b];
        const std::size_t k = row + static_cast<std::size_t>(x.node[a]);
        weight[k] += w;
        q_xx_[k] += w * 0.5 * angle.x();
        q_xy_[k] += w * 0.5 * angle.y();
      }
    }
  }
  defined_.assign(n_nodes, true);
  if (region.has_walls()) {
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) defined_[index(i, j)] = region.contains(node(i, j));
    }
  }
  const auto inside = static_cast<double>(std::count(defined_.begin(), defined_.end(), true));
  const std::vector<double> room = covered(defined_, grid, mesh, smoothing, periodic);
  for (std::size_t k = 0; k < n_nodes; ++k) {
    if (!(weight[k] * inside >= kFloor * rods * room[k] && weight[k] > 0.0)) defined_[k] = false;
    if (weight[k] == 0.0) continue;
    q_xx_[k] /= weight[k];
    q_xy_[k] /= weight[k];
  }
}

double DirectorField::theta(int i, int j) const { return theta_of({q_xx(i, j), q_xy(i, j)}); }

Vec2 DirectorField::q_at(const Vec2& position) const {
  const Vec2 place = position.cwiseQuotient(mesh());
  const Vec2 corner(std::floor(place.x()), std::floor(place.y()));
  const Vec2 part = place - corner;
  const int i = static_cast<int>(corner.x());
  const int j = static_cast<int>(corner.y());
  const auto q = [this](int a, int b) { return Vec2(q_xx(a, b), q_xy(a, b)); };
  return (1 - part.y()) * ((1 - part.x()) * q(i, j) + part.x() * q(i + 1, j)) +
         part.y() * ((1 - part.x()) * q(i, j + 1) + part.x() * q(i + 1, j + 1));
}

std::size_t DirectorField::index(int i, int j) const {
  const Vec2 period = region_.period();
  const auto on_grid = [](int k, int n, bool periodic) {
    return static_cast<std::size_t>(periodic ? wrapped(k, n) : std::clamp(k, 0, n - 1));
  };
  return on_grid(j, grid_.rows, period.y() > 0) * static_cast<std::size_t>(grid_.columns) +
         on_grid(i, grid_.columns, period.x() > 0);
}

}  // namespace shaken::analysis
