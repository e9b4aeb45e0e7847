// SPDX-License-Identifier: Apache-2.0
// Answers in the form of clouds, meshes and grids of voxels.

#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include "map_answers.hpp"
#include "plain_types.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/map/voxel_block.hpp"

namespace saccade::ros1 {
namespace {

constexpr std::size_t kMostPoints{std::size_t{1} << 27};
const std::vector<std::string> kPointNormal{"x", "y", "z", "normal_x", "normal_y", "normal_z", "curvature"};

Error too_many() {
  return {Errc::invalid_argument, "more than 134 million points; ask for a bounding box, or subsample", {}};
}

void append(PlainCloud& cloud, std::initializer_list<float> values) { cloud.values.insert(cloud.values.end(), values); }
void append_normal(PlainCloud& cloud, const Eigen::Vector3f& p, const Eigen::Vector3f& n) {
  append(cloud, {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), 0.0F});
}

/// Replaces the points of each cell by their mean; normals get unit length again. Sorted by first point.
void subsample(PlainCloud& cloud, double cell_m) {
  const std::size_t step = cloud.fields.size();
  const bool normals = step >= 6 && cloud.fields[3] == "normal_x";
  std::unordered_map<Index3, std::size_t, Index3Hash> cells;
  std::vector<double> sums;
  std::vector<std::size_t> counts;
  for (std::size_t i = 0; i + step <= cloud.values.size(); i += step) {
    const float* p = &cloud.values[i];
    const auto [at, fresh] = cells.try_emplace(voxel_at({p[0], p[1], p[2]}, cell_m), counts.size());
    if (fresh) {
      counts.push_back(0);
      sums.resize(sums.size() + step);
    }
    ++counts[at->second];
    for (std::size_t k = 0; k < step; ++k) sums[at->second * step + k] += p[k];
  }
  cloud.values.resize(sums.size());
  for (std::size_t c = 0; c < counts.size(); ++c) {
    for (std::size_t k = 0; k < step; ++k)
      cloud.values[c * step + k] = static_cast<float>(sums[c * step + k] / static_cast<double>(counts[c]));
    if (normals) {
      Eigen::Map<Eigen::Vector3f> n{&cloud.values[c * step + 3]};
      if (n.norm() > 0.0F) n.normalize();
    }
  }
}

void finish(PlainCloud& cloud) {
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(cloud.values.size() / cloud.fields.size());
}

/// Calls visit(brick, its handle) for the bricks with known voxels that the filter may contain, in z-y-x order of
/// sectors.
template <class Visit>
Status for_each_brick(const Source& source, const Filter& filter, const Visit& visit) {
  const IndexBox voxels = filter.voxels(source.map.grid.known_bounds(), source.map.config.voxel_size_m);
  if (voxels.empty()) return {};
  const IndexBox bricks = parents(voxels);
  for (const Index3& key : source.map.grid.sorted_sectors()) {
    SACCADE_CHECK(source.go_on());
    if (!parents(bricks).contains(key)) continue;
    const Sector* sector = source.map.grid.find(key);
    for (int i = 0; i < kSectorBricks; ++i) {
      const Index3 brick = key * kSectorEdge + child_offset(i);
      const BrickRef& ref = sector->bricks[static_cast<std::size_t>(i)];
      if (!ref.is_unknown() && bricks.contains(brick)) SACCADE_CHECK(visit(brick, ref));
    }
  }
  return {};
}

Eigen::Vector3d center(const Source& source, const Index3& brick, int i) {
  return voxel_center(brick * kBrickEdge + child_offset(i), source.map.config.voxel_size_m);
}

/// Returns the edges that belong to only one triangle, where the mesh ends.
std::vector<std::uint8_t> at_border(const TriangleMesh& mesh) {
  std::unordered_map<std::uint64_t, int> edges;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [lo, hi] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
      ++edges[(std::uint64_t{lo} << 32) | hi];
    }
  }
  std::vector<std::uint8_t> border(mesh.vertices.size());
  for (const auto& [edge, triangles] : edges) {
    if (triangles == 1) border[edge >> 32] = border[edge & 0xFFFFFFFF] = 1;
  }
  return border;
}

constexpr std::array<Index3, 6> kNeighbours{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

Eigen::Vector3f direction(const Index3& step) { return {float(step.x), float(step.y), float(step.z)}; }

/// Returns the normal of a frontier voxel, towards unknown space; nullopt for other voxels. Zero where unknown space is
/// on all sides.
std::optional<Eigen::Vector3f> frontier_normal(const VoxelBlock& block, const Index3& i) {
  if (!block.known(i) || block.v(i) <= 0) return std::nullopt;
  bool found{false};
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const Index3& step : kNeighbours) {
    if (block.known(i + step)) continue;
    found = true;
    sum += direction(step);
  }
  if (!found) return std::nullopt;
  return sum.norm() > 0.0F ? Eigen::Vector3f{sum.normalized()} : sum;
}

/// Returns the normal of an occupied voxel beside an empty one, towards empty space.
std::optional<Eigen::Vector3f> surface_normal(const VoxelBlock& block, const Index3& i) {
  if (!block.known(i) || block.v(i) > 0) return std::nullopt;
  const bool found = std::any_of(kNeighbours.begin(), kNeighbours.end(),
                                 [&](const Index3& step) { return block.known(i + step) && block.v(i + step) > 0; });
  if (!found) return std::nullopt;
  const std::optional<Eigen::Vector3d> gradient = block.gradient(i);
  return gradient && gradient->norm() > 0.0 ? Eigen::Vector3f{gradient->normalized().cast<float>()}
                                            : Eigen::Vector3f::Zero();
}

Status add_border_points(const Source& source, const Filter& filter, PlainCloud& cloud) {
  const TriangleMesh mesh = extract_mesh(source.map, source.executor);
  SACCADE_CHECK(source.go_on());
  const std::vector<std::uint8_t> border = at_border(mesh);
  for (std::size_t i = 0; i < border.size(); ++i) {
    if (border[i] != 0 && filter(mesh.vertices[i].cast<double>()))
      append_normal(cloud, mesh.vertices[i], mesh.normals[i]);
  }
  return {};
}

}  // namespace

Filter::Filter(const MapRequest& request) {
  if (request.box) box = to_box(*request.box);
  if (request.sphere) sphere = to_sphere(*request.sphere);
}

IndexBox Filter::voxels(const IndexBox& within, double voxel_size_m) const {
  IndexBox voxels = within;
  if (box) voxels = voxels.intersection(voxels_with_center_in(*box, voxel_size_m));
  if (sphere) voxels = voxels.intersection(voxels_with_center_in(bounds(*sphere), voxel_size_m));
  return voxels;
}

Result<MapAnswer> tsdf_answer(const Source& source, const MapRequest& request) {
  const Filter filter{request};
  MapAnswer answer;
  answer.cloud.fields = {"x", "y", "z", "intensity"};
  SACCADE_CHECK(for_each_brick(source, filter, [&](const Index3& brick, const BrickRef& ref) -> Status {
    const DenseBrick* dense = ref.dense();
    if (dense == nullptr) return {};
    for (int i = 0; i < kBrickVoxels; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (dense->w[at] == 0 || dense->v[at] == kTsdfOne) continue;
      const Eigen::Vector3d p = center(source, brick, i);
      if (filter(p))
        append(answer.cloud, {float(p.x()), float(p.y()), float(p.z()), float(dense->v[at]) / float{kTsdfOne}});
    }
    return answer.cloud.values.size() > 4 * kMostPoints ? Status{too_many()} : Status{};
  }));
  finish(answer.cloud);
  return answer;
}

Result<MapAnswer> mesh_answer(const Source& source, const MapRequest& request) {
  const Filter filter{request};
  const Eigen::Affine3f T =
      request.transformation ? to_affine(*request.transformation).cast<float>() : Eigen::Affine3f::Identity();
  const TriangleMesh mesh = extract_mesh(source.map, source.executor);
  SACCADE_CHECK(source.go_on());
  MapAnswer answer;
  answer.cloud.fields = kPointNormal;
  constexpr std::uint32_t kLeftOut{std::numeric_limits<std::uint32_t>::max()};
  std::vector<std::uint32_t> number(mesh.vertices.size(), kLeftOut);
  std::uint32_t count{0};
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f p = T * mesh.vertices[i];
    if (!filter(p.cast<double>())) continue;
    Eigen::Vector3f n = T.linear() * mesh.normals[i];
    if (n.norm() > 0.0F) n.normalize();
    number[i] = count++;
    append_normal(answer.cloud, p, n);
  }
  if (request.question == Question::mesh) {
    for (const auto& [a, b, c] : mesh.triangles) {
      if (number[a] != kLeftOut && number[b] != kLeftOut && number[c] != kLeftOut)
        answer.triangles.push_back({number[a], number[b], number[c]});
    }
  } else if (request.subsample_m) {
    subsample(answer.cloud, *request.subsample_m);
  }
  finish(answer.cloud);
  return answer;
}

Result<MapAnswer> known_answer(const Source& source, const MapRequest& request) {
  const Filter filter{request};
  const Eigen::Affine3d T = request.transformation ? to_affine(*request.transformation) : Eigen::Affine3d::Identity();
  MapAnswer answer;
  answer.cloud.fields = {"x", "y", "z"};
  const bool moved = request.transformation.has_value();  // the filter applies to the transformed points
  MapRequest everywhere;
  SACCADE_CHECK(for_each_brick(source, moved ? Filter{everywhere} : filter,
                               [&](const Index3& brick, const BrickRef& ref) -> Status {
                                 (~ref.unknown_mask()).for_each([&](std::size_t i) {
                                   const Eigen::Vector3d p = T * center(source, brick, static_cast<int>(i));
                                   if (filter(p)) append(answer.cloud, {float(p.x()), float(p.y()), float(p.z())});
                                 });
                                 return answer.cloud.values.size() > 3 * kMostPoints ? Status{too_many()} : Status{};
                               }));
  if (request.subsample_m) subsample(answer.cloud, *request.subsample_m);
  finish(answer.cloud);
  return answer;
}

Result<MapAnswer> voxelgrid_answer(const Source& source, const MapRequest& request) {
  if (!request.box) return Error{Errc::invalid_argument, "a grid of voxels needs a bounding box", {}};
  const double voxel_m = source.map.config.voxel_size_m;
  const double cell_m = std::max(voxel_m, request.subsample_m.value_or(0.0));
  const Box box = to_box(*request.box);
  SACCADE_CHECK(validate(Region{box}));
  const Eigen::Vector3d counts = ((box.max - box.min) / cell_m + Eigen::Vector3d::Constant(0.5)).array().floor();
  if (counts.minCoeff() < 1.0 || counts.prod() > 2.5e8) {
    return Error{
        Errc::invalid_argument, "the bounding box has no cells along an axis, or more than 250 million in all", {}};
  }
  const auto [nx, ny, nz] = std::array{static_cast<std::uint32_t>(counts.x()), static_cast<std::uint32_t>(counts.y()),
                                       static_cast<std::uint32_t>(counts.z())};
  MapAnswer answer;
  answer.dimensions = {{"x", nx, 1}, {"y", ny, nx}, {"z", nz, nx * ny}};
  answer.floats.resize(std::size_t{nx} * ny * nz);
  const SectorTable table{source.map.grid};
  const auto state_at = [&](const Index3& voxel) {
    const Index3 brick = parent(voxel);
    const Sector* sector = table.find(parent(brick));
    return sector == nullptr
               ? VoxelState::unknown
               : state_of(sector->bricks[static_cast<std::size_t>(child_index(brick))].voxel(child_index(voxel)));
  };
  const auto state_in = [&](const Eigen::Vector3d& min) {
    if (cell_m == voxel_m) return state_at(voxel_at(min + Eigen::Vector3d::Constant(0.5 * cell_m), voxel_m));
    VoxelState state = VoxelState::empty;
    voxels_with_center_in({min, min + Eigen::Vector3d::Constant(cell_m)}, voxel_m).for_each([&](const Index3& voxel) {
      const VoxelState here = state_at(voxel);
      if (here == VoxelState::occupied || (here == VoxelState::unknown && state == VoxelState::empty)) state = here;
    });
    return state;
  };
  source.executor.parallel_for(std::size_t{ny} * nz, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end && !source.cancelled; ++row) {
      for (std::uint32_t x = 0; x < nx; ++x) {
        const Eigen::Vector3d min = box.min + cell_m * Eigen::Vector3d{double(x), double(row % ny), double(row / ny)};
        const VoxelState state = state_in(min);
        answer.floats[row * nx + x] = state == VoxelState::unknown    ? 0.0F
                                      : state == VoxelState::occupied ? 1.0F
                                                                      : -1.0F;
      }
    }
  });
  SACCADE_CHECK(source.go_on());
  return answer;
}

Result<MapAnswer> points_answer(const Source& source, const MapRequest& request) {
  const Filter filter{request};
  MapAnswer answer;
  answer.cloud.fields = kPointNormal;
  if (request.question == Question::border_points) {
    SACCADE_CHECK(add_border_points(source, filter, answer.cloud));
  } else {
    const auto normal_of = request.question == Question::frontier_points ? frontier_normal : surface_normal;
    const SectorTable table{source.map.grid};
    VoxelBlock block;
    SACCADE_CHECK(for_each_brick(source, filter, [&](const Index3& brick, const BrickRef& ref) -> Status {
      if (request.question == Question::surface_points && ref.occupied_mask().none()) return {};
      block.load(table, brick, 1);
      for (int i = 0; i < kBrickVoxels; ++i) {
        const std::optional<Eigen::Vector3f> normal = normal_of(block, child_offset(i));
        if (!normal) continue;
        const Eigen::Vector3d p = center(source, brick, i);
        if (filter(p)) append_normal(answer.cloud, p.cast<float>(), *normal);
      }
      return answer.cloud.values.size() > 7 * kMostPoints ? Status{too_many()} : Status{};
    }));
  }
  if (request.transformation) {
    const Eigen::Affine3f T = to_affine(*request.transformation).inverse().cast<float>();
    for (std::size_t i = 0; i < answer.cloud.values.size(); i += kPointNormal.size()) {
      Eigen::Map<Eigen::Vector3f> p{&answer.cloud.values[i]};
      Eigen::Map<Eigen::Vector3f> n{&answer.cloud.values[i + 3]};
      p = (T * p).eval();
      n = (T.linear() * n).eval();
      if (n.norm() > 0.0F) n.normalize();
    }
  }
  finish(answer.cloud);
  return answer;
}

}  // namespace saccade::ros1
