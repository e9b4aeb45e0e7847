// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/completed_objects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saccade/views/internal/find_supports.hpp"

namespace saccade {
namespace {

constexpr std::int32_t kAboveSupport{2};  // voxels: what lies lower is the support's own noise
constexpr std::int32_t kBelowSupport{8};  // voxels behind the support's surface that fusion marks
constexpr int kGap{2};                    // voxels between parts of one object
constexpr std::size_t kLeastVoxels{12};   // objects of fewer are noise

/// Layers of a support's surface, column by column.
using TopLayers = std::vector<std::int32_t>;

/// Occupied voxels that are part of no support.
std::vector<std::uint32_t> voxels_of_objects(const StateVolume& volume, std::span<const TopLayers> tops) {
  const auto layer = static_cast<std::size_t>(volume.layer());
  std::vector<std::uint32_t> voxels;
  for (std::size_t i = 0; i < volume.size(); ++i) {
    if (volume[i] != VoxelState::occupied) continue;
    const auto z = static_cast<std::int32_t>(i / layer);
    const bool of_support = std::any_of(tops.begin(), tops.end(), [&](const TopLayers& top) {
      const std::int32_t t = top[i % layer];
      return t != kNoLayer && z < t + kAboveSupport && z >= t - kBelowSupport;
    });
    if (!of_support) voxels.push_back(static_cast<std::uint32_t>(i));
  }
  return voxels;
}

/// Voxels of one object after the other, and where each object begins.
struct Parts {
  std::vector<std::uint32_t> voxels;
  std::vector<std::size_t> starts;
};

Parts connected(const StateVolume& volume, std::span<const std::uint32_t> seen) {
  enum : std::uint8_t { kOther, kWaiting, kTaken };
  std::vector<std::uint8_t> states(volume.size(), kOther);
  for (const std::uint32_t i : seen) states[i] = kWaiting;
  Parts parts;
  const IndexBox& box = volume.box();
  for (const std::uint32_t seed : seen) {
    if (states[seed] != kWaiting) continue;
    const std::size_t start = parts.voxels.size();
    parts.voxels.push_back(seed);
    states[seed] = kTaken;
    for (std::size_t next = start; next < parts.voxels.size(); ++next) {
      const IndexBox around =
          IndexBox{volume.voxel(parts.voxels[next]), volume.voxel(parts.voxels[next]) + Index3{1, 1, 1}}
              .grown(kGap)
              .intersection(box);
      for (std::int32_t z = around.lo.z; z < around.hi.z; ++z) {
        for (std::int32_t y = around.lo.y; y < around.hi.y; ++y) {
          std::size_t i = volume.index({around.lo.x, y, z});
          for (std::int32_t x = around.lo.x; x < around.hi.x; ++x, ++i) {
            if (states[i] != kWaiting) continue;
            states[i] = kTaken;
            parts.voxels.push_back(static_cast<std::uint32_t>(i));
          }
        }
      }
    }
    if (parts.voxels.size() - start < kLeastVoxels) {
      parts.voxels.resize(start);
    } else {
      parts.starts.push_back(start);
    }
  }
  parts.starts.push_back(parts.voxels.size());
  return parts;
}

/// Returns the support on which an object stands: the highest that is below most of its voxels; nullptr: none is.
const TopLayers* base_of(std::span<const TopLayers> tops, std::span<const std::uint32_t> voxels, std::size_t layer) {
  const TopLayers* base = nullptr;
  std::int64_t highest{0};
  for (const TopLayers& top : tops) {
    std::size_t above{0};
    std::int64_t sum{0};
    for (const std::uint32_t i : voxels) {
      const std::int32_t t = top[i % layer];
      if (t == kNoLayer || t > static_cast<std::int32_t>(i / layer)) continue;
      ++above;
      sum += t;
    }
    if (above == 0 || 2 * above < voxels.size()) continue;
    const std::int64_t mean = sum / static_cast<std::int64_t>(above);
    if (base != nullptr && mean <= highest) continue;
    base = &top;
    highest = mean;
  }
  return base;
}

}  // namespace

CompletedObjects complete_objects(const StateVolume& volume, std::span<const Support> supports) {
  CompletedObjects result;
  std::vector<TopLayers> tops;
  for (const Support& support : supports) tops.push_back(top_layers(volume, support));
  const Parts parts = connected(volume, voxels_of_objects(volume, tops));
  result.count = parts.starts.size() - 1;
  result.is_inside.assign(volume.size(), 0);
  const auto layer = static_cast<std::size_t>(volume.layer());
  for (std::size_t part = 0; part < result.count; ++part) {
    const std::span<const std::uint32_t> voxels =
        std::span{parts.voxels}.subspan(parts.starts[part], parts.starts[part + 1] - parts.starts[part]);
    std::vector<std::uint32_t> columns;
    std::size_t lowest = volume.size();
    std::size_t highest = 0;
    for (const std::uint32_t i : voxels) {
      columns.push_back(static_cast<std::uint32_t>(i % layer));
      lowest = std::min(lowest, i / layer);
      highest = std::max(highest, i / layer);
    }
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
    const std::vector<std::uint32_t> footprint = hull_columns(columns, static_cast<std::int32_t>(volume.row()));
    const TopLayers* base = base_of(tops, voxels, layer);
    for (const std::uint32_t column : footprint) {
      // Where the hull reaches beyond the support, the object ends at its lowest voxel.
      const bool stands = base != nullptr && (*base)[column] != kNoLayer;
      const std::size_t first = stands ? static_cast<std::size_t>(std::max((*base)[column], 0)) : lowest;
      for (std::size_t z = first; z <= highest; ++z) result.is_inside[z * layer + column] = 1;
      for (std::size_t z = first > 2 ? first - 2 : 0; z < first && stands; ++z) {
        if (result.is_inside[z * layer + column] == 0) result.is_inside[z * layer + column] = 2;
      }
    }
  }
  result.seen = parts.voxels;
  std::sort(result.seen.begin(), result.seen.end());
  return result;
}

std::vector<float> distance_to_objects(const StateVolume& volume, const CompletedObjects& objects, double reach_m) {
  const Index3 full = volume.box().size();
  const Index3 size{(full.x + 1) / 2, (full.y + 1) / 2, (full.z + 1) / 2};
  constexpr float kFar{std::numeric_limits<float>::infinity()};
  const std::size_t row = static_cast<std::size_t>(size.x);
  const std::size_t layer = row * static_cast<std::size_t>(size.y);
  std::vector<float> distances(layer * static_cast<std::size_t>(size.z), kFar);
  for (const std::uint32_t i : objects.seen) distances[half_resolution_index(volume, i)] = 0.0F;
  const auto cell_m = static_cast<float>(2.0 * volume.voxel_size_m());
  // Two sweeps of a chamfer distance: each over the 13 neighbours that come before a cell, and those that come after.
  struct Step {
    Index3 to;
    float m;
  };
  std::vector<Step> steps;
  for (std::int32_t z = -1; z <= 0; ++z) {
    for (std::int32_t y = -1; y <= 1; ++y) {
      for (std::int32_t x = -1; x <= 1; ++x) {
        if (z == 0 && (y > 0 || (y == 0 && x >= 0))) continue;
        steps.push_back({{x, y, z}, cell_m * std::sqrt(static_cast<float>(x * x + y * y + z * z))});
      }
    }
  }
  const IndexBox all{{0, 0, 0}, size};
  const auto relax = [&](const Index3& at, std::int32_t sign) {
    const auto index = [&](const Index3& i) {
      return static_cast<std::size_t>(i.z) * layer + static_cast<std::size_t>(i.y) * row +
             static_cast<std::size_t>(i.x);
    };
    float& here = distances[index(at)];
    for (const Step& step : steps) {
      const Index3 from = at + step.to * sign;
      if (all.contains(from)) here = std::min(here, distances[index(from)] + step.m);
    }
  };
  all.for_each([&](const Index3& at) { relax(at, 1); });
  for (std::int32_t z = size.z; z-- > 0;) {
    for (std::int32_t y = size.y; y-- > 0;) {
      for (std::int32_t x = size.x; x-- > 0;) relax({x, y, z}, -1);
    }
  }
  for (float& d : distances) {
    if (d > static_cast<float>(reach_m)) d = kFar;
  }
  return distances;
}

}  // namespace saccade
