// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/internal/morton_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace saccade::internal {
namespace {

constexpr std::size_t kGrain{1U << 20U};
constexpr unsigned kBucketBits{5};  // per axis: points are first put into 2¹⁵ buckets, each of which is then sorted
constexpr double kMostCell{(1U << kMortonBits) - 1};
constexpr std::size_t kBuckets{1U << (3 * kBucketBits)};
constexpr unsigned kBucketShift{3 * (kMortonBits - kBucketBits)};

/// Spreads 21 bits so that two zeros follow each.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32U) & 0x001f00000000ffffULL;
  bits = (bits | bits << 16U) & 0x001f0000ff0000ffULL;
  bits = (bits | bits << 8U) & 0x100f00f00f00f00fULL;
  bits = (bits | bits << 4U) & 0x10c30c30c30c30c3ULL;
  bits = (bits | bits << 2U) & 0x1249249249249249ULL;
  return bits;
}

/// Cube around the finite points, and the codes in it.
class Cube {
 public:
  Cube(std::span<const Eigen::Vector3f> positions_m, const Executor& executor) {
    const std::size_t chunks = (positions_m.size() + kGrain - 1) / kGrain;
    std::vector<Eigen::AlignedBox3f> boxes(chunks);
    executor.parallel_for(positions_m.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      Eigen::AlignedBox3f& box = boxes[begin / kGrain];
      for (std::size_t i = begin; i < end; ++i) {
        if (positions_m[i].allFinite()) box.extend(positions_m[i]);
      }
    });
    Eigen::AlignedBox3f box;
    for (const Eigen::AlignedBox3f& part : boxes) box.extend(part);
    if (box.isEmpty()) return;
    origin_m_ = box.min().cast<double>();
    const double longest_m = (box.max().cast<double>() - origin_m_).maxCoeff();
    if (longest_m > 0.0) edge_m_ = longest_m * (1.0 + std::numeric_limits<float>::epsilon());
    cells_per_m_ = std::ldexp(1.0, kMortonBits) / edge_m_;
  }

  [[nodiscard]] std::uint64_t code(const Eigen::Vector3f& p) const {
    const Eigen::Vector3d at = (p.cast<double>() - origin_m_) * cells_per_m_;
    const auto cell = [](double value) { return static_cast<std::uint64_t>(std::clamp(value, 0.0, kMostCell)); };
    return spread(cell(at.x())) | spread(cell(at.y())) << 1U | spread(cell(at.z())) << 2U;
  }
  [[nodiscard]] const Eigen::Vector3d& origin_m() const { return origin_m_; }
  [[nodiscard]] double edge_m() const { return edge_m_; }

 private:
  Eigen::Vector3d origin_m_{0.0, 0.0, 0.0};
  double edge_m_{1.0};
  double cells_per_m_{0.0};
};

bool comes_before(const MortonPoint& a, const MortonPoint& b) {
  return a.code != b.code ? a.code < b.code : a.point < b.point;
}

}  // namespace

MortonOrder morton_order(std::span<const Eigen::Vector3f> positions_m, const Executor& executor) {
  const Cube cube{positions_m, executor};
  // Parts of the cloud count their points per bucket, so that each knows where its own go.
  const std::size_t parts = std::clamp<std::size_t>(executor.threads(), 1, 16);
  const std::size_t part_size = (positions_m.size() + parts - 1) / std::max<std::size_t>(parts, 1);
  std::vector<std::vector<std::uint32_t>> places(parts, std::vector<std::uint32_t>(kBuckets, 0));
  const auto for_part = [&](std::size_t part, const auto& use) {
    const std::size_t end = std::min(positions_m.size(), (part + 1) * part_size);
    for (std::size_t i = std::min(part * part_size, end); i < end; ++i) {
      if (positions_m[i].allFinite()) use(static_cast<std::uint32_t>(i), cube.code(positions_m[i]));
    }
  };
  const auto in_parts = [&](const auto& work) {
    executor.parallel_for(parts, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end; ++part) work(part);
    });
  };
  in_parts([&](std::size_t part) {
    for_part(part, [&](std::uint32_t, std::uint64_t code) { ++places[part][code >> kBucketShift]; });
  });
  std::vector<std::uint32_t> starts(kBuckets + 1, 0);
  std::uint32_t total{0};
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    starts[bucket] = total;
    for (std::vector<std::uint32_t>& place : places) {
      const std::uint32_t count = place[bucket];
      place[bucket] = total;
      total += count;
    }
  }
  starts[kBuckets] = total;
  MortonOrder sorted;
  sorted.origin_m = cube.origin_m();
  sorted.edge_m = cube.edge_m();
  sorted.points.resize(total);
  in_parts([&](std::size_t part) {
    for_part(part, [&](std::uint32_t point, std::uint64_t code) {
      sorted.points[places[part][code >> kBucketShift]++] = {code, point};
    });
  });
  executor.parallel_for(kBuckets, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t bucket = begin; bucket < end; ++bucket) {
      std::sort(sorted.points.begin() + starts[bucket], sorted.points.begin() + starts[bucket + 1], comes_before);
    }
  });
  return sorted;
}

}  // namespace saccade::internal
