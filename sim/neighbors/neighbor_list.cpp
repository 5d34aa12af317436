#include "sim/neighbors/neighbor_list.h"

#include <algorithm>
#include <cmath>

#include "base/core/heap_bytes.h"
#include "sim/contact/bead_contacts.h"

namespace shaken {
namespace {

/// In which direction the shadow of a rod lies; that of an upright rod fits whatever it is given.
Vec2 flat_direction(const Pose& pose) {
  const Vec2 n(pose.director.x(), pose.director.y());
  const double length = n.norm();
  return length > 0 ? Vec2(n * (1 / length)) : Vec2(1, 0);
}

}  // namespace

NeighborList::NeighborList(std::span<const Species> species, std::span<const std::uint8_t> shape_of_rod, const Box& box,
                           double skin)
    : shape_of_rod_(shape_of_rod.begin(), shape_of_rod.end()), skin_(skin), box_(box) {
  double farthest = 0;  // that two centres of a pair can be apart
  for (const Species& kind : species) {
    shadows_.push_back({kind.half_length, kind.max_radius});
    farthest = std::max(farthest, 2.0 * kind.half_length + (2.0 * kind.max_radius + skin));
  }
  // cells at least as wide; where fewer than 3 fit along a side, one of them is as long as it
  for (int c = 0; c < 2; ++c) {
    n_cells_[c] = static_cast<int>(std::floor(box[c] / farthest));
    if (n_cells_[c] < 3) n_cells_[c] = 1;
    n_images_[c] = static_cast<int>(std::floor(farthest / box[c] + 0.5));
  }
}

std::size_t NeighborList::bytes() const {
  std::size_t bytes =
      heap_bytes(shape_of_rod_, places_, cell_, members_, pairs_, unused_, pairs_of_, n_pairs_of_, mark_);
  for (const auto& members : members_) bytes += heap_bytes(members);
  return bytes;
}

void NeighborList::note_place(int i, const Pose& pose) {
  places_[i] = {{pose.position.x(), pose.position.y()}, flat_direction(pose)};
  for (int c = 0; c < 2; ++c) {
    double& x = places_[i].center[c];
    x -= box_[c] * std::floor(x / box_[c]);
  }
}

double NeighborList::slack(int i, const Pose& pose) const {
  const Vec3 from(places_[i].center.x(), places_[i].center.y(), 0);
  const Vec2 shift = nearest_image(from, pose.position, box_).head<2>();
  const Vec2 turn = shadow(i).half_length * (flat_direction(pose) - places_[i].direction);
  return 0.5 * skin_ - std::sqrt(std::max((shift + turn).squaredNorm(), (shift - turn).squaredNorm()));
}

bool NeighborList::is_due(std::span<const Pose> poses) const {
  if (places_.size() != poses.size()) return true;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (slack(static_cast<int>(i), poses[i]) < 0) return true;
  }
  return false;
}

// ---- who is near whom

int NeighborList::cell_of(const Vec2& center) const {
  const auto along = [&](int c) {
    const double x = center[c] / box_[c];
    return std::min(n_cells_[c] - 1, static_cast<int>((x - std::floor(x)) * n_cells_[c]));
  };
  return along(1) * n_cells_[0] + along(0);
}

void NeighborList::put_into_cell(int i, int cell) {
  cell_[i] = cell;
  members_[cell].push_back(i);
}

template <class Each>
void NeighborList::for_candidates(int i, const Each& each) const {
  const auto visit = [&](int cell) {
    for (const int j : members_[cell]) {
      if (j != i) each(j);
    }
  };
  const auto& [nx, ny] = n_cells_;
  const int cx = cell_[i] % nx;
  const int cy = cell_[i] / nx;
  const int wide = nx > 1 ? 1 : 0, high = ny > 1 ? 1 : 0;
  for (int dy = -high; dy <= high; ++dy) {
    const int row = (cy + dy + ny) % ny * nx;
    for (int dx = -wide; dx <= wide; ++dx) visit(row + (cx + dx + nx) % nx);
  }
}

bool NeighborList::are_near(int i, int j) const {
  const Vec2 apart = (places_[i].center - places_[j].center).cwiseAbs();
  const Vec2 in_nearest_image = apart.cwiseMin(box_.sides() - apart);
  const double centers = shadow(i).half_length + shadow(j).half_length + reach(i, j);
  if (in_nearest_image.squaredNorm() > centers * centers) return false;
  const auto level = [](const Vec2& v) { return Vec3(v.x(), v.y(), 0); };
  const Vec3 nearest = nearest_image(level(places_[i].center), level(places_[j].center), box_);
  // of two rods in a small box, it may be the ends of an image further away that come near
  for (int x = -n_images_[0]; x <= n_images_[0]; ++x) {
    for (int y = -n_images_[1]; y <= n_images_[1]; ++y) {
      if (are_near(i, j, nearest + Vec3(x * box_.x(), y * box_.y(), 0))) return true;
    }
  }
  return false;
}

bool NeighborList::are_near(int i, int j, const Vec3& D) const {
  const auto level = [](const Vec2& v) { return Vec3(v.x(), v.y(), 0); };
  const double near = reach(i, j);
  return segment_distance_squared(D, level(places_[i].direction), shadow(i).half_length, level(places_[j].direction),
                                  shadow(j).half_length) <= near * near;
}

// ---- pairs

void NeighborList::add_to(int i, int p) {
  if (static_cast<std::size_t>(n_pairs_of_[i]) == stride_) {
    const std::size_t wider = 2 * stride_;
    std::vector<int> moved(n_pairs_of_.size() * wider);
    for (std::size_t r = 0; r < n_pairs_of_.size(); ++r) {
      std::copy_n(pairs_of_.begin() + static_cast<std::ptrdiff_t>(r * stride_), n_pairs_of_[r],
                  moved.begin() + static_cast<std::ptrdiff_t>(r * wider));
    }
    pairs_of_ = std::move(moved);
    stride_ = wider;
  }
  pairs_of_[static_cast<std::size_t>(i) * stride_ + static_cast<std::size_t>(n_pairs_of_[i]++)] = p;
}

void NeighborList::remove_from(int i, int p) {
  int* const own = pairs_of_.data() + static_cast<std::size_t>(i) * stride_;
  const int last = --n_pairs_of_[i];
  *std::find(own, own + last, p) = own[last];
}

int NeighborList::add_pair(int i, int j) {
  int p = static_cast<int>(pairs_.size());
  if (unused_.empty()) {
    pairs_.emplace_back();
  } else {
    p = unused_.back();
    unused_.pop_back();
  }
  pairs_[p] = {std::min(i, j), std::max(i, j)};
  add_to(i, p);
  add_to(j, p);
  return p;
}

void NeighborList::build(std::span<const Pose> poses) {
  const int n = static_cast<int>(poses.size());
  places_.resize(n);
  cell_.resize(n);
  members_.assign(static_cast<std::size_t>(n_cells_[0]) * n_cells_[1], {});
  for (int i = 0; i < n; ++i) {
    note_place(i, poses[i]);
    put_into_cell(i, cell_of(places_[i].center));
  }
  pairs_.clear();
  unused_.clear();
  n_pairs_of_.assign(n, 0);
  pairs_of_.resize(n * stride_);
  mark_.assign(n, -1);
  std::vector<int> near;
  for (int i = 0; i < n; ++i) {
    near.clear();
    for_candidates(i, [&](int j) {
      if (j > i && are_near(i, j)) near.push_back(j);
    });
    std::sort(near.begin(), near.end());
    for (const int j : near) add_pair(i, j);
  }
}

void NeighborList::place(int i, const Pose& pose) {
  note_place(i, pose);
  const int cell = cell_of(places_[i].center);
  if (cell == cell_[i]) return;
  auto& old = members_[cell_[i]];
  *std::find(old.begin(), old.end(), i) = old.back();
  old.pop_back();
  put_into_cell(i, cell);
}

void NeighborList::find_near(int i, std::vector<int>& rods) const {
  for_candidates(i, [&](int j) { prefetch_place(j); });
  for_candidates(i, [&](int j) {
    if (are_near(i, j)) rods.push_back(j);
  });
}

void NeighborList::replace_pairs(int i, std::span<const int> near, std::vector<int>& gained, std::vector<int>& lost) {
  for (const int j : near) mark_[j] = i;
  const std::size_t first_lost = lost.size();
  for (const int p : pairs_of(i)) {
    const int j = pairs_[p].i == i ? pairs_[p].j : pairs_[p].i;
    if (mark_[j] == i) {
      mark_[j] = -1;  // has it already
    } else {
      lost.push_back(p);
    }
  }
  for (std::size_t k = first_lost; k < lost.size(); ++k) {
    Pair& pair = pairs_[lost[k]];
    remove_from(pair.i, lost[k]);
    remove_from(pair.j, lost[k]);
    pair = {};
  }
  for (const int j : near) {
    if (mark_[j] == i) gained.push_back(add_pair(i, j));
    mark_[j] = -1;
  }
  // only now, so that no number is lost and gained by the same call
  unused_.insert(unused_.end(), lost.begin() + static_cast<std::ptrdiff_t>(first_lost), lost.end());
}

}  // namespace shaken
