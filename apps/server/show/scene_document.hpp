// SPDX-License-Identifier: Apache-2.0
#pragma once
// SceneDocument: the layers and steps that the viewer shows; builders of layers; the document as JSON.

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

/// Immutable arrays in the format of docs/reference/protocol.md. The name is a hash of the content.
struct LayerBuffer {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

struct LegendEntry {
  std::string text;
  Rgb8 color{};
};

/// Numbers of each point that it can be coloured by.
struct LayerField {
  std::string name;
  int width{1};  ///< numbers per point; 3: a direction
  std::shared_ptr<const LayerBuffer> buffer{};
};

struct Layer {
  std::string id;    ///< unique to this layer
  std::string name;  ///< for people; shared by layers of one kind in several steps
  LayerKind kind{LayerKind::points};
  std::size_t count{0};
  std::size_t vertices{0};         ///< triangles only
  bool colors{false};              ///< in the buffer
  Rgb8 color{154, 160, 166};       ///< where the buffer has none
  std::optional<double> size_m{};  ///< voxels: edge; points: diameter, or how many times as wide as `diameters`
  bool diameters{false};           ///< points: in the buffer
  std::optional<std::vector<LayerField>> fields{};  ///< fields to colour a cloud by, besides height; nullopt: neither
  std::array<double, 2> fov_rad{};                  ///< views only
  std::vector<LegendEntry> legend{};                ///< meaning of its colours
  bool visible{true};                               ///< at first
  double opacity{1.0};                              ///< at first
  bool holds_camera{false};                         ///< obstructs the view through the step's camera
  std::optional<std::size_t> step{};                ///< step that it belongs to; nullopt: always shown
  std::shared_ptr<const LayerBuffer> buffer{};
};

/// Image that GET /data/picture delivers by name.
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
  std::optional<Eigen::Vector3d> towards_viewer{};  ///< direction from which it was seen
  Box bounds{};                                     ///< bounds of the initial view
  Facts facts{};
  std::vector<Layer> layers{};
  std::vector<Step> steps{};
  nlohmann::json record{};         ///< record of the run, for its report; null: there is none
  std::filesystem::path folder{};  ///< folder of the run, with the pictures of the report
};

/// Returns `document` of docs/reference/protocol.md.
[[nodiscard]] nlohmann::json document_json(const SceneDocument& document);
/// Returns a short form for --json: numbers of elements per layer instead of buffers.
[[nodiscard]] nlohmann::json summary_json(const SceneDocument& document);

/// Uses the mesh's colours where it has some. Expects indices within the vertices.
[[nodiscard]] Layer triangles_layer(std::string id, std::string name, const TriangleMesh& mesh);
/// Expects one colour per point, or none.
[[nodiscard]] Layer points_layer(std::string id, std::string name, std::span<const Eigen::Vector3f> points,
                                 std::span<const Rgb8> colors = {});
/// Draws discs, one diameter per point.
[[nodiscard]] Layer discs_layer(std::string id, std::string name, std::span<const Eigen::Vector3f> points,
                                std::span<const Rgb8> colors, std::span<const float> diameters_m);
/// Expects `width` numbers per point.
[[nodiscard]] LayerField layer_field(std::string name, int width, std::span<const float> values);
/// Draws cubes around centres.
[[nodiscard]] Layer voxels_layer(std::string id, std::string name, std::span<const Eigen::Vector3f> centers,
                                 double size_m);
/// Draws lines from each even entry to the next one. Expects an even number of ends, and one colour per end, or none.
[[nodiscard]] Layer lines_layer(std::string id, std::string name, std::span<const Eigen::Vector3f> ends,
                                std::span<const Rgb8> colors = {});
/// Expects one gain per pose; NaN: unknown.
[[nodiscard]] Layer views_layer(std::string id, std::string name, std::span<const Pose> T_world_camera,
                                std::span<const double> gains, const std::array<double, 2>& fov_rad);
/// Draws the twelve edges of a box.
[[nodiscard]] Layer box_layer(std::string id, std::string name, const Box& box);

/// Returns the horizontal and vertical angle of view.
[[nodiscard]] std::array<double, 2> fov_of(const PinholeCamera& camera);
/// Returns the box around the finite points; without one, a cube of a metre around the origin. Never without volume.
[[nodiscard]] Box bounds_of_points(std::span<const Eigen::Vector3f> points);

}  // namespace saccade::server
