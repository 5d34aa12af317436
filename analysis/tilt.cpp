#include "analysis/tilt.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "analysis/bins.h"
#include "analysis/errors/jackknife.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

/// A bin counts as moving if its velocity is more than this many of its errors.
constexpr double kSignificant = 3.0;
/// Bins whose velocities differ by less than this many errors may stand in either order.
constexpr double kAlike = 2.0;

/// The least share of the samples with which a bin may be the fastest: the tail at the largest tilts is a few rods, and
/// the largest of many bins is by chance one of those that know least.
constexpr double kLeastShare = 0.01;

/// A bin of n_z > 0 and its mirror image, from all rods in either.
struct Folded {
  std::vector<double> n_z, v_along, density;
};

/// All bins with n_z > 0, also those without samples, whose velocity is NaN.
Folded fold(const TiltVelocity& part) {
  const TiltMeans means = part.means();
  Folded folded;
  const std::size_t n = means.n_z.size();
  for (std::size_t up = (n + 1) / 2; up < n; ++up) {
    const std::size_t down = n - 1 - up;
    const double density = means.density[up] + means.density[down];
    const double sum = (means.density[up] > 0 ? means.density[up] * means.v_along[up] : 0.0) -
                       (means.density[down] > 0 ? means.density[down] * means.v_along[down] : 0.0);
    folded.n_z.push_back(means.n_z[up]);
    folded.v_along.push_back(sum / density);
    folded.density.push_back(density);
  }
  return folded;
}

/// The folded curve, with errors where enough blocks met the bin, or its mirror image.
FoldedTilt folded_curve(const TiltVelocity& empty, const std::vector<TiltVelocity>& blocks) {
  TiltVelocity all = empty;
  for (const TiltVelocity& block : blocks) all.merge(block);
  const Folded means = fold(all);
  const std::vector<Estimate> v = jackknife(empty, blocks, [](const TiltVelocity& part) { return fold(part).v_along; });
  const std::vector<std::size_t> met = blocks_met(blocks);
  FoldedTilt folded;
  for (std::size_t i = 0; i < means.n_z.size(); ++i) {
    if (!(means.density[i] > 0)) continue;
    const std::size_t up = met.size() - means.n_z.size() + i, down = met.size() - 1 - up;
    const bool known = std::max(met[up], met[down]) >= kFewestParts;
    folded.n_z.push_back(means.n_z[i]);
    folded.v_along.push_back(known ? v[i] : Estimate{v[i].value});
    folded.density.push_back(means.density[i]);
  }
  return folded;
}

/// Where the velocity changes sign between the folded bins `below` and the next, and its mean beyond that.
std::vector<double> crossing(const TiltVelocity& part, double below, double sign) {
  const Folded folded = fold(part);
  std::size_t i = 0;
  while (i + 1 < folded.n_z.size() && folded.n_z[i] < below) ++i;
  double sum = 0, density = 0;
  for (std::size_t j = i + 1; j < folded.n_z.size(); ++j) {
    if (!(folded.density[j] > 0)) continue;
    sum -= sign * folded.density[j] * folded.v_along[j];
    density += folded.density[j];
  }
  std::size_t next = i + 1;
  while (next < folded.n_z.size() && !(folded.density[next] > 0)) ++next;
  if (next >= folded.n_z.size()) return {kNaN, kNaN};
  const double share = folded.v_along[i] / (folded.v_along[i] - folded.v_along[next]);
  return {folded.n_z[i] + share * (folded.n_z[next] - folded.n_z[i]), sum / density};
}

/// Whether each bin has enough of the samples to be the fastest.
std::vector<bool> have_enough(const FoldedTilt& folded) {
  const double all = std::accumulate(folded.density.begin(), folded.density.end(), 0.0);
  std::vector<bool> enough;
  for (const double density : folded.density) enough.push_back(density >= kLeastShare * all);
  return enough;
}

/// The place of `largest` among bins that may be larger by chance.
Estimate place_of(const FoldedTilt& folded, const std::vector<bool>& enough, std::size_t largest, double width) {
  const Estimate& v = folded.v_along[largest];
  double from = folded.n_z[largest], to = from;
  for (std::size_t i = 0; i < folded.n_z.size(); ++i) {
    if (!enough[i]) continue;
    const Estimate& other = folded.v_along[i];
    const double less = std::abs(v.value) - (v.value > 0 ? other.value : -other.value);
    if (!(less < kAlike * std::hypot(v.sem, other.sem))) continue;
    from = std::min(from, folded.n_z[i]);
    to = std::max(to, folded.n_z[i]);
  }
  return {folded.n_z[largest], (to - from + width) / std::sqrt(12.0), v.n_effective, v.steady};
}

}  // namespace

TiltVelocity::TiltVelocity(int bins, double n_z_max) : n_z_max_(n_z_max) {
  SHAKEN_CHECK(bins >= 1, "a histogram needs a bin");
  SHAKEN_CHECK(n_z_max > 0.0, "the range of n_z must not be empty");
  const auto n = static_cast<std::size_t>(bins);
  counts_.resize(n);
  along_.resize(n);
  across_.resize(n);
}

void TiltVelocity::accumulate(std::span<const Vec3> directors, std::span<const Vec3> velocities) {
  SHAKEN_CHECK(directors.size() == velocities.size(), "one velocity for each director");
  const double bins_per_unit = static_cast<double>(counts_.size()) / (2.0 * n_z_max_);
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const Vec3& n = directors[i];
    const Vec3& v = velocities[i];
    const double n_xy = std::hypot(n.x(), n.y());
    if (n_xy == 0.0) continue;
    if (std::abs(n.z()) > n_z_max_) {
      ++outside_;
      continue;
    }
    const auto place = static_cast<std::size_t>((n.z() + n_z_max_) * bins_per_unit);
    const std::size_t bin = std::min(place, counts_.size() - 1);  // n_z_max itself belongs to the last bin
    ++counts_[bin];
    along_[bin] += (v.x() * n.x() + v.y() * n.y()) / n_xy;
    across_[bin] += (v.y() * n.x() - v.x() * n.y()) / n_xy;
  }
}

TiltMeans TiltVelocity::means() const {
  double total = static_cast<double>(outside_);
  for (const std::int64_t count : counts_) total += static_cast<double>(count);
  const double width = 2.0 * n_z_max_ / static_cast<double>(counts_.size());
  TiltMeans means;
  means.n_z = middles_of_bins(counts_.size(), width, -n_z_max_);
  for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
    const auto n = static_cast<double>(counts_[bin]);
    means.v_along.push_back(mean_of(along_[bin], n));
    means.v_across.push_back(mean_of(across_[bin], n));
    means.density.push_back(total > 0 ? n / (total * width) : 0.0);
  }
  return means;
}

TiltCurve TiltVelocity::reduce(const TiltVelocity& empty, const std::vector<TiltVelocity>& blocks) {
  TiltVelocity all = empty;
  for (const TiltVelocity& block : blocks) all.merge(block);
  const std::vector<Estimate> estimates = jackknife(empty, blocks, [](const TiltVelocity& part) {
    TiltMeans means = part.means();
    means.v_along.insert(means.v_along.end(), means.v_across.begin(), means.v_across.end());
    return means.v_along;
  });
  TiltCurve curve{all.means(), {}, {}};
  const std::vector<std::size_t> met = blocks_met(blocks);
  const std::size_t bins = curve.n_z.size();
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const bool known = !met.empty() && met[bin] >= kFewestParts;
    curve.v_along_sem.push_back(known ? estimates[bin].sem : kNaN);
    curve.v_across_sem.push_back(known ? estimates[bins + bin].sem : kNaN);
  }
  return curve;
}

std::vector<std::size_t> blocks_met(const std::vector<TiltVelocity>& blocks) {
  std::vector<std::size_t> met;
  for (const TiltVelocity& block : blocks) {
    const std::vector<double> density = block.means().density;
    met.resize(density.size());
    for (std::size_t bin = 0; bin < met.size(); ++bin) met[bin] += density[bin] > 0 ? 1 : 0;
  }
  return met;
}

TiltSummary summarize_tilt(const TiltVelocity& empty, const std::vector<TiltVelocity>& blocks) {
  TiltSummary summary;
  if (blocks.empty()) return summary;
  summary.folded = folded_curve(empty, blocks);
  const std::vector<double>& n_z = summary.folded.n_z;
  const std::vector<Estimate>& v = summary.folded.v_along;
  const std::vector<bool> enough = have_enough(summary.folded);
  std::optional<std::size_t> largest;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (!enough[i] || !(std::abs(v[i].value) > kSignificant * v[i].sem)) continue;
    if (!largest || std::abs(v[i].value) > std::abs(v[*largest].value)) largest = i;
  }
  if (!largest) return summary;
  const std::vector<double> centres = empty.means().n_z;
  summary.v_largest = v[*largest];
  summary.n_z_largest =
      place_of(summary.folded, enough, *largest, 2 * centres.back() / static_cast<double>(centres.size() - 1));

  const double sign = v[*largest].value > 0 ? 1.0 : -1.0;
  for (std::size_t i = *largest; i + 1 < v.size(); ++i) {
    if (!(sign * v[i].value > 0 && sign * v[i + 1].value <= 0)) continue;
    const std::vector<Estimate> found =
        jackknife(empty, blocks, [&](const TiltVelocity& part) { return crossing(part, n_z[i] * (1 - 1e-9), sign); });
    const double sigma = found[1].value / found[1].sem;
    if (std::isnan(sigma)) continue;
    if (std::isnan(summary.zero_sigma) || sigma > summary.zero_sigma) {
      summary.n_z_zero = found[0];
      summary.zero_sigma = sigma;
    }
  }
  return summary;
}

double largest_tilt(double half_length, double end_radius, double gap) {
  return half_length > 0 ? std::clamp((gap / 2 - end_radius) / half_length, 0.0, 1.0) : 1.0;
}

TiltSwitches::TiltSwitches(double threshold) : threshold_(threshold) {
  SHAKEN_CHECK(threshold > 0, "between up and down there is something");
}

void TiltSwitches::accumulate(double time, std::span<const Vec3> directors) {
  SHAKEN_CHECK(time > last_time_, "samples must come in order of time");
  const bool first = !std::isfinite(last_time_);
  if (first) sides_.assign(directors.size(), 0);
  SHAKEN_CHECK(sides_.size() == directors.size(), "as many rods as before");
  SwitchSums sums;
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const double n_z = directors[i].z();
    const std::int64_t before = sides_[i];
    if (before != 0) sums.lived += time - last_time_;
    if (std::abs(n_z) <= threshold_) continue;
    sides_[i] = n_z > 0 ? 1 : -1;
    if (before != 0 && sides_[i] != before) sums.switches += 1;
  }
  blocks_.accumulate(time, sums);
  last_time_ = time;
}

double TiltSwitches::switching_time(const SwitchSums& sums) { return mean_of(sums.lived, sums.switches); }

}  // namespace shaken::analysis
