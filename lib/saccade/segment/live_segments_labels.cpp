// SPDX-License-Identifier: Apache-2.0
// Supervoxels of LiveSegments: labels of blocks, what supervoxels have in blocks, and their edges.
#include <algorithm>
#include <utility>

#include "saccade/segment/internal/supervoxel_growth.hpp"
#include "saccade/segment/internal/surface_block.hpp"
#include "saccade/segment/live_segments.hpp"

namespace saccade {

namespace {

constexpr std::size_t kLabelledGrain{32};
constexpr int kTileShift{4};  // tiles of 16³ blocks are labelled at once
constexpr double kReach_vox{8.0};
constexpr double kSeedRadius_vox{2.0};
constexpr VoxelName kNoSupervoxel{~VoxelName{0}};

Index3 tile_of(const Index3& key) { return {key.x >> kTileShift, key.y >> kTileShift, key.z >> kTileShift}; }

/// Returns the seed cell, of the eight in a block, that a voxel lies in.
std::size_t seed_cell(std::size_t child) {
  const Index3 i = child_offset(static_cast<int>(child));
  return static_cast<std::size_t>(((i.z >> 2) << 2) | ((i.y >> 2) << 1) | (i.x >> 2));
}

/// Voxels of some blocks as a cloud, with their seed cells.
struct BlockCloud {
  VoxelCloud cloud;
  std::vector<std::uint32_t> cell_of;
  std::size_t cells{0};
  std::vector<VoxelName> names;         ///< per voxel
  std::vector<std::uint32_t> first_of;  ///< per slot: first voxel of its block; kUnlabelled: not in the cloud

  /// Adds the slots by the keys of their blocks in z-y-x order.
  BlockCloud(const SurfaceBlocks& blocks, std::span<const std::uint32_t> slots)
      : first_of(blocks.slots(), kUnlabelled) {
    std::size_t voxels{0};
    for (const std::uint32_t slot : slots) voxels += blocks[slot].voxels.size();
    cloud.voxels.reserve(voxels);
    names.reserve(voxels);
    cell_of.reserve(voxels);
    for (const std::uint32_t slot : slots) {
      const SurfaceBlock& block = blocks[slot];
      first_of[slot] = static_cast<std::uint32_t>(names.size());
      std::array<std::uint32_t, 8> cell_numbers;
      cell_numbers.fill(kUnlabelled);
      block.mask.for_each([&](std::size_t i) { cell_numbers[seed_cell(i)] = 0; });
      for (std::uint32_t& number : cell_numbers) {
        if (number == 0) number = static_cast<std::uint32_t>(cells++);
      }
      block.mask.for_each([&](std::size_t i) {
        names.push_back(slot * kBrickVoxels + static_cast<VoxelName>(i));
        cell_of.push_back(cell_numbers[seed_cell(i)]);
      });
      cloud.voxels.insert(cloud.voxels.end(), block.voxels.begin(), block.voxels.end());
    }
    cloud.starts.reserve(names.size() + 1);
    cloud.ids.reserve(14 * names.size());
    cloud.starts.push_back(0);
    PaddedBlock near;
    PaddedBlock::Neighbours found;
    for (const std::uint32_t slot : slots) {
      near.load(blocks, slot, [&](std::uint32_t other, std::size_t position) {
        return first_of[other] == kUnlabelled ? PaddedBlock::kNothing
                                              : first_of[other] + static_cast<std::uint32_t>(position);
      });
      blocks[slot].mask.for_each([&](std::size_t i) {
        near.read_neighbours(i, found);
        cloud.ids.insert(cloud.ids.end(), found.begin(), found.end());
        cloud.starts.push_back(static_cast<std::uint32_t>(cloud.ids.size()));
      });
    }
  }
};

/// Returns the parts of supervoxels in a block.
std::vector<SurfaceBlock::SupervoxelPart> parts_of(const SurfaceBlock& block) {
  std::vector<SurfaceBlock::SupervoxelPart> parts;
  std::size_t last{0};
  for (std::size_t v = 0; v < block.voxels.size(); ++v) {
    const VoxelName name = block.labels[v];
    if (last >= parts.size() || parts[last].supervoxel != name) {
      last = 0;
      while (last < parts.size() && parts[last].supervoxel != name) ++last;
      if (last == parts.size()) parts.push_back({name, 0, 0, Eigen::Matrix<double, 9, 1>::Zero()});
    }
    SurfaceBlock::SupervoxelPart& part = parts[last];
    const CloudVoxel& voxel = block.voxels[v];
    part.voxels += 1;
    part.points += voxel.points;
    part.sum.head<3>() += voxel.position_m.cast<double>();
    part.sum.segment<3>(3) += voxel.normal.cast<double>();
    part.sum.tail<3>() += voxel.color.cast<double>();
  }
  return parts;
}

using NamePairs = std::vector<std::pair<VoxelName, VoxelName>>;

/// Finds the pairs of a label in the block and an adjacent one, sorted.
void find_touching(const SurfaceBlock& block, const PaddedBlock& near, NamePairs& touching) {
  touching.clear();
  PaddedBlock::Neighbours found;
  std::size_t position{0};
  block.mask.for_each([&](std::size_t i) {
    const VoxelName own = block.labels[position++];
    near.read_neighbours(i, found);
    VoxelName last{own};
    for (const VoxelName other : found) {
      if (other == last) continue;
      last = other;
      if (other != own) touching.emplace_back(own, other);
    }
  });
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
}

/// Returns the supervoxels with seeds in the block, from their parts in it and around it.
std::vector<SurfaceBlock::OwnedSupervoxel> own_of(const SurfaceBlocks& blocks, std::uint32_t slot) {
  std::vector<SurfaceBlock::SupervoxelPart> sums;
  for (const std::uint32_t other : blocks.around(slot)) {
    if (other == SurfaceBlocks::kNone) continue;
    for (const SurfaceBlock::SupervoxelPart& part : blocks[other].parts) {
      if (part.supervoxel / kBrickVoxels != slot) continue;
      const auto sum =
          std::find_if(sums.begin(), sums.end(), [&](const auto& s) { return s.supervoxel == part.supervoxel; });
      if (sum == sums.end()) {
        sums.push_back(part);
        continue;
      }
      sum->sum += part.sum;
      sum->voxels += part.voxels;
      sum->points += part.points;
    }
  }
  std::sort(sums.begin(), sums.end(), [](const auto& a, const auto& b) { return a.supervoxel < b.supervoxel; });
  std::vector<SurfaceBlock::OwnedSupervoxel> own;
  for (const SurfaceBlock::SupervoxelPart& sum : sums) {
    const Eigen::Matrix<double, 9, 1> mean = sum.sum / static_cast<double>(sum.voxels);
    const double length = mean.segment<3>(3).norm();
    own.push_back(
        {sum.supervoxel,
         {mean.head<3>().cast<float>(),
          length > 0.0 ? Eigen::Vector3f{(mean.segment<3>(3) / length).cast<float>()} : Eigen::Vector3f::UnitZ(),
          mean.tail<3>().cast<float>(), sum.voxels, sum.points}});
  }
  return own;
}

std::vector<SurfaceBlock::Edge> edges_of(const SurfaceBlocks& blocks, std::uint32_t slot) {
  std::vector<std::pair<VoxelName, VoxelName>> pairs;
  for (const std::uint32_t other : blocks.around(slot)) {
    if (other == SurfaceBlocks::kNone) continue;
    const auto& touching = blocks[other].touching;  // sorted, so those of one block lie together
    auto pair = std::lower_bound(touching.begin(), touching.end(), std::pair{slot * kBrickVoxels, VoxelName{0}});
    for (; pair != touching.end() && pair->first / kBrickVoxels == slot; ++pair) {
      if (blocks.before(pair->first, pair->second)) pairs.push_back(*pair);
    }
  }
  std::sort(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : blocks.before(a.second, b.second);
  });
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<SurfaceBlock::Edge> edges;
  std::uint32_t from{0};
  for (const auto& [name, other] : pairs) {
    while (blocks[slot].own[from].name != name) ++from;
    edges.push_back({from, other, false});
  }
  return edges;
}

const Supervoxel& supervoxel_of(const SurfaceBlocks& blocks, VoxelName name) {
  for (const SurfaceBlock::OwnedSupervoxel& own : blocks[name / kBrickVoxels].own) {
    if (own.name == name) return own.supervoxel;
  }
  SACCADE_EXPECTS(false);
  return blocks[name / kBrickVoxels].own.front().supervoxel;
}

}  // namespace

/// Labels these blocks of one tile, from the voxels up to two blocks away.
void LiveSegments::label_blocks(std::span<const std::uint32_t> slots) {
  Slots region = blocks_->with_rings(slots, 2);
  std::sort(region.begin(), region.end(),
            [&](std::uint32_t a, std::uint32_t b) { return blocks_->block_before(a, b); });
  const BlockCloud part{*blocks_, region};
  SupervoxelConfig growing = supervoxel_config_;
  growing.moves_in_growth = false;  // means would carry effects farther than the rings
  SupervoxelGrowth growth{part.cloud, growing};
  growth.seed(part.cell_of, part.cells, kSeedRadius_vox * supervoxel_config_.voxels.voxel_size_m,
              supervoxel_config_.fewest_around_seed(2.0 * kSeedRadius_vox), Executor{});
  // Effects of a seed on blocks beyond the first ring do not come back here within its reach.
  std::vector<std::uint8_t> outside(part.names.size(), 1);
  for (const std::uint32_t slot : blocks_->with_rings(slots, 1)) {
    std::fill_n(outside.begin() + part.first_of[slot], (*blocks_)[slot].voxels.size(), std::uint8_t{0});
  }
  const SupervoxelGrowth::Grown grown = growth.grow(kReach_vox, outside);
  for (const std::uint32_t slot : slots) {
    std::array<VoxelName, 8> rest;  // per cell: first voxel that no seed reached
    rest.fill(kNoSupervoxel);
    std::vector<VoxelName>& labels = (*blocks_)[slot].labels;
    labels.clear();
    const std::uint32_t first = part.first_of[slot];
    for (std::uint32_t v = first; v < first + (*blocks_)[slot].voxels.size(); ++v) {
      if (grown.labels[v] != kUnlabelled) {
        labels.push_back(part.names[grown.seeds[grown.labels[v]]]);
        continue;
      }
      VoxelName& name = rest[seed_cell(part.names[v] % kBrickVoxels)];
      if (name == kNoSupervoxel) name = part.names[v];
      labels.push_back(name);
    }
  }
}

/// @return the blocks with changed labels.
LiveSegments::Slots LiveSegments::renew_labels(const Slots& slots, const Executor& executor) {
  Slots by_tile = slots;
  std::sort(by_tile.begin(), by_tile.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Index3 tile_a = tile_of((*blocks_)[a].key);
    const Index3 tile_b = tile_of((*blocks_)[b].key);
    return tile_a == tile_b ? a < b : zyx_less(tile_a, tile_b);
  });
  std::vector<std::vector<VoxelName>> before;
  std::vector<std::size_t> tiles;  // first slot of each tile, then the end
  for (std::size_t i = 0; i < by_tile.size(); ++i) {
    before.push_back(std::move((*blocks_)[by_tile[i]].labels));
    if (i == 0 || !(tile_of((*blocks_)[by_tile[i]].key) == tile_of((*blocks_)[by_tile[i - 1]].key))) tiles.push_back(i);
  }
  tiles.push_back(by_tile.size());
  executor.parallel_for(tiles.size() - 1, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t tile = begin; tile < end; ++tile) {
      label_blocks(std::span{by_tile}.subspan(tiles[tile], tiles[tile + 1] - tiles[tile]));
    }
  });
  Slots changed;
  for (std::size_t i = 0; i < by_tile.size(); ++i) {
    if ((*blocks_)[by_tile[i]].labels != before[i]) changed.push_back(by_tile[i]);
  }
  return changed;
}

void LiveSegments::renew_parts(const Slots& slots, const Executor& executor) {
  executor.parallel_for(slots.size(), kLabelledGrain, [&](std::size_t begin, std::size_t end) {
    PaddedBlock near;
    NamePairs touching;
    for (std::size_t i = begin; i < end; ++i) {
      SurfaceBlock& block = (*blocks_)[slots[i]];
      block.parts = parts_of(block);
      near.load(*blocks_, slots[i],
                [&](std::uint32_t other, std::size_t position) { return (*blocks_)[other].labels[position]; });
      find_touching(block, near, touching);
      block.touching.assign(touching.begin(), touching.end());
    }
  });
}

/// Renews the supervoxels with seeds in these blocks, and their edges, including those from other blocks.
void LiveSegments::renew_own(const Slots& slots, const Executor& executor) {
  executor.parallel_for(slots.size(), kLabelledGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) (*blocks_)[slots[i]].own = own_of(*blocks_, slots[i]);
  });
  executor.parallel_for(slots.size(), kLabelledGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) (*blocks_)[slots[i]].edges = edges_of(*blocks_, slots[i]);
  });
  std::vector<bool> renewed(blocks_->slots());
  for (const std::uint32_t slot : slots) renewed[slot] = true;
  const Slots all = blocks_->with_rings(slots, 3);  // touching supervoxels have seeds up to 17 voxels apart
  executor.parallel_for(all.size(), kLabelledGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      SurfaceBlock& block = (*blocks_)[all[i]];
      for (SurfaceBlock::Edge& edge : block.edges) {
        if (!renewed[all[i]] && !renewed[edge.to / kBrickVoxels]) continue;
        edge.convex = is_convex(block.own[edge.from].supervoxel, supervoxel_of(*blocks_, edge.to), config_.lccp,
                                supervoxel_config_.voxels.voxel_size_m);
      }
    }
  });
}

}  // namespace saccade
