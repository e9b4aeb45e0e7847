// SPDX-License-Identifier: Apache-2.0
#pragma once
// Intrinsics from text, 3×3 matrices and JSON; CamInfo of the Princeton APC sequences; masks from polygon files.

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "saccade/core/result.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/sensor/distortion.hpp"
#include "saccade/sensor/mask.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

/// Default minimum range of recordings. The sensor has already dropped returns that it cannot measure, and hand-held
/// and wrist-mounted cameras come nearer than the 0.4 m of PinholeCamera.
constexpr double kRecordedMinRange_m{0.2};

/// Description of a camera in a file or an option; pixels. A negative focal length is an image axis that runs the other
/// way, as in ICL-NUIM, whose v counts upwards: ImageCorrection mirrors such images.
struct Intrinsics {
  double fx{0.0};
  double fy{0.0};
  double cx{0.0};
  double cy{0.0};
  std::optional<int> width;
  std::optional<int> height;
  std::optional<double> min_range_m;
  std::optional<double> max_range_m;
  std::optional<Distortion> distortion;
  std::optional<double> depth_units_per_m{};  ///< scale of the depth images, where the file has it

  /// Returns a camera with the given image size; the range defaults to kRecordedMinRange_m and PinholeCamera's maximum.
  /// Answers size_mismatch when the intrinsics are for another size; invalid_argument as PinholeCamera::validate().
  [[nodiscard]] Result<PinholeCamera> camera(int image_width, int image_height) const;
  /// Says what is strange about a valid camera, for a warning: a principal point more than half an image outside of the
  /// image, as another order of the numbers or another image size gives. Empty for a usual camera.
  [[nodiscard]] static std::string doubt(const PinholeCamera& camera);
};

/// Parses "fx,fy,cx,cy" (commas or blanks), a 3×3 matrix [fx 0 cx; 0 fy cy; 0 0 1] row by row, such a matrix within one
/// of 3×4 or 4×4, YAML of OpenCV (camera_matrix, distortion_coefficients, image_width, image_height), or JSON: either
/// {"width", "height", "intrinsic_matrix": nine numbers column by column} as Open3D writes it, or {"width", "height",
/// "fx", "fy", "cx", "cy", "min_range_m", "max_range_m", "distortion": {"k1", "k2", "p1", "p2", "k3",
/// "k4", "k5", "k6"}}, where only the focal lengths and the principal point are required. "w", "h" and "scale" within
/// "camera" are those of NICE-SLAM; "depth_scale" is samples per metre from 100 on, metres per sample below 0.05, and
/// an error in between. corrupt_data describes the error.
[[nodiscard]] Result<Intrinsics> parse_intrinsics(std::string_view text);
[[nodiscard]] Result<Intrinsics> read_intrinsics(const std::filesystem::path& path);
/// Returns the second JSON form.
[[nodiscard]] nlohmann::json camera_to_json(const PinholeCamera& camera);

/// cam.info.txt: intrinsics of both cameras and one camera-to-world matrix per frame name ("frame-000000").
struct CamInfo {
  Intrinsics color;
  Intrinsics depth;
  std::map<std::string, PoseEntry, std::less<>> T_world_camera;
};
/// Parses such a file. Answers corrupt_data with the line; an invalid matrix is kept as the error of its frame.
[[nodiscard]] Result<CamInfo> parse_cam_info(std::string_view text);

/// Parses polygons [[[u, v], ...], ...] in JSON.
[[nodiscard]] Result<std::vector<PixelPolygon>> parse_polygons(std::string_view json_text);

}  // namespace saccade
