#pragma once

#include <limits>

#include "sim/contact/cofactors.h"
#include "sim/contact/impact_process.h"
#include "sim/contact/impulse.h"
#include "sim/contact/restitution.h"
#include "sim/lanes/double_lanes.h"

/// Impacts in their course (contact/impact_process.h) at several contacts with one plate at a time: each lane has the
/// bits of poisson_impulse or energetic_impulse.
namespace shaken::lanes {

/// As point_compliance makes it. Entries beside the diagonal differ from their mirror images by roundings.
template <class D>
struct ComplianceOf {
  D xx, xy, xz, yx, yy, yz, zx, zy, zz;

  SHAKEN_INLINE Triple<D> operator*(const Triple<D>& v) const {
    return {xx * v.x + (xy * v.y + xz * v.z), yx * v.x + (yy * v.y + yz * v.z), zx * v.x + (zy * v.y + zz * v.z)};
  }
};

template <class D>
SHAKEN_INLINE ComplianceOf<D> point_compliance(const InverseInertia& inverse, const Triple<D>& director,
                                               const Triple<D>& arm) {
  const Triple<D> lever = director.cross(arm);
  const double more = inverse.par - inverse.perp;
  const Triple<D> l{more * lever.x, more * lever.y, more * lever.z};
  const Triple<D> a{inverse.perp * arm.x, inverse.perp * arm.y, inverse.perp * arm.z};
  const D round = inverse.mass + inverse.perp * arm.squared_norm();
  return {(l.x * lever.x - a.x * arm.x) + round, l.x * lever.y - a.x * arm.y,
          l.x * lever.z - a.x * arm.z,           l.y * lever.x - a.y * arm.x,
          (l.y * lever.y - a.y * arm.y) + round, l.y * lever.z - a.y * arm.z,
          l.z * lever.x - a.z * arm.x,           l.z * lever.y - a.z * arm.y,
          (l.z * lever.z - a.z * arm.z) + round};
}

template <class D>
SHAKEN_INLINE D restitution_at(const ContactParameters& contact, const D& speed) {
  if (!contact.has_restitution_speed()) return D{} + contact.restitution;
  constexpr int W = sizeof(D) / sizeof(double);
  double e[W];
  store(e, speed);
  shaken::restitution_at(contact, std::span<double>(e));
  return load<W>(e);
}

template <class D>
struct ImpulseOf {
  Triple<D> P;
  D unknown;  ///< >= 0: what is to be done in this lane is not known here
};

/// With friction, by a restitution that is one number or one of each contact. Not known: slip without a direction, or
/// one that jams.
template <class D, class E>
SHAKEN_INLINE ImpulseOf<D> newton_coulomb_impulse(const ComplianceOf<D>& K, const Triple<D>& normal, const Triple<D>& u,
                                                  double mu, const E& restitution) {
  const D u_n = u.dot(normal);
  const D bounce = -(1.0 + restitution) * u_n;
  const Triple<D> u_t = u - u_n * normal;
  const Triple<D> wanted = bounce * normal - u_t;
  const auto stick =
      Cofactors<D>(K.xx, K.yy, K.zz, K.xy, K.xz, K.yz).template solve<Triple<D>>(wanted.x, wanted.y, wanted.z);
  const D stick_n = stick.dot(normal);
  const Triple<D> stick_t = stick - stick_n * normal;
  const D stick_t2 = stick_t.squared_norm();
  const D speed_t = square_root(u_t.squared_norm());
  const Triple<D> cone = normal - (mu / speed_t) * u_t;
  const D gain = normal.dot(K * cone);
  const Triple<D> slip = (bounce / gain) * cone;
  const D in_cone = mu * mu * stick_n * stick_n - stick_t2;
  const D sticks = stick_n > 0.0 ? in_cone : -1.0 - stick_t2;  // >= 0: yes
  const auto if_sticks = [&](const D& then, const D& otherwise) __attribute__((always_inline)) {
    return sticks >= 0.0 ? then : otherwise;
  };
  const D slips_well = smaller(gain, D(speed_t - 1e-12 * absolute(u_n)));
  return {{if_sticks(stick.x, slip.x), if_sticks(stick.y, slip.y), if_sticks(stick.z, slip.z)},
          if_sticks(-1.0 - stick_t2, -slips_well)};
}

/// What most impacts by plates are: each phase is one leg of the midpoint rule, or slips straight, perhaps until it
/// sticks, or sticks from the start. Others are marked as such.
template <class D>
class ImpactProcesses {
 public:
  /// `side`: +1: the normal points up; -1: down.
  SHAKEN_INLINE ImpactProcesses(const ComplianceOf<D>& K, double side, const Triple<D>& u, double friction)
      : side_(side), mu_(friction) {
    const D across = side * K.yx;
    nn_ = K.zz;
    nt_ = {side * K.xz, K.yz};
    tt_ = {K.xx, across, K.yy};
    const D det = K.xx * K.yy - across * across;
    softness_ = {K.yy / det, -across / det, K.xx / det};
    hold_ = softness_ * nt_;
    u_n_ = side * u.z;
    u_t_ = {u.x, side * u.y};
    trace_ = ImpactProcess::kTrace * square_root(u.squared_norm());
    scale_ = -u_n_ / nn_;
  }

  SHAKEN_INLINE void compress() {
    run([&](const D& rate) __attribute__((always_inline)) {
      return where_positive(rate, larger(D(-u_n_ / rate), D{}), D(D{} + kNever));
    });
    u_n_ = D{};
  }
  SHAKEN_INLINE void restore_impulse(const D& impulse) {
    const D goal = p_ + impulse;
    run([&](const D& rate) __attribute__((always_inline)) {
      const D remaining = larger(D(goal - p_), D{});
      return where_positive(D(-rate), smaller(remaining, larger(D(-u_n_ / rate), D{})), remaining);
    });
  }
  SHAKEN_INLINE void restore_work(const D& work) {
    const D goal = work_ + work;
    run([&](const D& rate) __attribute__((always_inline)) {
      const D remaining = larger(D(goal - work_), D{});
      const D u_n = larger(u_n_, D{});
      const D square = u_n * u_n + 2.0 * rate * remaining;
      const D denominator = u_n + square_root(square);
      const D length = where_positive(denominator, D(2.0 * remaining / denominator), D{});
      return where_positive(D(-square), D(-u_n / rate), length);
    });
  }

  SHAKEN_INLINE Triple<D> impulse() const { return {D{} + p_t_.x, D{} + side_ * p_t_.y, side_ * p_}; }
  const D& normal_impulse() const { return p_; }
  const D& normal_work() const { return work_; }
  const D& unknown() const { return unknown_; }  ///< >= 0: it is

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  static constexpr double kLongest = std::numeric_limits<double>::max();
  static constexpr double kStraight = ImpactProcess::kStraight * ImpactProcess::kTurn * ImpactProcess::kTurn;

  /// In the tangent plane.
  struct Pair {
    D x, y;

    SHAKEN_INLINE D dot(const Pair& b) const { return x * b.x + y * b.y; }
    SHAKEN_INLINE Pair operator+(const Pair& b) const { return {x + b.x, y + b.y}; }
    SHAKEN_INLINE Pair operator/(const D& s) const { return {x / s, y / s}; }
    SHAKEN_INLINE Pair operator-() const { return {-x, -y}; }
    SHAKEN_INLINE friend Pair operator*(const D& s, const Pair& a) { return {s * a.x, s * a.y}; }
  };
  struct Symmetric {
    D xx, xy, yy;

    SHAKEN_INLINE Pair operator*(const Pair& v) const { return {xx * v.x + xy * v.y, xy * v.x + yy * v.y}; }
  };

  /// A stretch of constant friction, where it is what slipping_leg chooses.
  struct Leg {
    Pair q;
    D limit;   ///< the longest that what remains of the phase may be
    D is_it;   ///< >= 0: it is known to be chosen
    D is_not;  ///< > 0: it is known not to be
  };

  SHAKEN_INLINE D rate_n(const Pair& q) const { return nn_ + nt_.dot(q); }
  SHAKEN_INLINE Pair rate_t(const Pair& q) const { return nt_ + tt_ * q; }

  SHAKEN_INLINE void advance(const Pair& q, const D& length) {
    const D change = rate_n(q) * length;
    work_ += (u_n_ + 0.5 * change) * length;
    u_n_ += change;
    u_t_ = u_t_ + length * rate_t(q);
    p_ += length;
    p_t_ = p_t_ + length * q;
  }

  /// The straight way to u_t = 0. `larger` and `smaller` pass on what is no number where it comes last, and pass it
  /// over where it comes first.
  template <class End>
  SHAKEN_INLINE Leg straight_leg(const D& speed, const End& end) const {
    const Pair g = softness_ * u_t_;
    const D A = hold_.dot(hold_) - mu_ * mu_;
    const D B = hold_.dot(g);
    const D C = g.dot(g);
    const D discriminant = B * B - A * C;
    const D x = C / (square_root(discriminant) - B);
    const Pair q = -(g / x + hold_);
    const Pair bend = q / (D{} + mu_) + u_t_ / speed;
    const D part = smaller(x, end(rate_n(q))) / scale_;
    const D too_bent = square_root(bend.dot(bend)) * part - kStraight;
    const D wrong = larger(q.dot(u_t_), too_bent);
    return {q, x, smaller(discriminant, smaller(smaller(x, D(kLongest - x)), D(-wrong))),
            larger(wrong, D(-discriminant))};
  }

  /// One by the midpoint rule, where no direction of slip keeps itself up.
  template <class End>
  SHAKEN_INLINE Leg midpoint_leg(const D& speed, const End& end) const {
    const D minus_mu = D{} - mu_;
    const Pair direction = u_t_ / speed;
    const Pair across{-direction.y, direction.x};
    const Pair q_here = minus_mu * direction;
    const Pair rate = rate_t(q_here);
    const D along = rate.dot(direction);
    const D aside = rate.dot(across);
    const D slope = mu_ * (direction.dot(tt_ * direction) - across.dot(tt_ * across)) - nt_.dot(direction);
    const D turns = larger(slope, D(absolute(aside) + kStraight * slope));  // > 0
    const D change = absolute(slope) + larger(D(-2.0 * along), D{});
    const D steady =
        smaller(D(ImpactProcess::kTurn * speed / absolute(aside)), D(4.0 * ImpactProcess::kTurn * speed / change));
    const D length = smaller(end(rate_n(q_here)), steady);
    const D half = 0.5 * length;
    const Pair middle = u_t_ + half * rate;
    const Pair q = minus_mu * (middle / square_root(middle.dot(middle)));
    const D limit = (1.0 + ImpactProcess::kStretch) * length;
    const D half_limit = 0.5 * limit;
    const Pair furthest = u_t_ + half_limit * rate_t(q);
    const D makes_energy = larger(q.dot(u_t_), q.dot(furthest));  // > 0
    return {q, limit, turns > 0.0 ? -makes_energy : -1.0 - speed, makes_energy};
  }

  /// A phase, or a mark.
  template <class End>
  SHAKEN_INLINE void run(const End& end) {
    const D speed2 = u_t_.dot(u_t_);
    const D speed = square_root(speed2);
    const D slips = absolute(u_t_.x) + absolute(u_t_.y);  // > 0
    const Leg straight = straight_leg(speed, end);
    const Leg midpoint = midpoint_leg(speed, end);
    const Pair holding = -hold_;
    const D holds = mu_ * mu_ - hold_.dot(hold_);  // >= 0: it sticks, once at rest
    const auto choose = [&](const D& if_straight, const D& otherwise, const D& at_rest) __attribute__((always_inline)) {
      const D slipping = straight.is_it >= 0.0 ? if_straight : otherwise;
      return where_positive(slips, slipping, at_rest);
    };
    const Pair q{choose(straight.q.x, midpoint.q.x, holding.x), choose(straight.q.y, midpoint.q.y, holding.y)};
    const D limit = choose(straight.limit, midpoint.limit, D(D{} + kNever));
    const D remaining = end(rate_n(q));
    // what is no number, or lasts forever, does not
    const D fits = smaller(D(limit < remaining ? D{} - 1.0 : limit), D(kLongest - remaining));  // >= 0

    // what stops slipping before the end sticks for the rest
    const D sticks = choose(D(-fits), D{} - 1.0, D(D{} - 1.0));  // > 0
    advance(q, sticks > 0.0 ? limit : remaining);
    u_t_ = {choose(where_positive(sticks, D{}, u_t_.x), u_t_.x, D{}),
            choose(where_positive(sticks, D{}, u_t_.y), u_t_.y, D{})};
    bool any_sticks = false;
    for (std::size_t l = 0; l < sizeof(D) / sizeof(double); ++l) any_sticks |= sticks[l] > 0;
    if (any_sticks) {
      advance(holding, where_positive(sticks, end(rate_n(holding)), D{}));
      u_t_ = {where_positive(sticks, D{}, u_t_.x), where_positive(sticks, D{}, u_t_.y)};
    }

    const D midpoint_known = straight.is_not > 0.0 ? smaller(fits, midpoint.is_it) : D{} - 1.0;
    const D straight_known = where_positive(sticks, holds, fits);
    const D slipping_known = choose(straight_known, midpoint_known, holds);
    const D is_trace = trace_ * trace_ - speed2;  // >= 0, where it slips
    const D known = is_trace >= 0.0 ? where_positive(slips, D{} - 1.0, slipping_known) : slipping_known;
    unknown_ = known >= 0.0 ? unknown_ : D{};
  }

  double side_, mu_;
  D nn_, trace_, scale_, u_n_;
  D p_{}, work_{};
  D unknown_ = D{} - 1.0;
  Pair nt_, hold_, u_t_;
  Pair p_t_{};
  Symmetric tt_, softness_;
};

/// poisson_impulse or, `by_work`, energetic_impulse, with friction.
template <class D>
SHAKEN_INLINE ImpulseOf<D> impulse_of_process(bool by_work, const ComplianceOf<D>& K, double side, const Triple<D>& u,
                                              double friction, const D& restitution) {
  ImpactProcesses<D> impacts(K, side, u, friction);
  impacts.compress();
  if (by_work) {
    impacts.restore_work(-restitution * restitution * impacts.normal_work());
  } else {
    impacts.restore_impulse(restitution * impacts.normal_impulse());
  }
  return {impacts.impulse(), impacts.unknown()};
}

}  // namespace shaken::lanes
