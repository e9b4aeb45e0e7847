// SPDX-License-Identifier: Apache-2.0
#pragma once
// 30.0_deg, to_rad and to_deg: conversion of angles in degrees, as people write them, to radians.

#include <numbers>

namespace saccade {

/// Converts degrees to radians.
[[nodiscard]] constexpr double to_rad(double angle_deg) { return angle_deg * std::numbers::pi / 180.0; }
/// Converts radians to degrees.
[[nodiscard]] constexpr double to_deg(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }

/// Converts a literal in degrees to radians: 30.0_deg, 30_deg.
[[nodiscard]] constexpr double operator""_deg(long double angle_deg) { return to_rad(static_cast<double>(angle_deg)); }
[[nodiscard]] constexpr double operator""_deg(unsigned long long angle_deg) {
  return to_rad(static_cast<double>(angle_deg));
}

}  // namespace saccade
