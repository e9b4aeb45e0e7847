// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/mesh_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "saccade/report/internal/canvas.hpp"
#include "saccade/report/internal/shading.hpp"

namespace saccade {
namespace {

constexpr float kNearest_m{0.01F};
constexpr int kBandRows{32};

struct ScreenVertex {
  float u, v, inv_z;
};

class Rasterizer {
 public:
  Rasterizer(Canvas& canvas, const TriangleMesh& mesh, const MeshPictureConfig& config)
      : canvas_{canvas},
        mesh_{mesh},
        use_colors_{config.use_colors && !mesh.colors.empty()},
        lamp_{lamp_of(canvas.view())} {}

  void run(const Executor& executor) {
    project(executor);
    sort_into_bands();
    executor.parallel_for(bands_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t band = begin; band < end; ++band) draw_band(band);
    });
  }

 private:
  void project(const Executor& executor) {
    screen_.resize(mesh_.vertices.size());
    const PinholeCamera& camera = canvas_.sample_camera();
    const Pose T_camera_world = canvas_.view().T_world_camera.inverse(Eigen::Isometry);
    constexpr std::size_t kGrain{1 << 14};
    executor.parallel_for(screen_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Eigen::Vector3d p = T_camera_world * mesh_.vertices[i].cast<double>();
        if (p.z() < kNearest_m) {
          screen_[i] = {0.0F, 0.0F, -1.0F};
          continue;
        }
        const Eigen::Vector2f at = camera.project(p).cast<float>();
        screen_[i] = {at.x(), at.y(), static_cast<float>(1.0 / p.z())};
      }
    });
  }

  /// Lists, per band of rows, the triangles that touch it, so that bands can be drawn in parallel.
  void sort_into_bands() {
    const int height = canvas_.sample_camera().height;
    bands_.resize(static_cast<std::size_t>((height + kBandRows - 1) / kBandRows));
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& [i, j, k] = mesh_.triangles[t];
      const std::array<const ScreenVertex*, 3> s{&screen_[i], &screen_[j], &screen_[k]};
      if (s[0]->inv_z < 0.0F || s[1]->inv_z < 0.0F || s[2]->inv_z < 0.0F) continue;
      const float top = std::min({s[0]->v, s[1]->v, s[2]->v});
      const float bottom = std::max({s[0]->v, s[1]->v, s[2]->v});
      if (!(bottom >= 0.0F) || !(top <= static_cast<float>(height - 1))) continue;
      const int first = std::max(0, static_cast<int>(top)) / kBandRows;
      const int last = static_cast<int>(std::min(bottom, static_cast<float>(height - 1))) / kBandRows;
      for (int band = first; band <= last; ++band) {
        bands_[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(t));
      }
    }
  }

  void draw_band(std::size_t band) {
    const int first = static_cast<int>(band) * kBandRows;
    const int last = std::min(canvas_.sample_camera().height, first + kBandRows) - 1;
    for (const std::uint32_t t : bands_[band]) draw_triangle(mesh_.triangles[t], first, last);
  }

  void draw_triangle(const std::array<std::uint32_t, 3>& corners, int first_row, int last_row) {
    const ScreenVertex& a = screen_[corners[0]];
    const ScreenVertex& b = screen_[corners[1]];
    const ScreenVertex& c = screen_[corners[2]];
    const float area = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
    if (area == 0.0F) return;
    const auto width = static_cast<float>(canvas_.sample_camera().width - 1);
    const float left = std::clamp(std::min({a.u, b.u, c.u}), 0.0F, width);
    const float right = std::clamp(std::max({a.u, b.u, c.u}), 0.0F, width);
    const float top = std::max(std::min({a.v, b.v, c.v}), static_cast<float>(first_row));
    const float bottom = std::min(std::max({a.v, b.v, c.v}), static_cast<float>(last_row));
    for (int v = static_cast<int>(std::ceil(top)); v <= static_cast<int>(std::floor(bottom)); ++v) {
      for (int u = static_cast<int>(std::ceil(left)); u <= static_cast<int>(std::floor(right)); ++u) {
        const auto x = static_cast<float>(u);
        const auto y = static_cast<float>(v);
        const float wb = ((x - a.u) * (c.v - a.v) - (y - a.v) * (c.u - a.u)) / area;
        const float wc = ((b.u - a.u) * (y - a.v) - (b.v - a.v) * (x - a.u)) / area;
        const float wa = 1.0F - wb - wc;
        if (wa < 0.0F || wb < 0.0F || wc < 0.0F) continue;
        const float inv_z = wa * a.inv_z + wb * b.inv_z + wc * c.inv_z;
        const float depth = 1.0F / inv_z;
        if (!(depth < canvas_.sample_depth()(u, v))) continue;
        const Eigen::Vector3f weights{wa * a.inv_z * depth, wb * b.inv_z * depth, wc * c.inv_z * depth};
        canvas_.plot(u, v, depth, color(corners, weights, u, v));
      }
    }
  }

  [[nodiscard]] Rgb8 color(const std::array<std::uint32_t, 3>& corners, const Eigen::Vector3f& weights, int u,
                           int v) const {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    if (mesh_.normals.empty()) {
      const Eigen::Vector3f& a = mesh_.vertices[corners[0]];
      normal = (mesh_.vertices[corners[1]] - a).cross(mesh_.vertices[corners[2]] - a).cast<double>();
    } else {
      for (int i = 0; i < 3; ++i) {
        normal += (weights[i] * mesh_.normals[corners[static_cast<std::size_t>(i)]]).cast<double>();
      }
    }
    const Eigen::Vector3d direction = canvas_.view().T_world_camera.linear() * canvas_.sample_camera().ray(u, v);
    Rgb8 base = kClay;
    if (use_colors_) {
      Eigen::Vector3f mixed = Eigen::Vector3f::Zero();
      for (int i = 0; i < 3; ++i) {
        const Rgb8& own = mesh_.colors[corners[static_cast<std::size_t>(i)]];
        mixed += weights[i] * Eigen::Vector3f{float(own[0]), float(own[1]), float(own[2])};
      }
      for (std::size_t i = 0; i < 3; ++i) base[i] = static_cast<std::uint8_t>(mixed[static_cast<int>(i)] + 0.5F);
    }
    return shaded(base, normal.stableNormalized(), direction, lamp_, use_colors_ ? kColorLight : kClayLight);
  }

  Canvas& canvas_;
  const TriangleMesh& mesh_;
  bool use_colors_;
  Eigen::Vector3d lamp_;
  std::vector<ScreenVertex> screen_;
  std::vector<std::vector<std::uint32_t>> bands_;
};

}  // namespace

void draw_mesh(Canvas& canvas, const TriangleMesh& mesh, const Executor& executor, const MeshPictureConfig& config) {
  Rasterizer{canvas, mesh, config}.run(executor);
}

ColorImage mesh_picture(const TriangleMesh& mesh, const Viewpoint& view, const Executor& executor,
                        const MeshPictureConfig& config) {
  Canvas canvas{view, config.background, config.samples};
  draw_mesh(canvas, mesh, executor, config);
  return canvas.finish();
}

}  // namespace saccade
