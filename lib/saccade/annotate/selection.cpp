// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/selection.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "saccade/annotate/internal/seen_surface.hpp"
#include "saccade/annotate/internal/splat_depth.hpp"

namespace saccade {

namespace {

constexpr std::size_t kGrain{16'384};
constexpr std::size_t kDrawnAtOnce{1024};

using Indices = std::vector<std::uint32_t>;

Error bad_selection(const char* what) { return {Errc::invalid_argument, what, "selection"}; }

std::size_t chunk_count(std::size_t points) { return (points + kGrain - 1) / kGrain; }

Indices joined(const std::vector<Indices>& chunks) {
  std::size_t count{0};
  for (const Indices& chunk : chunks) count += chunk.size();
  Indices all;
  all.reserve(count);
  for (const Indices& chunk : chunks) all.insert(all.end(), chunk.begin(), chunk.end());
  return all;
}

/// Returns the pixel of a point in view.
int pixel(double px) { return static_cast<int>(px); }

/// Point in the shape that may still be hidden.
struct Candidate {
  std::uint32_t point;
  std::uint16_t u, v;
  float depth_m;
};

/// Radius of a line just wide enough to have no gaps.
constexpr double kLineRadius_px{0.75};

/// Draws all points, and visits those in view; one thread at a time visits those of a chunk.
template <class Visit>
void draw(std::span<const Eigen::Vector3f> positions_m, const ScreenProjection& project, SplatDepth& surface,
          const Executor& executor, const Visit& visit) {
  const std::size_t chunks = chunk_count(positions_m.size());
  executor.parallel_for(surface.layers(), 1, [&](std::size_t layer, std::size_t) {
    const std::size_t begin = kGrain * (chunks * layer / surface.layers());
    const std::size_t end = std::min(positions_m.size(), kGrain * (chunks * (layer + 1) / surface.layers()));
    std::vector<ScreenPosition> in_view;
    for (std::size_t i = begin; i < end; ++i) {
      const ScreenPosition at = project(positions_m[i]);
      if (at.in_view()) {
        in_view.push_back(at);
        visit(i, at);
      }
      if (in_view.size() < kDrawnAtOnce && i + 1 < end) continue;
      surface.add(layer, in_view);
      in_view.clear();
    }
  });
  surface.finish(executor);
}

/// Balls of one radius, indexed by the cells of a grid that they may reach.
class Balls {
 public:
  Balls(const std::vector<Eigen::Vector3d>& centres_m, double radius_m) : radius2_m2_{radius_m * radius_m} {
    least_ = greatest_ = centres_m.front();
    for (const Eigen::Vector3d& centre : centres_m) {
      least_ = least_.cwiseMin(centre);
      greatest_ = greatest_.cwiseMax(centre);
    }
    least_.array() -= radius_m;
    greatest_.array() += radius_m;
    edge_m_ = std::max(radius_m, (greatest_ - least_).maxCoeff() / kMostCells);
    for (const Eigen::Vector3d& centre : centres_m) {
      const Eigen::Array3d cell = cell_of(centre);
      for (int i = 0; i < 27; ++i) {
        cells_[key(cell + Eigen::Array3i{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}.cast<double>())].push_back(centre);
      }
    }
  }
  [[nodiscard]] bool contain(const Eigen::Vector3d& p) const {
    const bool near = (p.array() >= least_.array()).all() && (p.array() <= greatest_.array()).all();
    if (!near) return false;  // also for every point that is not finite
    const auto cell = cells_.find(key(cell_of(p)));
    return cell != cells_.end() && std::any_of(cell->second.begin(), cell->second.end(), [&](const auto& centre) {
             return (p - centre).squaredNorm() <= radius2_m2_;
           });
  }

 private:
  static constexpr double kMostCells{1 << 20};  // in a row; a key has room for twice as many

  [[nodiscard]] Eigen::Array3d cell_of(const Eigen::Vector3d& p) const {
    return ((p - least_).array() / edge_m_).floor();
  }
  [[nodiscard]] static std::uint64_t key(const Eigen::Array3d& cell) {
    const auto axis = [&](Eigen::Index i) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(cell[i]) + 1);
    };
    return axis(0) | axis(1) << 21U | axis(2) << 42U;
  }

  Eigen::Vector3d least_, greatest_;
  double radius2_m2_;
  double edge_m_;
  std::unordered_map<std::uint64_t, std::vector<Eigen::Vector3d>> cells_;
};

}  // namespace

Result<Indices> select_points(std::span<const Eigen::Vector3f> positions_m, const SelectionView& view,
                              const ScreenShape& shape, double below_m, const Executor& executor, SurfaceRule rule) {
  SACCADE_CHECK(view.validate());
  SACCADE_CHECK(validate(shape));
  if (!(below_m >= 0.0)) return bad_selection("below_m must not be negative");
  const ScreenMask mask{shape, view.width, view.height};
  if (mask.window().empty()) return Indices{};
  const ScreenProjection project{view};
  std::vector<Indices> chunks(chunk_count(positions_m.size()));

  if (below_m == kAnyDepth_m) {
    executor.parallel_for(positions_m.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      Indices chunk;
      for (std::size_t i = begin; i < end; ++i) {
        const ScreenPosition at = project(positions_m[i]);
        if (!at.in_view() || !mask.contains(pixel(at.u_px), pixel(at.v_px))) continue;
        chunk.push_back(static_cast<std::uint32_t>(i));
      }
      chunks[begin / kGrain] = std::move(chunk);
    });
    return joined(chunks);
  }

  const bool as_printed = rule == SurfaceRule::as_printed;
  const PixelWindow& window = mask.window();
  SplatDepth surface{as_printed ? window : SeenSurface::surroundings(window, view), view.point_size_px,
                     positions_m.size(), executor};
  std::vector<std::vector<Candidate>> candidates(chunks.size());
  draw(positions_m, project, surface, executor, [&](std::size_t i, const ScreenPosition& at) {
    const int u = pixel(at.u_px);
    const int v = pixel(at.v_px);
    if (!mask.contains(u, v)) return;
    candidates[i / kGrain].push_back(
        {static_cast<std::uint32_t>(i), static_cast<std::uint16_t>(u), static_cast<std::uint16_t>(v), at.depth_m});
  });
  const auto keep = [&](const auto& is_selected) {
    executor.parallel_for(chunks.size(), 1, [&](std::size_t begin, std::size_t) {
      Indices& chunk = chunks[begin];
      chunk.resize(candidates[begin].size());
      std::size_t count{0};
      for (const Candidate& candidate : candidates[begin]) {
        chunk[count] = candidate.point;  // kept unless the next one overwrites it
        count += is_selected(candidate) ? 1 : 0;
      }
      chunk.resize(count);
    });
  };
  if (as_printed) {
    keep([&](const Candidate& at) { return static_cast<double>(at.depth_m) - surface.depth_m(at.u, at.v) <= below_m; });
  } else {
    const SeenSurface seen{surface, window, view, project, below_m, executor};
    keep([&](const Candidate& at) { return at.depth_m <= seen.limit_m(at.u, at.v); });
  }
  return joined(chunks);
}

Result<Indices> select_around(std::span<const Eigen::Vector3f> positions_m, const SelectionView& view,
                              std::span<const ScreenPoint> line, double radius_m, const Executor& executor) {
  SACCADE_CHECK(view.validate());
  const ScreenStroke drawn{{line.begin(), line.end()}, kLineRadius_px};
  SACCADE_CHECK(validate(drawn));
  if (!(radius_m > 0.0 && std::isfinite(radius_m))) return bad_selection("radius_m must be positive");
  const ScreenMask mask{drawn, view.width, view.height};
  const PixelWindow& window = mask.window();
  if (window.empty()) return Indices{};
  const ScreenProjection project{view};

  SplatDepth surface{window, view.point_size_px, positions_m.size(), executor};
  draw(positions_m, project, surface, executor, [](std::size_t, const ScreenPosition&) {});
  std::vector<Eigen::Vector3d> centres_m;
  for (int v = window.top; v < window.bottom; ++v) {
    for (int u = window.left; u < window.right; ++u) {
      const float depth_m = surface.depth_m(u, v);
      if (mask.contains(u, v) && std::isfinite(depth_m)) centres_m.push_back(project.place(u + 0.5, v + 0.5, depth_m));
    }
  }
  if (centres_m.empty()) return Indices{};

  const Balls balls{centres_m, radius_m};
  std::vector<Indices> chunks(chunk_count(positions_m.size()));
  executor.parallel_for(positions_m.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    Indices chunk;
    for (std::size_t i = begin; i < end; ++i) {
      if (!balls.contain(positions_m[i].cast<double>()) || !project(positions_m[i]).in_view()) continue;
      chunk.push_back(static_cast<std::uint32_t>(i));
    }
    chunks[begin / kGrain] = std::move(chunk);
  });
  return joined(chunks);
}

}  // namespace saccade
