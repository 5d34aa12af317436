// SPDX-License-Identifier: MIT
#include "analysis/director_fluctuations.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <utility>

#include "analysis/fold.h"
#include "sim/core/check.h"

namespace shaken::analysis {
namespace {

constexpr int kSectors = 36;  // over half a turn
constexpr std::size_t kErrorBlocks = 16;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kSquares = 10;  // squares of the quadrant along each axis: 6 sqrt(2) and half a square

/// K1 and K3.
struct Constants {
  double splay, bend;
  double inverse(double along2, double across2) const { return splay * across2 + bend * along2; }
};

/// Minimises sum n (P D - ln D), D = K1 q_across^2 + K3 q_along^2, which is convex, by Newton's method; nothing if
/// there is no minimum.
template <class Points>
std::optional<Constants> fit_constants(const Points& points) {
  double n = 0, nq = 0;
  for (const auto& p : points) {
    n += p.samples;
    nq += p.samples * p.power * (p.along2 + p.across2);
  }
  if (points.size() < 2 || !(nq > 0)) return std::nullopt;
  const auto cost = [&](const Constants& k) {
    double sum = 0;
    for (const auto& p : points) {
      const double d = k.inverse(p.along2, p.across2);
      if (!(d > 0)) return std::numeric_limits<double>::infinity();
      sum += p.samples * (p.power * d - std::log(d));
    }
    return sum;
  };
  Constants k{n / nq, n / nq};
  for (int iteration = 0; iteration < 100; ++iteration) {
    double g1 = 0, g3 = 0, h11 = 0, h13 = 0, h33 = 0;
    for (const auto& p : points) {
      const double d = k.inverse(p.along2, p.across2);
      const double slope = p.samples * (p.power - 1 / d);
      const double bow = p.samples / (d * d);
      g1 += slope * p.across2;
      g3 += slope * p.along2;
      h11 += bow * p.across2 * p.across2;
      h13 += bow * p.across2 * p.along2;
      h33 += bow * p.along2 * p.along2;
    }
    const double determinant = h11 * h33 - h13 * h13;
    if (!(determinant > 1e-12 * h11 * h33)) return std::nullopt;  // all q in one direction
    const double step1 = -(h33 * g1 - h13 * g3) / determinant;
    const double step3 = -(h11 * g3 - h13 * g1) / determinant;
    if (std::abs(step1) <= 1e-10 * std::abs(k.splay) && std::abs(step3) <= 1e-10 * std::abs(k.bend)) return k;
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

}  // namespace

DirectorFluctuations::DirectorFluctuations(double box_side, double q_max) : box_side_(box_side), q_max_(q_max) {
  SHAKEN_CHECK(box_side > 0 && q_max > 0, "a box and wave vectors must not be empty");
}

void DirectorFluctuations::accumulate(std::span<const Vec3> positions, std::span<const Vec3> directors) {
  SHAKEN_CHECK(positions.size() == directors.size(), "one position for each director");
  std::vector<std::size_t> rods;
  Vec2 axis = Vec2::Zero();
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const Vec2 angle = double_angle(directors[i]);
    if (!angle.allFinite() || angle == Vec2::Zero() || !positions[i].head<2>().allFinite()) continue;
    rods.push_back(i);
    axis += angle;
  }
  const auto n = static_cast<double>(rods.size());
  if (rods.empty() || axis.norm() < kMinOrder * n) return;
  const double order = axis.norm() / n;
  axis.normalize();

  // exp(-i q . r) as a product of powers of exp(-2 pi i x / L) and exp(-2 pi i y / L), for m = -6 .. 6, n = 0 .. 6.
  using Complex = std::complex<double>;
  constexpr int kRow = 2 * kWaves + 1;
  struct Parts {
    double re[kRow] = {}, im[kRow] = {};
  };
  std::array<Parts, kWaves + 1> wave{}, density{};
  double squares = 0;
  for (const std::size_t i : rods) {
    const Vec2 angle = double_angle(directors[i]);
    const double s = (angle.y() * axis.x() - angle.x() * axis.y()) / (2 * order);
    squares += s * s;
    const Complex x = std::polar(1.0, -2 * kPi * positions[i].x() / box_side_);
    const Complex y = std::polar(1.0, -2 * kPi * positions[i].y() / box_side_);
    Parts row;
    Complex power = 1.0;
    for (int m = 0; m <= kWaves; ++m, power *= x) {
      row.re[kWaves + m] = row.re[kWaves - m] = power.real();
      row.im[kWaves + m] = power.imag();
      row.im[kWaves - m] = -power.imag();
    }
    power = 1.0;
    for (std::size_t k = 0; k <= kWaves; ++k, power *= y) {
      const double re = power.real(), im = power.imag();
      for (int m = 0; m < kRow; ++m) {
        const double c = row.re[m] * re - row.im[m] * im;
        const double d = row.re[m] * im + row.im[m] * re;
        density[k].re[m] += c;
        density[k].im[m] += d;
        wave[k].re[m] += s * c;
        wave[k].im[m] += s * d;
      }
    }
  }

  const double area = box_side_ * box_side_;
  std::array<double, kModes> powers{};
  double sum = 0, structure = 0;
  std::size_t mode = 0;
  for (std::size_t k = 0; k <= kWaves; ++k) {
    for (int m = k == 0 ? kWaves + 1 : 0; m < kRow; ++m, ++mode) {
      const auto square = [m](const Parts& parts) { return parts.re[m] * parts.re[m] + parts.im[m] * parts.im[m]; };
      powers[mode] = area * square(wave[k]) / (n * n);
      sum += powers[mode];
      structure += square(density[k]) / n / kModes;
    }
  }
  const double all_modes = 2 * kModes;
  const double not_noise = n < 2 * all_modes ? 0.0 : 1 - structure;
  const double floor = (area * squares / n - not_noise * 2 * sum) / n / (1 - not_noise * all_modes / n);

  const double theta = 0.5 * std::atan2(axis.y(), axis.x());
  const auto place = static_cast<std::int64_t>(std::floor((theta / kPi + 0.5) * kSectors));
  Sector& sector = sectors_[std::clamp<std::int64_t>(place, 0, kSectors - 1)];
  ++sector.samples;
  sector.cosine += axis.x();
  sector.sine += axis.y();
  sector.floor += floor;
  for (std::size_t k = 0; k < powers.size(); ++k) sector.power[k] += powers[k] - floor;
}

void DirectorFluctuations::merge(const DirectorFluctuations& other) {
  SHAKEN_CHECK(box_side_ == other.box_side_, "fluctuations in different boxes");
  for (const auto& [place, from] : other.sectors_) {
    Sector& to = sectors_[place];
    to.samples += from.samples;
    to.cosine += from.cosine;
    to.sine += from.sine;
    to.floor += from.floor;
    for (std::size_t k = 0; k < to.power.size(); ++k) to.power[k] += from.power[k];
  }
}

std::vector<DirectorFluctuations::Point> DirectorFluctuations::points() const {
  std::vector<Point> points;
  const double unit = 2 * kPi / box_side_;
  for (const auto& [place, sector] : sectors_) {
    const double theta = 0.5 * std::atan2(sector.sine, sector.cosine);
    const Vec2 along(std::cos(theta), std::sin(theta));
    const auto samples = static_cast<double>(sector.samples);
    std::size_t mode = 0;
    for (int n = 0; n <= kWaves; ++n) {
      for (int m = n == 0 ? 1 : -kWaves; m <= kWaves; ++m, ++mode) {
        const Vec2 q = unit * Vec2(m, n);
        const double q_along = q.dot(along);
        const double q_across = q.y() * along.x() - q.x() * along.y();
        points.push_back({q_along * q_along, q_across * q_across, sector.power[mode] / samples, samples});
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
  for (const auto& [place, sector] : sectors_) {
    samples += static_cast<double>(sector.samples);
    floor += sector.floor;
  }
  struct Square {
    double weight = 0, q_along = 0, q_across = 0, power = 0, fit = 0;
    bool inside = true;
  };
  std::vector<Square> squares(kSquares * kSquares);
  const double unit = 2 * kPi / box_side_;
  for (const Point& p : all) {
    const double q_along = std::sqrt(p.along2), q_across = std::sqrt(p.across2);
    const auto index = [unit](double q) { return std::min<long>(std::lround(q / unit), kSquares - 1); };
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
  const std::vector<Estimate> all = jackknife(blocks.empty(), blocks.parts_after(t_steady, kErrorBlocks),
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

void DirectorFluctuations::save(StateWriter& writer) const {
  writer.tag("DirectorFluctuations");
  writer.put(box_side_);
  writer.put(q_max_);
  writer.put(static_cast<std::int64_t>(sectors_.size()));
  for (const auto& [place, sector] : sectors_) {
    writer.put(place);
    writer.put(sector.samples);
    writer.put(sector.cosine);
    writer.put(sector.sine);
    writer.put(sector.floor);
    writer.put(sector.power);
  }
}

void DirectorFluctuations::restore(StateReader& reader) {
  reader.tag("DirectorFluctuations");
  const double box_side = reader.real();
  const double q_max = reader.real();
  if (box_side != box_side_ || q_max != q_max_) {
    throw StateError("saved analysis state: DirectorFluctuations of another box or range");
  }
  std::map<std::int64_t, Sector> sectors;
  const std::int64_t n_sectors = reader.integer(0, kSectors);
  for (std::int64_t k = 0; k < n_sectors; ++k) {
    Sector& sector = sectors[reader.integer(0, kSectors - 1)];
    sector.samples = reader.integer(1, std::numeric_limits<std::int64_t>::max() / 2);
    sector.cosine = reader.real();
    sector.sine = reader.real();
    sector.floor = reader.real();
    const std::vector<double> power = reader.reals(sector.power.size());
    std::copy(power.begin(), power.end(), sector.power.begin());
  }
  sectors_ = std::move(sectors);
}

}  // namespace shaken::analysis
