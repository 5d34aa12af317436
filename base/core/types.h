#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <numbers>

/// Units everywhere inside Shaken: millimetre, second, milligram, radian. Energies are therefore in picojoule
/// (mg mm^2 / s^2) and momenta in mg mm / s.
namespace shaken {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// Time as an integer count of steps since the start of the run; the time of tick k is k * dt.
using Tick = std::int64_t;

inline constexpr double kPi = std::numbers::pi;

}  // namespace shaken
