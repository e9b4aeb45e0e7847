// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/internal/surfel_averages.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/surfel/internal/surfel_averages.cpp"
#include "saccade/core/simd_kernels.hpp"
#include "saccade/surfel/internal/surfel_lanes-inl.hpp"

#ifndef SACCADE_SURFEL_AVERAGES_BATCH
#define SACCADE_SURFEL_AVERAGES_BATCH
namespace saccade {
namespace {

constexpr std::size_t kBatch{32};
/// Largest ratio of radii that are averaged; a larger radius comes from too far away to inform this surfel's.
constexpr float kComparableRadius{1.5F};
static_assert(sizeof(SurfelDisc) == 8 * sizeof(float) && sizeof(SurfelColor) == 4 * sizeof(float));

/// Surfels and their pixels, gathered from memory.
struct Batch {
  float places[4 * kBatch]{};   ///< x, y, z, radius
  float normals[4 * kBatch]{};  ///< x, y, z, weight
  float colors[4 * kBatch]{};   ///< r, g, b, weight
  float u[kBatch]{}, v[kBatch]{}, w[kBatch]{};
  float z[kBatch]{}, nx[kBatch]{}, ny[kBatch]{}, nz[kBatch]{};
  float r[kBatch]{}, g[kBatch]{}, b[kBatch]{};  ///< 0 … 255
};

}  // namespace
}  // namespace saccade
#endif

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

/// Data shared by all pixels of a frame.
struct View {
  BackProjection back_project;
  float focal;
  float max_radius_m;
  float least_slope;
};

HWY_INLINE void average_discs(const View& view, Batch& batch, std::size_t i) {
  const Tag d;
  const V w = load(batch.w + i);
  const V z = load(batch.z + i);
  const Vector p = back_projected(view.back_project, load(batch.u + i), load(batch.v + i), z);
  const Vector n_camera{load(batch.nx + i), load(batch.ny + i), load(batch.nz + i)};
  const Vector n = turned(view.back_project.R_world_camera, n_camera);
  const V slope = hn::Max(hn::Abs(n_camera.z), set(view.least_slope));
  const V across = hn::Div(hn::Div(hn::Mul(set(std::numbers::sqrt2_v<float>), z), set(view.focal)), slope);
  const V radius_seen = hn::Min(across, set(view.max_radius_m));

  Vector position;
  Vector normal;
  V radius;
  V weight;
  hn::LoadInterleaved4(d, batch.places + 4 * i, position.x, position.y, position.z, radius);
  hn::LoadInterleaved4(d, batch.normals + 4 * i, normal.x, normal.y, normal.z, weight);
  const auto is_old = hn::Gt(weight, hn::Zero(d));
  const V sum = hn::Add(weight, w);
  const V share = hn::Div(w, sum);
  const Vector mean_normal = mean(normal, n, share);
  const V squared = dot(mean_normal, mean_normal);
  const V length = hn::IfThenElse(hn::Gt(squared, hn::Zero(d)), hn::Sqrt(squared), set(1.0F));
  const Vector unit{hn::Div(mean_normal.x, length), hn::Div(mean_normal.y, length), hn::Div(mean_normal.z, length)};
  const auto comparable = hn::Lt(radius_seen, hn::Mul(set(kComparableRadius), radius));
  const V mean_radius = hn::IfThenElse(comparable, mean(radius, radius_seen, share), radius);
  position = choose(is_old, mean(position, p, share), p);
  normal = choose(is_old, unit, n);
  radius = hn::IfThenElse(is_old, mean_radius, radius_seen);
  hn::StoreInterleaved4(position.x, position.y, position.z, radius, d, batch.places + 4 * i);
  hn::StoreInterleaved4(normal.x, normal.y, normal.z, sum, d, batch.normals + 4 * i);
}

HWY_INLINE void average_colors(Batch& batch, std::size_t i) {
  const Tag d;
  const V unit = set(255.0F);
  const Vector seen{hn::Div(load(batch.r + i), unit), hn::Div(load(batch.g + i), unit),
                    hn::Div(load(batch.b + i), unit)};
  const V w = load(batch.w + i);
  Vector color;
  V weight;
  hn::LoadInterleaved4(d, batch.colors + 4 * i, color.x, color.y, color.z, weight);
  const V sum = hn::Add(weight, w);
  color = mean(color, seen, hn::Div(w, sum));
  hn::StoreInterleaved4(color.x, color.y, color.z, sum, d, batch.colors + 4 * i);
}

/// Gathers the k-th element of a batch.
HWY_INLINE void bring(const ObservedFrame& frame, const SurfelMap& map, const SurfelPixel& pixel, std::size_t k,
                      Batch& batch) {
  const bool is_new = pixel.id >= frame.seen.first_new;
  if (is_new) {
    std::memset(batch.places + 4 * k, 0, 4 * sizeof(float));
    std::memset(batch.normals + 4 * k, 0, 4 * sizeof(float));
    std::memset(batch.colors + 4 * k, 0, 4 * sizeof(float));
  } else {
    const float* disc = map.discs[pixel.id].position_m.data();
    std::memcpy(batch.places + 4 * k, disc, 4 * sizeof(float));
    std::memcpy(batch.normals + 4 * k, disc + 4, 4 * sizeof(float));
    std::memcpy(batch.colors + 4 * k, map.colors[pixel.id].color.data(), 4 * sizeof(float));
  }
  const std::size_t i = static_cast<std::size_t>(pixel.v) * static_cast<std::size_t>(frame.points.z.width()) + pixel.u;
  batch.u[k] = static_cast<float>(pixel.u);
  batch.v[k] = static_cast<float>(pixel.v);
  batch.w[k] = frame.seen.weight(pixel.u, pixel.v);
  batch.z[k] = frame.points.z.data()[i];
  batch.nx[k] = frame.points.nx.data()[i];
  batch.ny[k] = frame.points.ny.data()[i];
  batch.nz[k] = frame.points.nz.data()[i];
  if (frame.color != nullptr) {
    const Rgb8& color = frame.color->data()[i];
    batch.r[k] = static_cast<float>(color[0]);
    batch.g[k] = static_cast<float>(color[1]);
    batch.b[k] = static_cast<float>(color[2]);
  }
}

HWY_INLINE void take_back(const Batch& batch, std::size_t k, SurfelId id, SurfelMap& map) {
  float* disc = map.discs[id].position_m.data();
  std::memcpy(disc, batch.places + 4 * k, 4 * sizeof(float));
  std::memcpy(disc + 4, batch.normals + 4 * k, 4 * sizeof(float));
  std::memcpy(map.colors[id].color.data(), batch.colors + 4 * k, 4 * sizeof(float));
}

void average_kernel(const ObservedFrame& frame, std::span<const SurfelPixel> pixels, SurfelMap& map) {
  const View view{BackProjection{frame.seen},
                  static_cast<float>(std::sqrt(frame.seen.camera.fx * frame.seen.camera.fy)), frame.max_radius_m,
                  frame.least_slope};
  const std::size_t lanes = hn::Lanes(Tag{});
  Batch batch;
  for (std::size_t first = 0; first < pixels.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, pixels.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      if (first + k + kBatch < pixels.size()) {
        const SurfelId ahead = pixels[first + k + kBatch].id;
        __builtin_prefetch(&map.discs[ahead], 1);
        __builtin_prefetch(&map.colors[ahead], 1);
      }
      bring(frame, map, pixels[first + k], k, batch);
    }
    for (std::size_t k = 0; k < count; k += lanes) average_discs(view, batch, k);
    for (std::size_t k = 0; frame.color != nullptr && k < count; k += lanes) average_colors(batch, k);
    for (std::size_t k = 0; k < count; ++k) take_back(batch, k, pixels[first + k].id, map);
  }
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(average_kernel);

}  // namespace

void average_pixels(const ObservedFrame& frame, std::span<const SurfelPixel> pixels, SurfelMap& map) {
  HWY_DYNAMIC_DISPATCH(average_kernel)(frame, pixels, map);
}

}  // namespace saccade
#endif  // HWY_ONCE
