// SPDX-License-Identifier: Apache-2.0
#include "saccade/cloud/nearest_neighbours.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "saccade/cloud/internal/smallest_eigenvectors.hpp"

namespace saccade {
namespace {

constexpr std::size_t kNormalGrain{1024};

/// Σ p pᵀ over points p = (x, y, z, 1) relative to one of them, so that single precision suffices. Stored by rows.
struct Moments {
  Eigen::Vector4f x, y, z, one;
};

/// Returns the moments of a node alone.
Moments one_point() {
  const Eigen::Vector4f zero = Eigen::Vector4f::Zero();
  return {zero, zero, zero, Eigen::Vector4f::UnitW()};
}

/// Adds a point, `offset` = (x, y, z, 0) from here.
void add_point(Moments& moments, const Eigen::Vector4f& offset) {
  const Eigen::Vector4f p = offset + Eigen::Vector4f::UnitW();
  moments.x += p.x() * p;
  moments.y += p.y() * p;
  moments.z += p.z() * p;
  moments.one += p;
}

/// Adds the moments of the points around another node, `offset` from here: T M Tᵀ, where T moves by the offset.
void add_moved(Moments& moments, const Moments& other, const Eigen::Vector4f& offset) {
  const Eigen::Vector4f x = other.x + offset.x() * other.one;
  const Eigen::Vector4f y = other.y + offset.y() * other.one;
  const Eigen::Vector4f z = other.z + offset.z() * other.one;
  moments.x += x + x.w() * offset;
  moments.y += y + y.w() * offset;
  moments.z += z + z.w() * offset;
  moments.one += other.one + other.one.w() * offset;
}

void set_covariance(const Moments& moments, Covariances& covariances, std::size_t lane) {
  const float count = moments.one.w();
  const Eigen::Vector4f mean = moments.one / count;
  const Eigen::Vector4f x = moments.x / count - mean.x() * mean;
  const Eigen::Vector4f y = moments.y / count - mean.y() * mean;
  const Eigen::Vector4f z = moments.z / count - mean.z() * mean;
  covariances.entries[0][lane] = x.x();
  covariances.entries[1][lane] = x.y();
  covariances.entries[2][lane] = x.z();
  covariances.entries[3][lane] = y.y();
  covariances.entries[4][lane] = y.z();
  covariances.entries[5][lane] = z.z();
}

constexpr std::size_t kBlock{Covariances::kCount};  // nodes
using Block = std::array<Moments, kBlock>;

void set_normals(const Block& block, std::span<Eigen::Vector3f> normals) {
  Covariances covariances{};
  for (std::size_t i = 0; i < normals.size(); ++i) set_covariance(block[i], covariances, i);
  const Directions directions = smallest_eigenvectors(covariances);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    normals[i] = {directions.xyz[0][i], directions.xyz[1][i], directions.xyz[2][i]};
  }
}

}  // namespace

std::vector<Eigen::Vector3f> estimate_normals(const NearestNeighbours& neighbours, int rounds,
                                              const Executor& executor) {
  const std::size_t size = neighbours.order.size();
  if (neighbours.count < 2) return {size, Eigen::Vector3f::Zero()};
  std::vector<Eigen::Vector3f> normals(size);
  std::vector<Eigen::Vector4f> positions_m(size);
  executor.parallel_for(size, kNormalGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) positions_m[i] << neighbours.positions_m[i], 0.0F;
  });
  DiskVector<Moments> around(neighbours.nodes.get_allocator());
  for (int round = 0; round < rounds; ++round) {
    const bool is_last = round + 1 == rounds;
    DiskVector<Moments> wider(is_last ? 0 : size, around.get_allocator());
    executor.parallel_for(size, kNormalGrain, [&](std::size_t begin, std::size_t end) {
      Block block;
      for (std::size_t first = begin; first < end; first += kBlock) {
        const std::size_t count = std::min(end - first, kBlock);
        for (std::size_t i = 0; i < count; ++i) {
          const Eigen::Vector4f& here_m = positions_m[first + i];
          Moments moments = round == 0 ? one_point() : around[first + i];
          for (const std::uint32_t node : neighbours.of(first + i)) {
            const Eigen::Vector4f offset = positions_m[node] - here_m;
            round == 0 ? add_point(moments, offset) : add_moved(moments, around[node], offset);
          }
          block[i] = moments;
        }
        if (is_last) set_normals(block, {normals.data() + first, count});
        if (!is_last) std::copy_n(block.begin(), count, wider.begin() + static_cast<std::ptrdiff_t>(first));
      }
    });
    around = std::move(wider);
  }
  return normals;
}

}  // namespace saccade
