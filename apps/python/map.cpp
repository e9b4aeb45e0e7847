// SPDX-License-Identifier: Apache-2.0
#include "map.hpp"

#include <algorithm>
#include <limits>

#include "saccade/io/maps/sacmap.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/map/voxel_row.hpp"

namespace saccade::python {
namespace {

SharedMap make_map(double voxel_size_m, const py::object& workspace, double truncation_vox, int free_weight,
                   int clearing_percent, bool color, std::size_t threads) {
  TsdfConfig config;
  config.voxel_size_m = voxel_size_m;
  config.truncation_vox = truncation_vox;
  config.free_weight = static_cast<std::uint16_t>(std::clamp(free_weight, 0, 0xffff));
  if (clearing_percent < 1 || clearing_percent > 100) throw py::value_error{"clearing_percent must be 1 to 100"};
  config.clearing_percent = static_cast<std::uint8_t>(clearing_percent);
  config.color = color;
  if (!workspace.is_none()) config.workspace = to_box(workspace);
  return {take(TsdfMap::create(config)), threads};
}

py::dict integrate(SharedMap& map, const PinholeCamera& camera, const py::array& depth, const py::array& T_world_camera,
                   const std::optional<py::array>& color) {
  const DepthImage image = to_depth(depth);
  const Pose pose = to_pose(T_world_camera);
  std::optional<ColorImage> colors;
  if (color) colors = to_color(*color);
  const FusionStats stats = take(map.write([&](TsdfMap& content) {
    return content.integrate(camera, image, pose, map.executor(), colors ? &*colors : nullptr);
  }));
  py::dict result;
  result["valid_pixels"] = stats.valid_pixels;
  result["bricks_updated"] = stats.bricks_updated;
  result["ms"] = stats.ms;
  return result;
}

void expect_countable(const IndexBox& voxels) {
  const auto edge = [](std::int32_t low, std::int32_t high) { return std::max(0.0, static_cast<double>(high) - low); };
  if (edge(voxels.lo.x, voxels.hi.x) * edge(voxels.lo.y, voxels.hi.y) * edge(voxels.lo.z, voxels.hi.z) > 4e9) {
    throw py::value_error{"the volume has more than 4 billion voxels; name a smaller box"};
  }
}

/// Returns the voxels of a volume: those of a box, of the workspace, or all known ones.
IndexBox volume_of(const TsdfSnapshot& map, const py::object& box) {
  IndexBox voxels = map.grid.known_bounds();
  std::optional<Box> bounds = map.config.workspace;
  if (!box.is_none()) bounds = to_box(box);
  if (bounds) {
    take(validate(Region{*bounds}));
    voxels = voxels_with_center_in(*bounds, map.config.voxel_size_m);
  }
  if (voxels.empty()) throw py::value_error{bounds ? "the box holds no voxel" : "the map is empty; name a box"};
  expect_countable(voxels);
  return voxels;
}

/// Returns an array (z, y, x) of `value` for each voxel.
template <class T, class Value>
py::array_t<T> volume(const SharedMap& map, const py::object& box, const Value& value) {
  const TsdfSnapshot snapshot = map.snapshot();
  const IndexBox voxels = volume_of(snapshot, box);
  const Index3 size = voxels.hi - voxels.lo;
  std::vector<T> values(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                        static_cast<std::size_t>(size.z));
  {
    const py::gil_scoped_release released;
    const auto rows = static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
    map.executor().parallel_for(rows, 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        const auto y = static_cast<std::int32_t>(row % static_cast<std::size_t>(size.y));
        const auto z = static_cast<std::int32_t>(row / static_cast<std::size_t>(size.y));
        T* out = values.data() + row * static_cast<std::size_t>(size.x);
        for_each_in_row(snapshot.grid, voxels.lo + Index3{0, y, z}, voxels.hi.x,
                        [&](const Voxel& voxel) { *out++ = value(voxel); });
      }
    });
  }
  return adopt(std::move(values), {size.z, size.y, size.x});
}

std::int8_t ternary_of(const Voxel& voxel) {
  switch (state_of(voxel)) {
    case VoxelState::empty: return -1;
    case VoxelState::occupied: return 1;
    case VoxelState::unknown: break;
  }
  return 0;
}

template <class Element, std::size_t kSize>
std::vector<Element> flat(const auto& rows) {
  std::vector<Element> values;
  values.reserve(rows.size() * kSize);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < kSize; ++i) values.push_back(row[static_cast<int>(i)]);
  }
  return values;
}

py::dict mesh(const SharedMap& map, int min_weight) {
  constexpr int kMostWeight{std::numeric_limits<std::uint16_t>::max()};
  if (min_weight < 0 || min_weight > kMostWeight) {
    throw py::value_error{"min_weight must be 0 to " + std::to_string(kMostWeight)};
  }
  const TsdfSnapshot snapshot = map.snapshot();
  TriangleMesh extracted;
  {
    const py::gil_scoped_release released;
    extracted = extract_mesh(snapshot, map.executor(), {static_cast<std::uint16_t>(min_weight)});
  }
  const auto vertices = static_cast<py::ssize_t>(extracted.vertices.size());
  const auto triangles = static_cast<py::ssize_t>(extracted.triangles.size());
  py::dict result;
  result["vertices"] = adopt(flat<float, 3>(extracted.vertices), {vertices, 3});
  result["normals"] = adopt(flat<float, 3>(extracted.normals), {static_cast<py::ssize_t>(extracted.normals.size()), 3});
  std::vector<std::uint8_t> colors;
  for (const Rgb8& color : extracted.colors) colors.insert(colors.end(), color.begin(), color.end());
  result["colors"] = adopt(std::move(colors), {static_cast<py::ssize_t>(extracted.colors.size()), 3});
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : extracted.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  result["triangles"] = adopt(std::move(corners), {triangles, 3});
  return result;
}

void save(const SharedMap& map, const std::string& path) {
  const TsdfSnapshot snapshot = map.snapshot();
  Status status;
  {
    const py::gil_scoped_release released;
    status = save_map(snapshot, path, map.executor());
  }
  take(status);
}

SharedMap load(const std::string& path, std::size_t threads) {
  return {TsdfMap{take(load_map(path, Executor::with_threads(threads)))}, threads};
}

}  // namespace

void bind_map(py::module_& module) {
  py::class_<SharedMap>(module, "TsdfMap",
                        "Truncated signed distance map that never confuses unknown with empty. World frame, metres.")
      .def(
          py::init(&make_map), py::kw_only(), py::arg("voxel_size_m") = TsdfConfig{}.voxel_size_m,
          py::arg("workspace") = py::none(), py::arg("truncation_vox") = TsdfConfig{}.truncation_vox,
          py::arg("free_weight") = static_cast<int>(TsdfConfig{}.free_weight),
          py::arg("clearing_percent") = static_cast<int>(TsdfConfig{}.clearing_percent), py::arg("color") = true,
          py::arg("threads") = 0,
          "`workspace`: a Box, or two corners; voxels outside of it count as neither unknown nor in the way. "
          "`clearing_percent`: how much it counts against a surface when a ray passes it by; less than 100 where poses "
          "are not exact (`saccade fuse` takes 50). `threads`: 0 for all cores.")
      .def_static("load", &load, py::arg("path"), py::arg("threads") = 0, "Reads a .sacmap file.")
      .def("save", &save, py::arg("path"), "Writes a .sacmap file.")
      .def("integrate", &integrate, py::arg("camera"), py::arg("depth"), py::arg("T_world_camera"),
           py::arg("color") = py::none(),
           "Fuses a depth image: H x W, float32 metres or uint16 millimetres along z; 0 or NaN: no return; d < 0: seen "
           "free up to |d|. `T_world_camera`: 4 x 4 or 3 x 4. `color`: H x W x 3 uint8. Returns counts and ms.")
      .def(
          "forget",
          [](SharedMap& map, const py::object& region) {
            const Region bounds = to_region(region);
            take(map.write([&](TsdfMap& content) { return content.forget(bounds); }));
          },
          py::arg("region"), "Sets the voxels of a region back to unknown.")
      .def(
          "free",
          [](SharedMap& map, const py::object& region) {
            const Region bounds = to_region(region);
            take(map.write([&](TsdfMap& content) { return content.free(bounds); }));
          },
          py::arg("region"), "Sets the voxels of a region empty.")
      .def(
          "count_unknown",
          [](const SharedMap& map, const py::object& region) {
            const TsdfSnapshot snapshot = map.snapshot();
            const Region where = to_region(region);
            take(validate(where));
            expect_countable(voxels_with_center_in(bounds(where), snapshot.config.voxel_size_m));
            const py::gil_scoped_release released;
            return count_unknown(snapshot, where);
          },
          py::arg("region"), "Unknown voxels of a region, within the workspace.")
      .def(
          "ternary",
          [](const SharedMap& map, const py::object& box) { return volume<std::int8_t>(map, box, &ternary_of); },
          py::arg("box") = py::none(),
          "int8 (z, y, x): -1 empty, 0 unknown, 1 occupied; of a box, else the workspace, else all that is known.")
      .def(
          "tsdf",
          [](const SharedMap& map, const py::object& box) {
            return volume<float>(map, box, [](const Voxel& voxel) { return static_cast<float>(voxel.v) / kTsdfOne; });
          },
          py::arg("box") = py::none(), "float32 (z, y, x): signed distance over the truncation, in [-1, 1].")
      .def(
          "weights",
          [](const SharedMap& map, const py::object& box) {
            return volume<std::uint16_t>(map, box, [](const Voxel& voxel) { return voxel.w; });
          },
          py::arg("box") = py::none(), "uint16 (z, y, x): observations of each voxel; 0: unknown.")
      .def(
          "origin",
          [](const SharedMap& map, const py::object& box) {
            const TsdfSnapshot snapshot = map.snapshot();
            return from_point(voxel_center(volume_of(snapshot, box).lo, snapshot.config.voxel_size_m));
          },
          py::arg("box") = py::none(), "Centre (x, y, z) of the first voxel of such an array.")
      .def(
          "mesh", &mesh, py::arg("min_weight") = 1,
          "dict: vertices N x 3 float32, normals N x 3 float32, colors N x 3 uint8 (or 0 x 3), triangles M x 3 uint32.")
      .def_property_readonly("voxel_size_m", [](const SharedMap& map) { return map.snapshot().config.voxel_size_m; })
      .def("close", &SharedMap::close, "Gives the memory back; the map cannot be used after it.");
}

}  // namespace saccade::python
