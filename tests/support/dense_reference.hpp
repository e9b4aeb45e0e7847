// SPDX-License-Identifier: Apache-2.0
#pragma once
// DenseReference: the map as a plain array of voxels, updated one by one. Slow, obvious, and what bricks are held to.

#include <unordered_map>
#include <vector>

#include "saccade/map/internal/tsdf_math.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade::test {

/// A cube of voxels [-half, half)³, every one visited by every operation. Follows the rules of design §3: eq. 2.1–2.3,
/// and where v = 1 the weight saturates at W_th.
class DenseReference {
 public:
  DenseReference(const TsdfConfig& config, int half_edge)
      : config_{config},
        half_{half_edge},
        voxels_(static_cast<std::size_t>(8) * cube(half_edge)),
        colors_(voxels_.size()) {}

  void integrate(const PinholeCamera& camera, const DepthImage& depth, const Pose& T_world_camera,
                 const ColorImage* color) {
    const tsdf::FusionCamera fusion_camera{static_cast<float>(camera.fx),
                                           static_cast<float>(camera.fy),
                                           static_cast<float>(camera.cx),
                                           static_cast<float>(camera.cy),
                                           camera.width,
                                           camera.height,
                                           static_cast<float>(config_.truncation_m()),
                                           static_cast<float>(1.0 / config_.truncation_m())};
    const Pose T_camera_world = T_world_camera.inverse();
    std::optional<Index3> current_brick;
    tsdf::BrickFrame brick_frame{};
    for_each([&](const Index3& index, Voxel& voxel, Rgb8& voxel_color) {
      // A voxel's position is defined relative to its brick: that is part of the arithmetic, not of the storage.
      const Index3 brick = parent(index);
      const Index3 offset = child_offset(child_index(index));
      if (current_brick != brick) brick_frame = frame(T_camera_world, brick);
      current_brick = brick;
      const tsdf::Float3 p = tsdf::voxel_in_camera(brick_frame, offset.x, offset.y, offset.z);
      const tsdf::Pixel pixel = tsdf::pixel_of(fusion_camera, p);
      if (!pixel.inside) return;
      const int u = pixel.u;
      const int v = pixel.v;
      const int sample = tsdf::sample_voxel(fusion_camera, p, range(camera, fusion_camera, u, v, depth(u, v)));
      if (sample == tsdf::kNotSeen) return;
      const Voxel before = voxel;
      const int counts_as = tsdf::clearing_sample(before.v, before.w, sample, config_.clearing_share());
      voxel.v = tsdf::average_v(before.v, before.w, counts_as);
      voxel.w = tsdf::next_w(voxel.v, before.w, config_.max_weight, config_.free_weight);
      if (color != nullptr && config_.color && std::abs(sample) < tsdf::kSampleOne) {
        const bool first = voxel_color == Rgb8{};
        for (std::size_t c = 0; c < 3; ++c) {
          voxel_color[c] = tsdf::average_color(voxel_color[c], first ? std::uint16_t{0} : before.w, (*color)(u, v)[c]);
        }
        if (voxel_color == Rgb8{}) voxel_color = {1, 1, 1};
      }
    });
  }

  void forget(const Region& region) {
    for_each([&](const Index3& index, Voxel& voxel, Rgb8& color) {
      if (!contains(region, voxel_center(index, config_.voxel_size_m))) return;
      voxel = {};
      color = {};
    });
  }
  void free(const Region& region) {
    for_each([&](const Index3& index, Voxel& voxel, Rgb8& color) {
      if (!contains(region, voxel_center(index, config_.voxel_size_m))) return;
      voxel = {kTsdfOne, config_.free_weight};
      color = {};
    });
  }

  template <class Body>
  void for_each(const Body& body) {
    std::size_t i{0};
    for (int z = -half_; z < half_; ++z) {
      for (int y = -half_; y < half_; ++y) {
        for (int x = -half_; x < half_; ++x, ++i) body(Index3{x, y, z}, voxels_[i], colors_[i]);
      }
    }
  }

 private:
  static std::size_t cube(int n) {
    const auto k = static_cast<std::size_t>(n);
    return k * k * k;
  }
  [[nodiscard]] tsdf::BrickFrame frame(const Pose& T_camera_world, const Index3& brick) const {
    const auto to_float = [](const Eigen::Vector3d& p) {
      return tsdf::Float3{static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
    };
    const Eigen::Matrix3d step = T_camera_world.linear() * config_.voxel_size_m;
    return {to_float(T_camera_world * voxel_center(brick * kBrickEdge, config_.voxel_size_m)), to_float(step.col(0)),
            to_float(step.col(1)), to_float(step.col(2))};
  }
  static float range(const PinholeCamera& camera, const tsdf::FusionCamera& fusion_camera, int u, int v, float d) {
    if (std::isnan(d) || d == 0.0F) return 0.0F;
    if (d > 0.0F && (d < static_cast<float>(camera.min_range_m) || d > static_cast<float>(camera.max_range_m)))
      return 0.0F;
    if (d < 0.0F) d = std::max(d, -static_cast<float>(camera.max_range_m));
    return tsdf::range_of_depth(fusion_camera, u, v, d);
  }

  TsdfConfig config_;
  int half_;
  std::vector<Voxel> voxels_;
  std::vector<Rgb8> colors_;
};

}  // namespace saccade::test
