#pragma once

#include <optional>

#include "base/core/types.h"
#include "sim/system.h"

namespace shaken {

/// One impact in the course of its own normal impulse p: compression until the bodies no longer approach, restitution
/// after that, and friction that slips, turns, stops, sticks or reverses meanwhile.
/// Model:  du/dp = K (normal + q), u = velocity of one body relative to the other at the contact, q = friction per
///         normal impulse, in the tangent plane. Coulomb: |q| <= mu; where u_t != 0, q = -mu u_t / |u_t|. Compression
///         ends at u_n = 0.
/// Source: Keller (1986), J. Appl. Mech. 53, 1 (impact as a process in p); Darboux (1880). What ends restitution is
///         the law's: Poisson's hypothesis (Routh 1905, art. 179) or Stronge (1990), Proc. R. Soc. A 431, 169.
///         Chatterjee & Ruina (1998), J. Appl. Mech. 65, 939, compare such laws and what they may lack.
/// Units:  K [1/mg], u [mm/s], impulses [mg mm/s], work [pJ]. K is symmetric and positive definite; u_n < 0.
/// Numerics: legs of constant q, at whose ends all is known to rounding.
///         - No slip: it sticks, or slips in one fixed direction from then on. One leg each.
///         - Slip that comes to a stop along a straight line, or so soon that it does not matter: one leg.
///         - Slip in a direction that keeps itself up: one leg, or halving legs where it slows down.
///         - Other slip: explicit midpoint rule, legs in which u_t changes by about `turn` of itself. All slip tends to
///           one of few directions, so few legs do: 3 to 7 on average, 59 at most in 10^6 impacts tried. A trace of
///           slip is stopped at once (kTrace).
///         On no leg does friction add energy, so the change of energy is, to rounding, at most that by the normal
///         impulse, whatever `turn` is: the energetic law never makes energy. Rounding grows with K's condition; to
///         10^4 (rods: below 10^3) it is not seen beyond 10^-14 of the energies exchanged.
class ImpactProcess {
 public:
  /// Largest change of u_t in one leg of slip, as a fraction of u_t, about. With 1/4 the impulse is wrong by 0.1 % on
  /// average and 4 % at worst at mu = 1, where slip turns most, by 0.06 % at worst at mu = 0.05; the error falls with
  /// the square of it (ImpactProcess.ConvergesWithShorterLegs).
  static constexpr double kTurn = 0.25;
  /// Slip that is as small as this fraction of the velocity at the start is stopped at once.
  static constexpr double kTrace = 1e-9;
  /// Slip counts as straight if its direction is wrong by no more than this times the square of `turn`; for a stop it
  /// is weighed with the part of the impact that it takes.
  static constexpr double kStraight = 1.0 / 64;
  /// What remains of a phase may be done by the leg before, if it is no more than this part of it.
  static constexpr double kStretch = 0.05;

  ImpactProcess(const Mat3& K, const Vec3& normal, const Vec3& u, double friction, double turn = kTurn);

  /// Runs until the bodies no longer approach.
  void compress();
  /// Runs on until p has grown by `impulse` since compression ended (Poisson).
  void restore_impulse(double impulse);
  /// Runs on until the normal impulse has done `work` since compression ended (Stronge).
  void restore_work(double work);
  // Both end early should the bodies approach again, which only friction that swerves can bring about.

  /// Impulse so far.
  Vec3 impulse() const { return p_ * normal_ + p_t_.x() * tangent_1_ + p_t_.y() * tangent_2_; }
  /// Normal impulse so far, and the work that it has done (negative in compression).
  double normal_impulse() const { return p_; }
  double normal_work() const { return work_; }
  int n_legs() const { return n_legs_; }

 private:
  /// A stretch of constant friction.
  struct Leg {
    Vec2 q;         ///< friction per normal impulse
    double length;  ///< in p; infinite if it lasts
    bool stops;     ///< at its end u_t is 0
  };
  using Mat2 = Eigen::Matrix2d;

  /// Runs until `end`, a function of the rate of u_n, finds that what remains of the phase fits into the leg.
  template <class End>
  void run(const End& end);
  template <class End>
  Leg slipping_leg(const End& end) const;
  template <class End>
  std::optional<Leg> straight_leg(double speed, const End& end) const;
  Leg midpoint_leg(const Vec2& rate, double length) const;
  Leg leg_from_rest() const;
  void advance(const Vec2& q, double length);
  double rate_n(const Vec2& q) const { return nn_ + nt_.dot(q); }
  Vec2 rate_t(const Vec2& q) const { return nt_ + tt_ * q; }

  Vec3 normal_, tangent_1_, tangent_2_;
  double nn_;      ///< K in this frame
  Vec2 nt_;        ///< the same
  Mat2 tt_;        ///< the same
  Mat2 softness_;  ///< inverse of tt_
  Vec2 hold_;      ///< -q that keeps u_t as it is
  double mu_, turn_, straight_;
  double trace_;  ///< slip below this is stopped at once [mm/s]
  double scale_;  ///< of the normal impulse

  double u_n_;
  Vec2 u_t_;
  double p_ = 0;
  Vec2 p_t_ = Vec2::Zero();
  double work_ = 0;
  int n_legs_ = 0;
};

/// Impulse on the body that `normal` points to by Poisson's hypothesis: restitution lasts for e times the normal
/// impulse of compression. May make energy where slip reverses in a body that is not central (Stronge 1990).
Vec3 poisson_impulse(const Mat3& K, const Vec3& normal, const Vec3& u, const ContactParameters& contact);

/// The same by Stronge's energetic restitution: in restitution the normal impulse does e^2 of the work that it took in
/// compression. Never makes energy.
Vec3 energetic_impulse(const Mat3& K, const Vec3& normal, const Vec3& u, const ContactParameters& contact);

}  // namespace shaken
