// SPDX-License-Identifier: Apache-2.0
#pragma once
// What `saccade segment` was asked for, what it read and what it found, for its output.

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "json_output.hpp"
#include "saccade/attention/saliency.hpp"
#include "saccade/io/cloud_io.hpp"
#include "saccade/map/mesh.hpp"
#include "saccade/segment/lccp.hpp"
#include "segment_saliency.hpp"

namespace saccade::cli {

struct SegmentOptions {
  std::filesystem::path input;  ///< a cloud, or a map
  std::string method{"lccp"};
  std::filesystem::path out;      ///< empty: no labelled cloud
  std::filesystem::path picture;  ///< empty: none
  SupervoxelConfig supervoxels;
  std::optional<Eigen::Vector3d> viewpoint_m;  ///< default: what the cloud says
  LccpConfig lccp;
  MeasureConfig measures;
  SaliencyOptions saliency;
};

/// What there is to segment: a cloud with all its fields, or the surface of a map.
struct SegmentInput {
  CloudFile file;
  PointCloud cloud;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of a map's surface
  Eigen::Vector3d viewpoint_m{Eigen::Vector3d::Zero()};
  bool is_map{false};
};

struct SegmentFindings {
  SupervoxelResult supervoxels;
  LccpResult segments;
  std::vector<SegmentMeasures> measures;
  std::vector<Saliency> saliencies;
  std::size_t points{0};  ///< with a position, so in a segment
  double supervoxels_ms{0.0};
  double lccp_ms{0.0};
  double saliency_ms{0.0};
  std::string label_kept_as;  ///< the name of the input's own field "label" in the output; empty: it has none
};

void add_segment_options(CLI::App& command, SegmentOptions& options);
void check_segment_options(SegmentOptions& options);

/// By its name: .sacmap.
[[nodiscard]] bool is_map(const std::filesystem::path& input);
/// A map's surface points are the vertices of its mesh, with TSDF-gradient normals (thesis §3.1).
[[nodiscard]] Result<SegmentInput> read_segment_input(const std::filesystem::path& path, const Executor& executor);

[[nodiscard]] nlohmann::json segment_json(const SegmentOptions& options, const SegmentInput& input,
                                          const SegmentFindings& findings);
void print_segments(const SegmentOptions& options, const SegmentFindings& findings);
[[nodiscard]] ColorImage segment_sheet(const SegmentOptions& options, const SegmentInput& input,
                                       const SegmentFindings& findings, const Executor& executor);

}  // namespace saccade::cli
