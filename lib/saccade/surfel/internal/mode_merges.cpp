// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/internal/mode_merges.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/surfel/internal/mode_merges.cpp"
#include "saccade/core/simd_kernels.hpp"
#include "saccade/surfel/internal/surfel_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

void merge_kernel(const BackProjection& back_project, std::size_t count, ModeMerges& merges) {
  const Tag d;
  const hn::RebindToSigned<Tag> di;
  auto& mode = merges.mode;
  const auto& pixel = merges.pixel;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    Vector position;
    V weight;
    hn::LoadInterleaved4(d, &mode.places[i].x_m, position.x, position.y, position.z, weight);
    const V w = load(&pixel.weight[i]);
    const V total = hn::Add(weight, w);
    const V share = hn::Div(w, total);
    const auto mean_channel = [&](std::int32_t* of_mode, const std::int32_t* of_pixel) HWY_ATTR {
      const auto from = hn::LoadU(di, of_mode);
      const V way = hn::ConvertTo(d, hn::Sub(hn::LoadU(di, of_pixel), from));
      hn::StoreU(hn::Add(from, hn::NearestInt(hn::Mul(way, share))), di, of_mode);
    };
    mean_channel(&mode.r[i], &pixel.r[i]);
    mean_channel(&mode.g[i], &pixel.g[i]);
    mean_channel(&mode.b[i], &pixel.b[i]);
    const Vector p = back_projected(back_project, load(&pixel.u[i]), load(&pixel.v[i]), load(&pixel.depth_m[i]));
    position = mean(position, p, share);
    hn::StoreInterleaved4(position.x, position.y, position.z, total, d, &mode.places[i].x_m);
  }
}

void ways_kernel(const BackProjection& back_project, std::size_t count, DepthSteps& steps) {
  const Tag d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V u = load(&steps.u[i]);
    const V v = load(&steps.v[i]);
    const Vector way = difference(back_projected(back_project, u, v, load(&steps.to_m[i])),
                                  back_projected(back_project, u, v, load(&steps.from_m[i])));
    hn::StoreU(way.x, d, &steps.x_m[i]);
    hn::StoreU(way.y, d, &steps.y_m[i]);
    hn::StoreU(way.z, d, &steps.z_m[i]);
  }
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(merge_kernel);
HWY_EXPORT(ways_kernel);

}  // namespace

void merge_pixels(const BackProjection& back_project, std::size_t count, ModeMerges& merges) {
  HWY_DYNAMIC_DISPATCH(merge_kernel)(back_project, count, merges);
}

void find_ways(const BackProjection& back_project, std::size_t count, DepthSteps& steps) {
  HWY_DYNAMIC_DISPATCH(ways_kernel)(back_project, count, steps);
}

}  // namespace saccade
#endif  // HWY_ONCE
