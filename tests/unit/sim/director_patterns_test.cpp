#include "sim/start/director_patterns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <set>
#include <vector>

namespace shaken {
namespace {

constexpr double kDegree = kPi / 180.0;

/// Angle from one director to another, in [-pi/2, pi/2].
double angle_between(const Vec2& from, const Vec2& to) {
  const double angle = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  return angle - kPi * std::nearbyint(angle / kPi);
}

/// Times that the director turns round on a circle.
double winding(const DirectorAt& directors, const Vec2& centre, double radius) {
  constexpr int kSteps = 400;
  const auto at = [&](int k) {
    const double angle = 2 * kPi * k / kSteps;
    return directors(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
  };
  double turned = 0;
  for (int k = 0; k < kSteps; ++k) turned += angle_between(at(k), at(k + 1));
  return turned / (2 * kPi);
}

/// theta_1(z | tau), by its series (DLMF 20.2.1).
std::complex<double> theta_1(std::complex<double> z, double tau_imaginary) {
  std::complex<double> sum = 0;
  for (int n = 0; n < 30; ++n) {
    const double power = std::exp(-kPi * tau_imaginary * (n + 0.5) * (n + 0.5));
    sum += 2.0 * (n % 2 ? -1.0 : 1.0) * power * std::sin((2.0 * n + 1.0) * z);
  }
  return sum;
}

TEST(DefectPair, IsThatOfJacobisThetaFunction) {
  const Box box(20, 33);
  for (const double separation : {6.0, 12.0, 16.5}) {
    const DirectorAt directors = director_of_defect_pair(box, separation, 25 * kDegree);
    const auto [plus, minus] = defect_pair(box, separation);
    for (double x = 0.7; x < 20; x += 1.3) {
      for (double y = 0.4; y < 33; y += 1.7) {
        const auto theta = [&](const Vec2& of) {
          return theta_1(kPi / 20 * std::complex<double>(x - of.x(), y - of.y()), 33.0 / 20);
        };
        const double wanted = 25 * kDegree + 0.5 * std::arg(theta(plus) / theta(minus));
        EXPECT_NEAR(angle_between({std::cos(wanted), std::sin(wanted)}, directors({x, y})), 0, 1e-9)
            << x << ", " << y << ", " << separation << " mm";
      }
    }
  }
}

TEST(DefectPair, WindsOnceRoundEachDefectAndIsPeriodicAndSmoothElsewhere) {
  for (const Box& box : {Box(30, 30), Box(40, 20), Box(20, 50), Box(100, 10)}) {
    const double separation = 0.4 * box.longer();
    SCOPED_TRACE(testing::Message() << box.x() << " by " << box.y());
    const DirectorAt directors = director_of_defect_pair(box, separation, -70 * kDegree);
    const auto [plus, minus] = defect_pair(box, separation);
    EXPECT_NEAR((minus - plus).norm(), separation, 1e-12);
    EXPECT_NEAR(winding(directors, plus, 2), 0.5, 1e-9);
    EXPECT_NEAR(winding(directors, minus, 2), -0.5, 1e-9);
    EXPECT_NEAR(winding(directors, minus + Vec2(0, 0.5) * box.y(), 2), 0, 1e-9);
    for (double t = 0; t < 1; t += 0.05) {
      EXPECT_NEAR(angle_between(directors({0, t * box.y()}), directors({box.x(), t * box.y()})), 0, 1e-9);
      EXPECT_NEAR(angle_between(directors({t * box.x(), 0}), directors({t * box.x(), box.y()})), 0, 1e-9);
      for (const double u : {0.03, 0.3, 0.5, 0.77}) {
        const Vec2 place(t * box.x(), u * box.y());
        if ((place - plus).norm() < 1 || (place - minus).norm() < 1) continue;
        EXPECT_NEAR(directors(place).norm(), 1, 1e-12);
        EXPECT_LT(std::abs(angle_between(directors(place), directors(place + Vec2(1e-3, 1e-3)))), 2e-3);
      }
    }
  }
}

// theta is harmonic: its value is the mean of those on a circle.
TEST(DefectPair, HasTheLeastDistortion) {
  const Box box(25, 25);
  const DirectorAt directors = director_of_defect_pair(box, 12.5, 0);
  for (const Vec2& place : {Vec2(3, 4), Vec2(12.5, 12.5), Vec2(20, 21), Vec2(12.5, 1)}) {
    double mean = 0;
    for (int k = 0; k < 64; ++k) {
      const double angle = 2 * kPi * k / 64;
      mean += angle_between(directors(place), directors(place + 2.0 * Vec2(std::cos(angle), std::sin(angle)))) / 64;
    }
    EXPECT_NEAR(mean, 0, 1e-6) << place.transpose();
  }
}

TEST(DefectPair, IsAtItsAngleBeyondTheTwoAndAcrossThatBetweenThem) {
  for (const Box& box : {Box(30, 30), Box(20, 50)}) {
    for (const double angle : {0.0, 90.0, -35.0}) {
      const DirectorAt directors = director_of_defect_pair(box, 0.5 * box.longer(), angle * kDegree);
      const Vec2 wanted(std::cos(angle * kDegree), std::sin(angle * kDegree));
      EXPECT_NEAR(angle_between(wanted, directors(box.x() < box.y() ? Vec2(10, 1) : Vec2(1, 15))), 0, 1e-9);
      EXPECT_NEAR(std::abs(angle_between(wanted, directors(0.5 * box.sides()))), 0.5 * kPi, 1e-9);
    }
  }
}

TEST(Domains, PointEvenlyRoundTheHalfCircleAndLieApart) {
  const Box box(30, 50);
  for (const int n : {1, 2, 4, 9}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const std::vector<Domain> domains = draw_domains(box, n, seed);
      ASSERT_EQ(static_cast<int>(domains.size()), n);
      Vec2 sum = Vec2::Zero();
      for (const Domain& one : domains) {
        EXPECT_NEAR(one.director.norm(), 1, 1e-12);
        sum += Vec2(one.director.x() * one.director.x() - one.director.y() * one.director.y(),
                    2 * one.director.x() * one.director.y());
        for (const Domain& other : domains) {
          if (&one == &other) continue;
          EXPECT_GT(std::abs(angle_between(one.director, other.director)), kPi / n - 1e-9);
          Vec2 apart = one.centre - other.centre;
          for (const int axis : {0, 1}) apart[axis] -= box[axis] * std::round(apart[axis] / box[axis]);
          EXPECT_GT(apart.norm(), 0.4 * std::sqrt(box.area() / n)) << "n = " << n << ", seed " << seed;
        }
      }
      EXPECT_NEAR(sum.norm(), n == 1 ? 1 : 0, 1e-12);
      EXPECT_NE(draw_domains(box, n, seed + 10)[0].centre, domains[0].centre);
    }
  }
}

// Every domain and its eight images, by hand.
TEST(Domains, AreWhatIsNearestToTheirCentres) {
  const Box box(30, 12);
  const std::vector<Domain> domains = draw_domains(box, 5, 7);
  const DirectorAt directors = director_of_domains(box, domains);
  std::set<double> met;
  for (double x = 0.2; x < 30; x += 0.9) {
    for (double y = 0.2; y < 12; y += 0.9) {
      double nearest = INFINITY;
      Vec2 wanted = Vec2::Zero();
      for (const Domain& one : domains) {
        for (int i = -1; i <= 1; ++i) {
          for (int j = -1; j <= 1; ++j) {
            const double far = (one.centre + Vec2(30 * i, 12 * j) - Vec2(x, y)).norm();
            if (far < nearest) wanted = one.director;
            nearest = std::min(nearest, far);
          }
        }
      }
      EXPECT_EQ(directors({x, y}), wanted);
      met.insert(wanted.x());
    }
  }
  EXPECT_EQ(met.size(), 5u);
}

// A plane wave of wave number k loses a factor exp(-k^2 s^2 / 2) to a Gaussian of standard deviation s.
TEST(AligningField, IsThePatternSmoothed) {
  const Box box(40, 24);
  const double smoothing = 3;
  const DirectorAt turning = [](const Vec2& place) {
    const double angle = kPi * place.x() / 40 + 0.3;
    return Vec2(std::cos(angle), std::sin(angle));
  };
  const AligningField field(box, turning, smoothing);
  const double k = 2 * kPi / 40, strength = std::exp(-0.5 * k * k * smoothing * smoothing);
  for (const double x : {-3.0, 0.0, 7.3, 21.4, 39.9, 55.0}) {
    for (const double tilt : {0.2, -0.9, 1.5}) {
      const double angle = kPi * x / 40 + 0.3 + tilt;
      EXPECT_NEAR(field.torque({x, 3 * x}, {std::cos(angle), std::sin(angle)}), -strength * std::sin(2 * tilt), 0.01);
    }
  }
}

}  // namespace
}  // namespace shaken
