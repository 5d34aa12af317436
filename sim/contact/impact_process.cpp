#include "sim/contact/impact_process.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/contact/impulse.h"
#include "sim/contact/restitution.h"

namespace shaken {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// After so many legs times `turn` what remains goes without friction. Never reached by any impact tried.
constexpr double kMaxTurns = 100;

/// The unit vector s for which `pull` - mu tt s points along s: where slip goes that starts from rest.
/// |(lambda + mu tt)^-1 pull| = 1 has one root lambda > 0 if sticking needs more than mu; Newton's method on
/// 1 - 1/|...|, from the left, approaches it without overshooting (More & Sorensen 1983).
Vec2 slip_from_rest(const Eigen::Matrix2d& tt, double mu, const Vec2& pull) {
  const double a = mu * tt(0, 0), b = mu * tt(0, 1), d = mu * tt(1, 1);
  double lambda = 0;
  Vec2 s;
  for (int step = 0; step < 30; ++step) {
    const double det = (lambda + a) * (lambda + d) - b * b;
    s = Vec2((lambda + d) * pull.x() - b * pull.y(), (lambda + a) * pull.y() - b * pull.x()) / det;
    const double norm2 = s.squaredNorm();
    const double norm = std::sqrt(norm2);
    // (lambda + mu tt)^-1 s
    const Vec2 more = Vec2((lambda + d) * s.x() - b * s.y(), (lambda + a) * s.y() - b * s.x()) / det;
    const double change = (norm - 1.0) * norm2 / s.dot(more);
    if (!(change > 1e-16 * (lambda + a + d))) break;
    lambda += change;
  }
  return s.normalized();
}

}  // namespace

ImpactProcess::ImpactProcess(const Mat3& K, const Vec3& normal, const Vec3& u, double friction, double turn)
    : normal_(normal), mu_(friction), turn_(turn), straight_(kStraight * turn * turn) {
  // two tangents without a case that is near to none (Duff et al. 2017, J. Comput. Graph. Tech. 6, 1)
  const double sign = std::copysign(1.0, normal.z());
  const double a = -1.0 / (sign + normal.z());
  const double b = normal.x() * normal.y() * a;
  tangent_1_ = {1.0 + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x()};
  tangent_2_ = {b, sign + normal.y() * normal.y() * a, -normal.y()};

  const Vec3 along = K * normal;
  const Vec3 along_1 = K * tangent_1_;
  nn_ = normal.dot(along);
  nt_ = {tangent_1_.dot(along), tangent_2_.dot(along)};
  const double across = tangent_2_.dot(along_1);
  tt_ << tangent_1_.dot(along_1), across, across, tangent_2_.dot(K * tangent_2_);
  const double det = tt_(0, 0) * tt_(1, 1) - across * across;
  softness_ << tt_(1, 1), -across, -across, tt_(0, 0);
  softness_ /= det;
  hold_ = softness_ * nt_;

  u_n_ = normal.dot(u);
  u_t_ = {tangent_1_.dot(u), tangent_2_.dot(u)};
  trace_ = kTrace * u.norm();
  scale_ = -u_n_ / nn_;
}

void ImpactProcess::advance(const Vec2& q, double length) {
  const double change = rate_n(q) * length;
  work_ += (u_n_ + 0.5 * change) * length;
  u_n_ += change;
  u_t_ += rate_t(q) * length;
  p_ += length;
  p_t_ += q * length;
  ++n_legs_;
}

ImpactProcess::Leg ImpactProcess::leg_from_rest() const {
  if (hold_.squaredNorm() <= mu_ * mu_) return {-hold_, kNever, true};
  return {-mu_ * slip_from_rest(tt_, mu_, nt_), kNever, false};
}

/// With slip along d at the angle phi, friction is q = -mu d, and u_t changes by nt + tt q per normal impulse p: along
/// d, which changes the speed of slip, and aside from it, which turns it: d(phi)/dp = aside / speed. To first order
/// `aside` changes with phi by `slope`. Where that is negative, phi decays to the direction at which `aside` is 0,
/// phi - aside / slope, in ever shorter p as slip slows down: near that direction a leg goes along it.
template <class End>
ImpactProcess::Leg ImpactProcess::slipping_leg(const End& end) const {
  const double speed = u_t_.norm();
  if (const auto leg = straight_leg(speed, end)) return *leg;

  const Vec2 direction = u_t_ / speed;
  const Vec2 across(-direction.y(), direction.x());
  const Vec2 rate = rate_t(-mu_ * direction);
  const double along = rate.dot(direction);
  const double aside = rate.dot(across);
  const double slope = mu_ * (direction.dot(tt_ * direction) - across.dot(tt_ * across)) - nt_.dot(direction);
  if (slope < 0 && std::abs(aside) <= -straight_ * slope) {
    const Vec2 q = -mu_ * (direction - aside / slope * across).normalized();
    const double faster = -q.dot(rate_t(q));  // mu times the change of the speed; a leg goes half of the way to rest
    return {q, faster < 0 ? -0.5 * mu_ * speed / faster : kNever, false};
  }
  // Otherwise until slip has turned by turn_, or, where that comes first, until the part of itself by which what turns
  // it has changed, and twice the part by which the speed has fallen, add up to 4 turn_.
  const double change = std::abs(slope) + std::max(0.0, -2.0 * along);
  return midpoint_leg(
      rate, std::min({end(rate_n(-mu_ * direction)), turn_ * speed / std::abs(aside), 4.0 * turn_ * speed / change}));
}

/// The shortest straight way to u_t = 0 within the cone, |g + hold x| = mu x, unless slip turns too much on it.
template <class End>
std::optional<ImpactProcess::Leg> ImpactProcess::straight_leg(double speed, const End& end) const {
  const Vec2 g = softness_ * u_t_;
  const double A = hold_.squaredNorm() - mu_ * mu_;
  const double B = hold_.dot(g);
  const double C = g.squaredNorm();
  const double discriminant = B * B - A * C;
  if (!(discriminant >= 0)) return {};
  const double denominator = std::sqrt(discriminant) - B;
  const double x = C / denominator;
  if (!(denominator > 0 && x < kNever)) return {};
  const Vec2 q = -(g / x + hold_);
  const double bend = (q / mu_ + u_t_ / speed).norm();
  const double part = std::min(x, end(rate_n(q))) / scale_;
  if (!(q.dot(u_t_) <= 0 && bend * part <= straight_)) return {};
  return Leg{q, x, true};
}

/// By the explicit midpoint rule, over the rest of the phase or as far as u_t stays nearly what it is: `length` or
/// less.
ImpactProcess::Leg ImpactProcess::midpoint_leg(const Vec2& rate, double length) const {
  for (int halving = 0; halving < 60; ++halving, length *= 0.5) {
    const Vec2 q = -mu_ * (u_t_ + 0.5 * length * rate).normalized();
    // friction must not do work on the way, nor as far as the leg may be stretched
    const double furthest = (1.0 + kStretch) * length;
    const bool takes_energy = q.dot(u_t_) <= 0 && q.dot(u_t_ + 0.5 * furthest * rate_t(q)) <= 0;
    if (takes_energy) return {q, length, false};
  }
  return {Vec2::Zero(), length, false};
}

template <class End>
void ImpactProcess::run(const End& end) {
  while (n_legs_ * turn_ < kMaxTurns) {
    Leg leg;
    if (u_t_.squaredNorm() <= trace_ * trace_) {
      if (!u_t_.isZero(0)) {
        // stopped by a trace of friction, at this instant of the process
        const Vec2 stop = -(softness_ * u_t_);
        p_t_ += stop;
        u_n_ += nt_.dot(stop);
        u_t_.setZero();
      }
      leg = leg_from_rest();
    } else {
      leg = slipping_leg(end);
    }
    double remaining = end(rate_n(leg.q));
    if (remaining == kNever && leg.length == kNever) {  // rounding of a K that is hardly positive definite
      leg.q.setZero();
      remaining = end(nn_);
    }
    if (remaining <= (leg.stops ? 1.0 : 1.0 + kStretch) * leg.length) {
      const bool at_rest = u_t_.isZero(0) && leg.stops;
      advance(leg.q, remaining);
      if (at_rest) u_t_.setZero();
      return;
    }
    advance(leg.q, leg.length);
    if (leg.stops) u_t_.setZero();
  }
  advance(Vec2::Zero(), end(nn_));
}

void ImpactProcess::compress() {
  run([this](double rate) { return rate > 0 ? std::max(0.0, -u_n_ / rate) : kNever; });
  u_n_ = 0;
}

void ImpactProcess::restore_impulse(double impulse) {
  const double goal = p_ + impulse;
  run([this, goal](double rate) {
    const double remaining = std::max(0.0, goal - p_);
    return rate < 0 ? std::min(remaining, std::max(0.0, -u_n_ / rate)) : remaining;
  });
}

void ImpactProcess::restore_work(double work) {
  const double goal = work_ + work;
  run([this, goal](double rate) {
    // u_n x + rate x^2 / 2 = what remains
    const double remaining = std::max(0.0, goal - work_);
    const double u_n = std::max(0.0, u_n_);
    const double square = u_n * u_n + 2.0 * rate * remaining;
    if (square < 0) return -u_n / rate;
    const double denominator = u_n + std::sqrt(square);
    return denominator > 0 ? 2.0 * remaining / denominator : 0.0;
  });
}

// Flattened, as is energetic_impulse: or else legs go through memory between calls (6 % of the time).
[[gnu::flatten]] Vec3 poisson_impulse(const Mat3& K, const Vec3& normal, const Vec3& u,
                                      const ContactParameters& contact) {
  // without friction the two bodies bounce as by Newton's law
  if (!contact.has_friction()) return newton_coulomb_impulse(K, normal, u, contact);
  ImpactProcess impact(K, normal, u, contact.friction);
  impact.compress();
  const double e = restitution_at(contact, -u.dot(normal));
  if (e > 0) impact.restore_impulse(e * impact.normal_impulse());
  return impact.impulse();
}

[[gnu::flatten]] Vec3 energetic_impulse(const Mat3& K, const Vec3& normal, const Vec3& u,
                                        const ContactParameters& contact) {
  if (!contact.has_friction()) return newton_coulomb_impulse(K, normal, u, contact);
  ImpactProcess impact(K, normal, u, contact.friction);
  impact.compress();
  const double e = restitution_at(contact, -u.dot(normal));
  if (e > 0) impact.restore_work(-e * e * impact.normal_work());
  return impact.impulse();
}

}  // namespace shaken
