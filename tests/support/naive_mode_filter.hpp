// SPDX-License-Identifier: Apache-2.0
#pragma once
// naive_mode_filter: Algorithm 6 as it is printed, in double precision, for comparison.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/surfel/mode_filter.hpp"

namespace saccade::test {

/// Colours in 8-bit levels, so that those that are equally far apart are so here too; weights as the filter adds them.
struct NaiveMode {
  Eigen::Vector3d c;
  float w;
  Eigen::Vector3d p;
};

/// By surfel.
using NaiveModes = std::vector<std::vector<NaiveMode>>;

inline NaiveMode merged(const NaiveMode& a, const NaiveMode& b) {
  const double wa = double{a.w};
  const double wb = double{b.w};
  return {(a.c * wa + b.c * wb) / (wa + wb), a.w + b.w, (a.p * wa + b.p * wb) / (wa + wb)};
}

inline double density(const Eigen::Vector3d& c, const Eigen::Vector3d& mean, double sigma) {
  return std::exp(-(c - mean).squaredNorm() / (2.0 * sigma * sigma));
}

inline Eigen::Vector3d levels(const Rgb8& color) { return {double(color[0]), double(color[1]), double(color[2])}; }

/// Lines 1–26, with the enhanced depth given.
inline void algorithm_6(std::vector<NaiveMode>& M, const NaiveMode& measured, const Eigen::Vector3d& p_enhanced,
                        const ModeFilterConfig& config) {
  if (M.empty()) {
    M.push_back(measured);
    return;
  }
  const double sigma = config.guided.color_sigma * 255.0;
  std::size_t n{0};
  for (std::size_t i = 1; i < M.size(); ++i) {
    if ((M[i].c - measured.c).norm() < (M[n].c - measured.c).norm()) n = i;
  }
  if ((M[n].c - measured.c).norm() > config.color_sigmas * sigma) {
    if (static_cast<int>(M.size()) > config.max_modes - 1) {
      std::size_t r{0};
      for (std::size_t i = 1; i < M.size(); ++i) {
        if (M[i].w < M[r].w) r = i;
      }
      M.erase(M.begin() + static_cast<std::ptrdiff_t>(r));
    }
    M.push_back(measured);
    return;
  }
  M[n] = merged(M[n], {measured.c, measured.w, p_enhanced});
  std::vector<bool> gone(M.size());
  for (std::size_t i = 0; i < M.size(); ++i) {
    if (i == n) continue;
    if (density(M[i].c, M[n].c, sigma) * static_cast<double>(M[n].w) >
        density(M[i].c, M[i].c, sigma) * static_cast<double>(M[i].w)) {
      M[n] = merged(M[n], M[i]);
      gone[i] = true;
    }
  }
  std::vector<NaiveMode> kept;
  for (std::size_t i = 0; i < M.size(); ++i) {
    if (!gone[i]) kept.push_back(M[i]);
  }
  M = kept;
}

/// One frame: guidance from the modes at its beginning, then pixel by pixel in row-major order.
inline void naive_mode_filter(NaiveModes& modes, const Frame& frame, const SurfelAssociation& seen,
                              const ModeFilterConfig& config) {
  modes.resize(std::max(modes.size(), seen.surfels));
  const std::size_t pixels = frame.depth.size();
  std::vector<Eigen::Vector4f> guidance(pixels, Eigen::Vector4f::Zero());
  std::vector<std::uint8_t> used(pixels);
  std::vector<float> enhanced(frame.depth.pixels());
  for (std::size_t i = 0; i < pixels; ++i) {
    const SurfelId id = seen.of_pixel.data()[i];
    if (id == kNoSurfel || modes[id].empty()) continue;
    const Eigen::Vector3d c = levels(frame.color->data()[i]);
    const NaiveMode* nearest = &modes[id].front();
    for (const NaiveMode& mode : modes[id]) {
      if ((mode.c - c).norm() < (nearest->c - c).norm()) nearest = &mode;
    }
    if ((nearest->c - c).norm() > config.color_sigmas * config.guided.color_sigma * 255.0) continue;
    guidance[i] << (nearest->c / 255.0).cast<float>(),
        static_cast<float>((seen.T_world_camera.inverse() * nearest->p).z());
    used[i] = 1;
  }
  if (config.enhance_depth) {
    GuidedFilter filter{config.guided};
    filter.apply(frame.depth.width(), frame.depth.height(), frame.depth.pixels(), guidance, used, {}, enhanced);
  }
  for (int v = 0; v < frame.depth.height(); ++v) {
    for (int u = 0; u < frame.depth.width(); ++u) {
      const SurfelId id = seen.of_pixel(u, v);
      if (id == kNoSurfel) continue;
      const float guided_m = enhanced[static_cast<std::size_t>(v * frame.depth.width() + u)];
      const double change_m = std::abs(double{guided_m} - double{frame.depth(u, v)});
      const float d_e = change_m <= config.max_depth_change_m ? guided_m : frame.depth(u, v);
      const auto point = [&](float depth_m) -> Eigen::Vector3d {
        return seen.T_world_camera * (seen.camera.ray(u, v) * double{depth_m});
      };
      algorithm_6(modes[id], {levels((*frame.color)(u, v)), seen.weight(u, v), point(frame.depth(u, v))}, point(d_e),
                  config);
    }
  }
}

}  // namespace saccade::test
