// SPDX-License-Identifier: Apache-2.0
#pragma once
// naive_guided_filter: Algorithm 7 by its definition, a sum over the whole window at every pixel.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/surfel/guided_filter.hpp"

namespace saccade::test {

/// The images of one call.
struct GuidedImages {
  int width{0};
  int height{0};
  std::vector<float> depth_m;
  std::vector<Eigen::Vector4f> guidance;
  std::vector<std::uint8_t> used;
};

/// Calls visit(pixel) for the pixels that are used, inside the image, and in the window around (u, v).
template <class Visit>
void for_window(const GuidedImages& images, int radius_px, int u, int v, const Visit& visit) {
  for (int dv = -radius_px; dv <= radius_px; ++dv) {
    if (v + dv < 0 || v + dv >= images.height) continue;
    int half_width{0};
    while ((half_width + 1) * (half_width + 1) + dv * dv <= radius_px * radius_px) ++half_width;
    const int end = std::min(images.width - 1, u + half_width);
    for (int column = std::max(0, u - half_width); column <= end; ++column) {
      const auto pixel = static_cast<std::size_t>((v + dv) * images.width + column);
      if (images.used[pixel] != 0) visit(pixel);
    }
  }
}

/// In double precision; sums are relative to the window's middle, so that differences of them lose nothing. Pixels that
/// are not used come out as they are.
inline std::vector<double> naive_guided_filter(const GuidedFilterConfig& config, const GuidedImages& images,
                                               const Executor& executor) {
  struct Fit {
    Eigen::Vector4d a;
    double b;
  };
  const double color_variance = config.color_sigma * config.color_sigma;
  const Eigen::Vector4d variances{color_variance, color_variance, color_variance,
                                  config.depth_sigma_m * config.depth_sigma_m};
  const auto for_used = [&](const auto& visit) {
    executor.parallel_for(static_cast<std::size_t>(images.height), 16, [&](std::size_t begin, std::size_t end) {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
        for (int u = 0; u < images.width; ++u) {
          const auto pixel = static_cast<std::size_t>(v * images.width + u);
          if (images.used[pixel] != 0) visit(u, v, pixel);
        }
      }
    });
  };

  std::vector<Fit> fits(images.used.size());
  for_used([&](int u, int v, std::size_t middle) {
    const Eigen::Vector4d guidance_0 = images.guidance[middle].cast<double>();
    const double depth_0 = images.depth_m[middle];
    double count{0.0};
    double depth{0.0};
    Eigen::Vector4d guidance = Eigen::Vector4d::Zero();
    Eigen::Vector4d guidance_depth = Eigen::Vector4d::Zero();
    Eigen::Matrix4d guidance_guidance = Eigen::Matrix4d::Zero();
    for_window(images, config.radius_px, u, v, [&](std::size_t pixel) {
      const Eigen::Vector4d g = images.guidance[pixel].cast<double>() - guidance_0;
      const double d = images.depth_m[pixel] - depth_0;
      count += 1.0;
      depth += d;
      guidance += g;
      guidance_depth += g * d;
      guidance_guidance += g * g.transpose();
    });
    const Eigen::Vector4d mu = guidance / count;
    const double delta = depth / count;
    Eigen::Matrix4d sigma = guidance_guidance / count - mu * mu.transpose();
    sigma.diagonal() += variances;
    const Eigen::Vector4d kappa = guidance_depth / count - mu * delta;
    const Eigen::Vector4d a = sigma.ldlt().solve(kappa);
    fits[middle] = {a, depth_0 + delta - a.dot(mu + guidance_0)};
  });

  std::vector<double> enhanced_m(images.depth_m.begin(), images.depth_m.end());
  for_used([&](int u, int v, std::size_t middle) {
    double count{0.0};
    Fit sum{Eigen::Vector4d::Zero(), 0.0};
    for_window(images, config.radius_px, u, v, [&](std::size_t pixel) {
      count += 1.0;
      sum.a += fits[pixel].a;
      sum.b += fits[pixel].b;
    });
    enhanced_m[middle] = (sum.a.dot(images.guidance[middle].cast<double>()) + sum.b) / count;
  });
  return enhanced_m;
}

/// Distance in units of the last place of a float at `exact`.
inline double ulps(float value, double exact) {
  const float nearest = std::abs(static_cast<float>(exact));
  const double unit = double{std::nextafter(nearest, INFINITY)} - double{nearest};
  return std::abs(double{value} - exact) / unit;
}

}  // namespace saccade::test
