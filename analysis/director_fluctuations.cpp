#include "analysis/director_fluctuations.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <utility>

#include "analysis/errors/estimate_curve.h"
#include "analysis/geometry/periodic.h"
#include "base/core/check.h"

namespace shaken::analysis {
namespace {

constexpr int kMaxWave = 6;
constexpr int kSectors = 36;  // over half a turn
constexpr int kSquares = 10;  // squares of the quadrant along each axis: 6 sqrt(2) and half a square

/// K1 and K3.
struct Constants {
  double splay, bend;
  double inverse(double along2, double across2) const { return splay * across2 + bend * along2; }
};

/// Minimises sum n (R / M + ln M), R = P + floor being the power as measured and M = 1 / D + floor what it should be,
/// D = K1 q_across^2 + K3 q_along^2, by Fisher scoring; nothing if that leads nowhere.
template <class Points>
std::optional<Constants> fit_constants(const Points& points) {
  double n = 0, nq = 0;
  for (const auto& p : points) {
    n += p.samples;
    nq += p.samples * (p.power + p.floor) * (p.along2 + p.across2);
  }
  if (points.size() < 2 || !(nq > 0)) return std::nullopt;
  const auto cost = [&](const Constants& k) {
    double sum = 0;
    for (const auto& p : points) {
      const double d = k.inverse(p.along2, p.across2);
      const double expected = 1 / d + p.floor;
      if (!(d > 0 && expected > 0)) return std::numeric_limits<double>::infinity();
      sum += p.samples * ((p.power + p.floor) / expected + std::log(expected));
    }
    return sum;
  };
  Constants k{n / nq, n / nq};
  for (int iteration = 0; iteration < 200; ++iteration) {
    double g1 = 0, g3 = 0, h11 = 0, h13 = 0, h33 = 0;
    for (const auto& p : points) {
      const double d = k.inverse(p.along2, p.across2);
      const double expected = 1 / d + p.floor;
      const double slope1 = p.across2 / (d * d * expected), slope3 = p.along2 / (d * d * expected);  // of -ln M
      const double misfit = p.samples * (p.power - 1 / d) / expected;
      g1 += misfit * slope1;
      g3 += misfit * slope3;
      h11 += p.samples * slope1 * slope1;
      h13 += p.samples * slope1 * slope3;
      h33 += p.samples * slope3 * slope3;
    }
    const double determinant = h11 * h33 - h13 * h13;
    if (!(determinant > 1e-12 * h11 * h33)) return std::nullopt;  // all q in one direction
    const double step1 = -(h33 * g1 - h13 * g3) / determinant;
    const double step3 = -(h11 * g3 - h13 * g1) / determinant;
    const double change = std::max(std::abs(step1 / k.splay), std::abs(step3 / k.bend));
    if (change <= 1e-9) return k;
    if (change <= 1e-5) {  // the cost is too flat here to tell better from worse
      k = {k.splay + step1, k.bend + step3};
      continue;
    }
    const double now = cost(k);
    double fraction = 1;
    Constants next{};
    do {
      next = {k.splay + fraction * step1, k.bend + fraction * step3};
      fraction /= 2;
    } while (!(cost(next) <= now) && fraction > 1e-12);
    if (fraction <= 1e-12) return k;  // as low as rounding lets it get
    k = next;
  }
  return std::nullopt;
}

constexpr std::size_t kRow = 2 * kMaxWave + 1;

/// Sums of exp(-2 pi i (m x + n y)) for m = -6 .. 6, n = 0 .. 6, as [n][m + 6].
struct Waves {
  std::array<std::array<double, kRow>, kMaxWave + 1> re{}, im{};

  /// The waves at one place (in units of the box), as products of powers of exp(-2 pi i x) and exp(-2 pi i y).
  struct Row {
    explicit Row(const Vec2& place) {
      const std::complex<double> x = std::polar(1.0, -2 * kPi * place.x());
      const std::complex<double> y = std::polar(1.0, -2 * kPi * place.y());
      std::complex<double> power = 1.0;
      for (std::size_t m = 0; m <= kMaxWave; ++m, power *= x) {
        x_re[kMaxWave + m] = x_re[kMaxWave - m] = power.real();
        x_im[kMaxWave + m] = power.imag();
        x_im[kMaxWave - m] = -power.imag();
      }
      power = 1.0;
      for (std::size_t n = 0; n <= kMaxWave; ++n, power *= y) {
        y_re[n] = power.real();
        y_im[n] = power.imag();
      }
    }
    std::array<double, kRow> x_re{}, x_im{};
    std::array<double, kMaxWave + 1> y_re{}, y_im{};
  };
  void add(const Row& row, double weight) {
    for (std::size_t n = 0; n <= kMaxWave; ++n) {
      const double c = weight * row.y_re[n], s = weight * row.y_im[n];
      for (std::size_t m = 0; m < kRow; ++m) {
        re[n][m] += row.x_re[m] * c - row.x_im[m] * s;
        im[n][m] += row.x_re[m] * s + row.x_im[m] * c;
      }
    }
  }
  double square(std::size_t n, std::size_t m) const { return re[n][m] * re[n][m] + im[n][m] * im[n][m]; }
};

/// The index of the other place that is nearest to each, in the periodic unit square; its own if there is no other.
std::vector<std::size_t> nearest_of_each(const std::vector<Vec2>& places) {
  const int side = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(places.size()))));
  const auto cell_at = [side](const Vec2& place) {
    const auto index = [side](double x) { return std::min(static_cast<int>(x * side), side - 1); };
    return std::pair(index(place.x()), index(place.y()));
  };
  std::vector<std::vector<std::size_t>> cells(static_cast<std::size_t>(side * side));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [x, y] = cell_at(places[i]);
    cells[static_cast<std::size_t>(y * side + x)].push_back(i);
  }
  std::vector<std::size_t> nearest(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [x, y] = cell_at(places[i]);
    double best = std::numeric_limits<double>::infinity();
    nearest[i] = i;
    // Rings of cells round its own, until what lies beyond them is further away than what was found.
    for (int ring = 0; 2 * ring <= side + 1 && best * side * side > (ring - 1) * std::abs(ring - 1); ++ring) {
      for (int dy = -ring; dy <= ring; ++dy) {
        const int step = std::abs(dy) == ring ? 1 : std::max(1, 2 * ring);
        for (int dx = -ring; dx <= ring; dx += step) {
          const int cx = (x + dx + 2 * side) % side, cy = (y + dy + 2 * side) % side;
          for (const std::size_t j : cells[static_cast<std::size_t>(cy * side + cx)]) {
            Vec2 d = (places[j] - places[i]).cwiseAbs();
            d = d.cwiseMin(Vec2::Ones() - d);
            if (j != i && d.squaredNorm() < best) {
              best = d.squaredNorm();
              nearest[i] = j;
            }
          }
        }
      }
    }
  }
  return nearest;
}

}  // namespace

DirectorFluctuations::DirectorFluctuations(double box_side, double q_max) : box_side_(box_side), q_max_(q_max) {
  SHAKEN_CHECK(box_side > 0 && q_max > 0, "a box and wave vectors must not be empty");
}

void DirectorFluctuations::accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors) {
  SHAKEN_CHECK(positions.size() == directors.size(), "one position for each director");
  std::vector<Vec2> places, angles;
  Vec2 axis = Vec2::Zero();
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const Vec2 angle = double_angle(directors[i]);
    if (!angle.allFinite() || angle == Vec2::Zero() || !positions[i].head<2>().allFinite()) continue;
    places.emplace_back(positions[i].head<2>() / box_side_);
    places.back() -= places.back().array().floor().matrix();
    angles.push_back(angle);
    axis += angle;
  }
  const auto n = static_cast<double>(places.size());
  if (places.empty() || axis.norm() < kMinOrder * n) return;
  const double order = axis.norm() / n;
  axis.normalize();

  std::vector<double> s;
  double squares = 0;  // <s^2>
  for (const Vec2& angle : angles) {
    s.push_back((angle.y() * axis.x() - angle.x() * axis.y()) / (2 * order));
    squares += s.back() * s.back() / n;
  }
  Waves wave{}, density{}, apart{};
  double shared = 0;  // <s s'>
  const std::vector<std::size_t> nearest = nearest_of_each(places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Waves::Row row(places[i]);
    wave.add(row, s[i]);
    density.add(row, 1);
    if (places.size() < 2) continue;
    apart.add(Waves::Row(places[nearest[i]] - places[i]), 1 / n);
    shared += s[i] * s[nearest[i]] / n;
  }

  const double area = box_side_ * box_side_;
  std::array<double, kModes> powers{};
  double structure = 0, unshared_power = 0, unshared = 0;  // sums over both signs of q, the first their mean
  std::size_t mode = 0;
  static_assert(2 * kModes + 1 == kRow * kRow);
  for (std::size_t k = 0; k <= kMaxWave; ++k) {
    for (std::size_t m = k == 0 ? kMaxWave + 1 : 0; m < kRow; ++m, ++mode) {
      powers[mode] = area * wave.square(k, m) / (n * n);
      structure += density.square(k, m) / n / kModes;
      unshared_power += 2 * powers[mode] * (1 - apart.re[k][m]);
      unshared += 2 * (1 - apart.re[k][m]);
    }
  }
  const double even = n < 4 * kModes ? 0.0 : 1 - structure;
  const double floor = (area * (squares - even * shared) - even * unshared_power) / (n - even * unshared);

  const double theta = 0.5 * std::atan2(axis.y(), axis.x());
  const auto place = static_cast<std::int64_t>(std::floor((theta / kPi + 0.5) * kSectors));
  Sector& sector = sector_at(std::clamp<std::int64_t>(place, 0, kSectors - 1));
  ++sector.samples;
  sector.cosine += axis.x();
  sector.sine += axis.y();
  sector.floor += floor;
  for (std::size_t k = 0; k < powers.size(); ++k) sector.power[k] += powers[k] - floor;
}

DirectorFluctuations::Sector& DirectorFluctuations::sector_at(std::int64_t place) {
  auto at = std::ranges::lower_bound(sectors_, place, {}, &Sector::place);
  if (at == sectors_.end() || at->place != place) at = sectors_.insert(at, Sector{});
  at->place = place;
  return *at;
}

void DirectorFluctuations::merge(const DirectorFluctuations& other) {
  SHAKEN_CHECK(box_side_ == other.box_side_, "fluctuations in different boxes");
  for (const Sector& from : other.sectors_) sector_at(from.place).merge(from);
}

std::vector<DirectorFluctuations::Point> DirectorFluctuations::points() const {
  std::vector<Point> points;
  const double unit = 2 * kPi / box_side_;
  for (const Sector& sector : sectors_) {
    const double theta = 0.5 * std::atan2(sector.sine, sector.cosine);
    const Vec2 along(std::cos(theta), std::sin(theta));
    const auto samples = static_cast<double>(sector.samples);
    std::size_t mode = 0;
    for (int n = 0; n <= kMaxWave; ++n) {
      for (int m = n == 0 ? 1 : -kMaxWave; m <= kMaxWave; ++m, ++mode) {
        const Vec2 q = unit * Vec2(m, n);
        const double q_along = q.dot(along);
        const double q_across = q.y() * along.x() - q.x() * along.y();
        points.push_back(
            {q_along * q_along, q_across * q_across, sector.power[mode] / samples, sector.floor / samples, samples});
      }
    }
  }
  return points;
}

/// K1, K3, K3 / K1, the floor, the samples; then of every square of the quadrant q_along, q_across, power, fitted
/// power, and 1 if it lies within the fit's range.
std::vector<double> DirectorFluctuations::numbers() const {
  const std::vector<Point> all = points();
  const double q2_max = q_max_ * q_max_ * (1 + 1e-9);
  std::vector<Point> fitted;
  std::copy_if(all.begin(), all.end(), std::back_inserter(fitted),
               [&](const Point& p) { return p.along2 + p.across2 <= q2_max; });
  const Constants k = fit_constants(fitted).value_or(Constants{kNaN, kNaN});

  double samples = 0, floor = 0;
  for (const Sector& sector : sectors_) {
    samples += static_cast<double>(sector.samples);
    floor += sector.floor;
  }
  struct Square {
    double weight = 0, q_along = 0, q_across = 0, power = 0, fit = 0;
    bool inside = true;
  };
  std::vector<Square> squares(std::size_t{kSquares} * kSquares);
  const double unit = 2 * kPi / box_side_;
  for (const Point& p : all) {
    const double q_along = std::sqrt(p.along2), q_across = std::sqrt(p.across2);
    // The last square also takes what is no number, as the sums of a forged checkpoint may be.
    const auto index = [unit](double q) { return std::lround(std::min(kSquares - 1.0, q / unit)); };
    Square& square = squares[static_cast<std::size_t>(index(q_across) * kSquares + index(q_along))];
    square.weight += p.samples;
    square.q_along += p.samples * q_along;
    square.q_across += p.samples * q_across;
    square.power += p.samples * p.power;
    square.fit += p.samples / k.inverse(p.along2, p.across2);
    square.inside = square.inside && p.along2 + p.across2 <= q2_max;
  }
  std::vector<double> result{k.splay, k.bend, k.bend / k.splay, samples > 0 ? floor / samples : kNaN, samples};
  for (const Square& s : squares) {
    const double weight = s.weight > 0 ? s.weight : kNaN;
    result.insert(result.end(),
                  {s.q_along / weight, s.q_across / weight, s.power / weight, s.fit / weight, s.inside ? 1.0 : 0.0});
  }
  return result;
}

DirectorSpectrum DirectorFluctuations::reduce(const Blocked<DirectorFluctuations>& blocks, double t_steady) {
  const std::vector<Estimate> all = jackknife(blocks.empty(), blocks.parts_after(t_steady, kMostParts),
                                              [](const DirectorFluctuations& part) { return part.numbers(); });
  DirectorSpectrum spectrum;
  spectrum.splay = all[0];
  spectrum.bend = all[1];
  spectrum.ratio = all[2];
  spectrum.floor = all[3].value;
  spectrum.samples = std::llround(all[4].value);
  double chi2 = 0, n = 0;
  for (std::size_t i = 5; i < all.size(); i += 5) {
    if (!std::isfinite(all[i].value)) continue;
    spectrum.q_along.push_back(all[i].value);
    spectrum.q_across.push_back(all[i + 1].value);
    spectrum.power.push_back(all[i + 2]);
    spectrum.fit.push_back(all[i + 3].value);
    const double pull = (all[i + 2].value - all[i + 3].value) / all[i + 2].sem;
    if (all[i + 4].value == 0 || !std::isfinite(pull)) continue;
    chi2 += pull * pull;
    n += 1;
  }
  spectrum.chi2 = n > 2 ? chi2 / (n - 2) : kNaN;
  return spectrum;
}

}  // namespace shaken::analysis
