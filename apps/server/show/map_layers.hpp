// SPDX-License-Identifier: Apache-2.0
#pragma once
// Layers of a map: its surface, the frontier of the unknown, and what of the surface draws attention.

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

/// What is added to the ids of layers, and the step that they belong to.
struct LayerPlace {
  std::string suffix;
  std::optional<std::size_t> step;
};

/// Unknown voxels next to empty ones within the workspace, hidden at first. nullopt where there is none, or so many
/// that no page could show them.
[[nodiscard]] std::optional<Layer> frontier_layer(const TsdfSnapshot& map, const LayerPlace& place);

/// The surface, the more salient its segment the brighter; hidden at first.
/// @param mesh      of the map that was looked at.
/// @param saliency  one per segment.
[[nodiscard]] Layer saliency_layer(const TsdfSnapshot& map, const TriangleMesh& mesh, const SegmentedPoints& surface,
                                   std::span<const double> saliency, const LayerPlace& place, const Executor& executor);

/// Places at the border of what is known with the direction to look at them from, those of one segment apart from the
/// others; hidden at first. nullopt where there is none.
[[nodiscard]] std::optional<Layer> contours_layer(const ContourSet& contours, std::optional<std::uint32_t> segment,
                                                  const LayerPlace& place);

/// Surface, frontier, saliency by `objectness` and contours of a map that is shown for itself.
[[nodiscard]] Result<std::vector<Layer>> layers_of_map(const TsdfSnapshot& map, const TriangleMesh& mesh,
                                                       const Executor& executor);

/// Voxel size, truncation, extent, how much is known.
[[nodiscard]] Facts facts_of_map(const TsdfSnapshot& map, const TriangleMesh& mesh);
/// The workspace, or all of the surface.
[[nodiscard]] Box bounds_of_map(const TsdfSnapshot& map, const TriangleMesh& mesh);

/// What draws attention in a map.
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
