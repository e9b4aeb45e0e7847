// SPDX-License-Identifier: Apache-2.0
#pragma once
// Layers of a map: its surface, the frontier of the unknown, and the saliency of the surface.

#include <string>
#include <vector>

#include "saccade/attention/salient_objects.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/views/view_generator.hpp"
#include "server/show/scene_document.hpp"

namespace saccade::server {

// Names that the layers of a map have in every step.
inline constexpr const char* kSurfaceName{"Surface"};
inline constexpr const char* kFrontierName{"Frontier of the unknown"};
inline constexpr const char* kSaliencyName{"Saliency of segments"};
inline constexpr const char* kContoursName{"Contours"};

/// Suffix of the layers' ids, and the step that they belong to.
struct LayerPlace {
  std::string suffix;
  std::optional<std::size_t> step;
};

/// Returns the unknown voxels next to empty ones within the workspace, hidden at first. nullopt where there is none, or
/// too many for a page.
[[nodiscard]] std::optional<Layer> frontier_layer(const TsdfSnapshot& map, const LayerPlace& place);

/// Returns the surface, brighter for more salient segments; hidden at first.
/// @param mesh      mesh of this map.
[[nodiscard]] Layer saliency_layer(const TsdfSnapshot& map, const TriangleMesh& mesh, const SegmentedPoints& surface,
                                   std::span<const double> saliency, const LayerPlace& place, const Executor& executor);

/// Returns the contour points with their viewing directions, those of one segment distinguished from the others; hidden
/// at first. nullopt where there is none.
[[nodiscard]] std::optional<Layer> contours_layer(const ContourSet& contours, std::optional<std::uint32_t> segment,
                                                  const LayerPlace& place);

/// Returns surface, frontier, saliency by `objectness` and contours of a single map.
[[nodiscard]] Result<std::vector<Layer>> layers_of_map(const TsdfSnapshot& map, const TriangleMesh& mesh,
                                                       const Executor& executor);

/// Returns voxel size, truncation, extent, and the known share.
[[nodiscard]] Facts facts_of_map(const TsdfSnapshot& map, const TriangleMesh& mesh);
/// Returns the workspace, or the bounds of the whole surface.
[[nodiscard]] Box bounds_of_map(const TsdfSnapshot& map, const TriangleMesh& mesh);

/// Saliency of a map.
struct SeenAttention {
  std::shared_ptr<const SalientSurface> surface;
  ContourSet contours;
};

/// Follows a map from call to call.
class AttentionLook {
 public:
  /// Errors of SalientObjects::look.
  [[nodiscard]] Result<SeenAttention> look(const TsdfSnapshot& map, const Executor& executor);

 private:
  SalientObjects objects_;
  LiveContours contours_{LiveContours::create().value()};
};

}  // namespace saccade::server
