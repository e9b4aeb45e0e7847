// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/maps/ternary_export.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/little_endian.hpp"
#include "saccade/io/files/npy_io.hpp"
#include "saccade/map/voxel_row.hpp"
#include "saccade/map/voxels_inside.hpp"

namespace saccade {
namespace {

constexpr Rgb8 kGrey{180, 180, 180};
constexpr Rgb8 kBlack{0, 0, 0};
constexpr std::array<Index3, 6> kFaces{{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
constexpr IndexBox kEverything{{-(1 << 29), -(1 << 29), -(1 << 29)}, {1 << 29, 1 << 29, 1 << 29}};

Error bad_box(const std::string& what) { return {Errc::invalid_argument, what, "export of the ternary map"}; }

/// Returns the voxels with their centre in the box; an error where their coordinates would overflow.
Result<IndexBox> voxels_of(const Box& box, double voxel_size_m) {
  SACCADE_CHECK(validate(Region{box}));
  const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  if (largest / voxel_size_m >= kEverything.hi.x) return bad_box("the box reaches too far from the origin");
  return voxels_with_center_in(box, voxel_size_m);
}

/// Returns the brick's bits moved one voxel along `face`, with the neighbour's bits that touch it.
Mask512 moved(const Mask512& own, const Mask512& neighbour, int face) {
  constexpr std::uint64_t kFirstColumn{0x0101010101010101ULL};
  constexpr std::uint64_t kLastColumn{kFirstColumn << 7};
  Mask512 out;
  for (std::size_t z = 0; z < 8; ++z) {
    const std::uint64_t here = own.words[z];
    const std::uint64_t there = neighbour.words[z];
    switch (face) {
      case 0: out.words[z] = ((here & ~kLastColumn) << 1) | ((there & kLastColumn) >> 7); break;
      case 1: out.words[z] = ((here & ~kFirstColumn) >> 1) | ((there & kFirstColumn) << 7); break;
      case 2: out.words[z] = (here << 8) | (there >> 56); break;
      case 3: out.words[z] = (here >> 8) | (there << 56); break;
      case 4: out.words[z] = z == 0 ? neighbour.words[7] : own.words[z - 1]; break;
      default: out.words[z] = z == 7 ? neighbour.words[0] : own.words[z + 1]; break;
    }
  }
  return out;
}

class PointExport {
 public:
  PointExport(const TsdfSnapshot& map, const TernaryPointsConfig& config, const IndexBox& box)
      : map_{map}, config_{config}, box_{box}, frontier_box_{box} {
    if (const auto& workspace = map.config.workspace) {
      frontier_box_ = box.intersection(voxels_with_center_in(*workspace, map.config.voxel_size_m));
    }
    sectors_ = map.grid.sorted_sectors();
    if (!config.frontier) return;
    // Unknown voxels outside every stored sector can be frontier too.
    for (std::size_t i = 0, count = sectors_.size(); i < count; ++i) {
      for (const Index3& face : kFaces) {
        if (map.grid.find(sectors_[i] + face) == nullptr) sectors_.push_back(sectors_[i] + face);
      }
    }
    std::sort(sectors_.begin(), sectors_.end(), zyx_less);
    sectors_.erase(std::unique(sectors_.begin(), sectors_.end()), sectors_.end());
  }

  /// Calls body(brick origin, brick, occupied voxels, frontier voxels) wherever there are any, sector by sector.
  template <class Body>
  Status for_each_brick(const Body& body) const {
    for (const Index3& key : sectors_) {
      for (int child = 0; child < kSectorBricks; ++child) {
        const Index3 brick = key * kSectorEdge + child_offset(child);
        const BrickRef& ref = find(brick);
        const Index3 lo = brick * kBrickEdge;
        Mask512 occupied;
        if (config_.occupied && ref.dense() != nullptr) occupied = ref.dense()->occupied & voxels_inside(box_, lo);
        const Mask512 frontier = config_.frontier ? frontier_of(brick, ref) : Mask512{};
        if (occupied.any() || frontier.any()) SACCADE_CHECK(body(lo, ref, occupied, frontier));
      }
    }
    return {};
  }

 private:
  const BrickRef& find(const Index3& brick) const {
    static const BrickRef unknown;
    const Sector* sector = map_.grid.find(parent(brick));
    return sector == nullptr ? unknown : sector->bricks[static_cast<std::size_t>(child_index(brick))];
  }

  static Mask512 empty_mask(const BrickRef& ref) {
    return ref.is_unknown() ? Mask512{} : ~(ref.unknown_mask() | ref.occupied_mask());
  }

  Mask512 frontier_of(const Index3& brick, const BrickRef& ref) const {
    const Mask512 candidates = ref.unknown_mask() & voxels_inside(frontier_box_, brick * kBrickEdge);
    if (candidates.none()) return {};
    const Mask512 own = empty_mask(ref);
    Mask512 next_to_empty;
    for (int face = 0; face < 6; ++face) {
      const Mask512 neighbour = empty_mask(find(brick + kFaces[static_cast<std::size_t>(face)]));
      next_to_empty = next_to_empty | moved(own, neighbour, face);
    }
    return candidates & next_to_empty;
  }

  const TsdfSnapshot& map_;
  TernaryPointsConfig config_;
  IndexBox box_;
  IndexBox frontier_box_;
  std::vector<Index3> sectors_;
};

std::string ply_header(std::size_t count, double voxel_size_m) {
  std::array<char, 64> size{};
  std::snprintf(size.data(), size.size(), "%.9g", voxel_size_m);
  return "ply\nformat binary_little_endian 1.0\ncomment voxel centres; voxel_size_m " + std::string{size.data()} +
         "\ncomment state: 0 unknown (next to empty), 1 empty, 2 occupied\nelement vertex " + std::to_string(count) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
         "property uchar blue\nproperty uchar state\nend_header\n";
}

void append_point(std::vector<std::byte>& out, const Eigen::Vector3d& p_world, const Rgb8& color, VoxelState state) {
  const std::array<float, 3> p{static_cast<float>(p_world.x()), static_cast<float>(p_world.y()),
                               static_cast<float>(p_world.z())};
  append_value(out, p);
  append_value(out, color);
  append_value(out, state);
}

Rgb8 color_of(const BrickRef& ref, int voxel) {
  const DenseBrick* dense = ref.dense();
  if (dense == nullptr || dense->colors == nullptr) return kGrey;
  const Rgb8& color = (*dense->colors)[static_cast<std::size_t>(voxel)];
  return color == Rgb8{} ? kGrey : color;
}

std::array<std::uint64_t, 3> shape_of(const IndexBox& box) {
  const auto edge = [](std::int32_t lo, std::int32_t hi) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(hi) - lo);
  };
  return {edge(box.lo.z, box.hi.z), edge(box.lo.y, box.hi.y), edge(box.lo.x, box.hi.x)};
}

Result<IndexBox> volume_box(const TsdfSnapshot& map, const TernaryVolumeConfig& config) {
  IndexBox box = map.grid.known_bounds();
  if (config.box) {
    SACCADE_TRY(box, voxels_of(*config.box, map.config.voxel_size_m));
  }
  if (box.empty())
    return bad_box(config.box ? "the box holds no voxel; make it larger, or the voxels smaller" : "the map is empty");
  const auto [z, y, x] = shape_of(box);
  const double bytes = static_cast<double>(x) * static_cast<double>(y) * static_cast<double>(z);
  if (bytes > static_cast<double>(config.max_bytes)) {
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  "the volume has %llu x %llu x %llu voxels (%.1f GiB), more than the limit of %.1f GiB; export a "
                  "smaller box or raise the limit",
                  static_cast<unsigned long long>(x), static_cast<unsigned long long>(y),
                  static_cast<unsigned long long>(z), bytes / (1U << 30U),
                  static_cast<double>(config.max_bytes) / (1U << 30U));
    return bad_box(text.data());
  }
  return box;
}

nlohmann::ordered_json sidecar(const IndexBox& box, double voxel_size_m, const std::filesystem::path& volume) {
  const auto [z, y, x] = shape_of(box);
  const Eigen::Vector3d origin = voxel_center(box.lo, voxel_size_m);
  return {{"schema", "saccade-ternary-volume-1"},
          {"file", volume.filename().string()},
          {"shape", {z, y, x}},
          {"axes", "zyx"},
          {"voxel_size_m", voxel_size_m},
          {"origin_m", {origin.x(), origin.y(), origin.z()}},
          {"first_voxel", {box.lo.x, box.lo.y, box.lo.z}},
          {"values", {{"unknown", 0}, {"empty", 1}, {"occupied", 2}}}};
}

}  // namespace

static_assert(static_cast<int>(VoxelState::unknown) == 0 && static_cast<int>(VoxelState::empty) == 1 &&
              static_cast<int>(VoxelState::occupied) == 2);

Result<TernaryPoints> write_ternary_points(const TsdfSnapshot& map, const std::filesystem::path& path,
                                           const TernaryPointsConfig& config) {
  IndexBox box = kEverything;
  if (config.box) {
    SACCADE_TRY(box, voxels_of(*config.box, map.config.voxel_size_m));
  }
  const PointExport points{map, config, box};
  TernaryPoints counts;
  SACCADE_CHECK(
      points.for_each_brick([&](const Index3&, const BrickRef&, const Mask512& occupied, const Mask512& frontier) {
        counts.occupied += static_cast<std::size_t>(occupied.count());
        counts.frontier += static_cast<std::size_t>(frontier.count());
        return Status{};
      }));
  const double size = map.config.voxel_size_m;
  SACCADE_TRY(AtomicFile file, AtomicFile::create(path));
  SACCADE_CHECK(file.write(ply_header(counts.occupied + counts.frontier, size)));
  std::vector<std::byte> rows;
  SACCADE_CHECK(points.for_each_brick(
      [&](const Index3& lo, const BrickRef& ref, const Mask512& occupied, const Mask512& frontier) {
        rows.clear();
        for (int i = 0; i < kBrickVoxels; ++i) {
          const Eigen::Vector3d p_world = voxel_center(lo + child_offset(i), size);
          if (occupied.test(i)) append_point(rows, p_world, color_of(ref, i), VoxelState::occupied);
          if (frontier.test(i)) append_point(rows, p_world, kBlack, VoxelState::unknown);
        }
        return file.write(rows);
      }));
  SACCADE_CHECK(file.commit());
  return counts;
}

std::vector<Eigen::Vector3f> frontier_voxels(const TsdfSnapshot& map, std::size_t most) {
  TernaryPointsConfig config;
  config.occupied = false;
  const PointExport points{map, config, kEverything};
  std::vector<Eigen::Vector3f> centers;
  const Status within =
      points.for_each_brick([&](const Index3& lo, const BrickRef&, const Mask512&, const Mask512& frontier) -> Status {
        if (centers.size() + static_cast<std::size_t>(frontier.count()) > most) return bad_box("too many voxels");
        for (int i = 0; i < kBrickVoxels; ++i) {
          if (!frontier.test(i)) continue;
          centers.emplace_back(voxel_center(lo + child_offset(i), map.config.voxel_size_m).cast<float>());
        }
        return {};
      });
  return within ? centers : std::vector<Eigen::Vector3f>{};
}

Result<IndexBox> write_ternary_volume(const TsdfSnapshot& map, const std::filesystem::path& path,
                                      const TernaryVolumeConfig& config) {
  SACCADE_TRY(const IndexBox box, volume_box(map, config));
  std::filesystem::path json = path;
  json.replace_extension(".json");
  if (json == path) return bad_box("the volume needs a name that does not end in .json, for example ternary.npy");
  SACCADE_TRY(AtomicFile file, AtomicFile::create(path));
  SACCADE_CHECK(file.write(npy_header("|u1", shape_of(box))));
  const auto [depth, height, width] = shape_of(box);
  std::vector<std::uint8_t> slice(static_cast<std::size_t>(height * width));
  for (std::int32_t z = box.lo.z; z < box.hi.z; ++z) {
    for (std::int32_t y = box.lo.y; y < box.hi.y; ++y) {
      std::uint8_t* state = slice.data() + static_cast<std::size_t>(y - box.lo.y) * width;
      for_each_in_row(map.grid, {box.lo.x, y, z}, box.hi.x,
                      [&](const Voxel& voxel) { *state++ = static_cast<std::uint8_t>(state_of(voxel)); });
    }
    SACCADE_CHECK(file.write(std::as_bytes(std::span{slice})));
  }
  SACCADE_CHECK(write_file_atomically(json, sidecar(box, map.config.voxel_size_m, path).dump(2) + "\n"));
  SACCADE_CHECK(file.commit());
  return box;
}

}  // namespace saccade
