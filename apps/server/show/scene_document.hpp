// SPDX-License-Identifier: Apache-2.0
#pragma once
// SceneDocument: what the viewer shows, layers and steps; what layers are made of; the document as JSON.

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "saccade/core/names.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade::server {

enum class LayerKind : std::uint8_t { triangles, points, voxels, lines, views };
inline constexpr auto kLayerKindNames = make_names<LayerKind>({{LayerKind::triangles, "triangles"},
                                                               {LayerKind::points, "points"},
                                                               {LayerKind::voxels, "voxels"},
                                                               {LayerKind::lines, "lines"},
                                                               {LayerKind::views, "views"}});

/// Arrays as docs/protocol.md has them, never changed. The name is that of the content: equal bytes, equal names.
struct LayerBuffer {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

struct LegendEntry {
  std::string text;
  Rgb8 color{};
};

struct Layer {
  std::string id;    ///< of this layer alone
  std::string name;  ///< for people; layers of several steps that are the same kind of thing share it
  LayerKind kind{LayerKind::points};
  std::size_t count{0};
  std::size_t vertices{0};            ///< triangles only
  bool colors{false};                 ///< in the buffer
  Rgb8 color{154, 160, 166};          ///< where the buffer has none
  std::optional<double> size_m{};     ///< voxels: edge; points: diameter
  std::array<double, 2> fov_rad{};    ///< views only
  std::vector<LegendEntry> legend{};  ///< what its colours mean
  bool visible{true};                 ///< at first
  double opacity{1.0};                ///< at first
  bool holds_camera{false};           ///< in the way of who looks through the step's camera
  std::optional<std::size_t> step{};  ///< whose layer it is; nullopt: it is always there
  std::shared_ptr<const LayerBuffer> buffer{};
};

/// A file that GET /data/picture gives under its name.
struct StepPicture {
  std::string name;
  std::string title;
  std::filesystem::path path;
};

using Facts = std::vector<std::pair<std::string, std::string>>;

struct Step {
  std::string name;
  std::optional<Pose> T_world_camera{};
  std::array<double, 2> fov_rad{};
  Facts facts{};
  std::vector<StepPicture> pictures{};
};

enum class DocumentKind : std::uint8_t { run, mesh, map, cloud };
inline constexpr auto kDocumentKindNames = make_names<DocumentKind>({{DocumentKind::run, "run"},
                                                                     {DocumentKind::mesh, "mesh"},
                                                                     {DocumentKind::map, "map"},
                                                                     {DocumentKind::cloud, "cloud"}});
[[nodiscard]] constexpr std::string_view to_string(DocumentKind kind) { return kDocumentKindNames.of(kind); }

struct SceneDocument {
  std::string title;
  DocumentKind kind{DocumentKind::mesh};
  bool live{false};
  Eigen::Vector3d up{Eigen::Vector3d::UnitZ()};
  Box bounds{};  ///< of what is to be seen at first
  Facts facts{};
  std::vector<Layer> layers{};
  std::vector<Step> steps{};
};

/// `document` of docs/protocol.md.
[[nodiscard]] nlohmann::json document_json(const SceneDocument& document);
/// The same without what makes it long: counts of layers in place of buffers, for --json.
[[nodiscard]] nlohmann::json summary_json(const SceneDocument& document);

/// With the mesh's colours where it has some. Expects indices within the vertices.
[[nodiscard]] Layer triangles_layer(std::string id, std::string name, const TriangleMesh& mesh);
/// Expects a colour per point, or none.
[[nodiscard]] Layer points_layer(std::string id, std::string name, std::span<const Eigen::Vector3f> points,
                                 std::span<const Rgb8> colors = {});
/// Cubes around centres.
[[nodiscard]] Layer voxels_layer(std::string id, std::string name, std::span<const Eigen::Vector3f> centers,
                                 double size_m);
/// From each even entry to the next one. Expects an even number of ends, and a colour per end, or none.
[[nodiscard]] Layer lines_layer(std::string id, std::string name, std::span<const Eigen::Vector3f> ends,
                                std::span<const Rgb8> colors = {});
/// Expects a gain per pose; NaN: not known.
[[nodiscard]] Layer views_layer(std::string id, std::string name, std::span<const Pose> T_world_camera,
                                std::span<const double> gains, const std::array<double, 2>& fov_rad);
/// The twelve edges of a box.
[[nodiscard]] Layer box_layer(std::string id, std::string name, const Box& box);

/// Horizontal and vertical angle of view.
[[nodiscard]] std::array<double, 2> fov_of(const PinholeCamera& camera);
/// Around the points that are finite; without one, a cube of a metre around the origin. Never without volume.
[[nodiscard]] Box bounds_of_points(std::span<const Eigen::Vector3f> points);

}  // namespace saccade::server
