// SPDX-License-Identifier: Apache-2.0
#pragma once
// open_rgbd_folder: a folder of RGB-D frames as a CameraSource; RgbdFolderConfig; the layouts that are recognised.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "saccade/core/result.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/frames/depth_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/sensor/distortion.hpp"
#include "saccade/sensor/mask.hpp"

namespace saccade {

/// Naming of the files of a folder. `automatic` recognises it. The table of layouts is in docs/reference/formats.md,
/// and for the program in internal/rgbd_layout.cpp.
///
/// Intrinsics, unless given: those of the layout, else the first of camera-intrinsics.txt, intrinsics.K.txt,
/// intrinsics.txt, camera.json, camera_primesense.json, intrinsic.json, camera_intrinsic.json, intrinsics.json,
/// camera_intrinsics.json, camera_intrinsics.txt and cam_params.json in the folder or the one above it. Poses are
/// camera-to-world, metres.
enum class RgbdLayout {
  automatic,
  seven_scenes,
  tum,
  princeton,
  open3d,
  scannet,
  bundlefusion,
  rtabmap,
  replica,
  bop,
  icl_nuim,
  sun3d,
};
inline constexpr auto kRgbdLayoutNames = make_names<RgbdLayout>({{RgbdLayout::automatic, "automatic"},
                                                                 {RgbdLayout::seven_scenes, "seven_scenes"},
                                                                 {RgbdLayout::tum, "tum"},
                                                                 {RgbdLayout::princeton, "princeton"},
                                                                 {RgbdLayout::open3d, "open3d"},
                                                                 {RgbdLayout::scannet, "scannet"},
                                                                 {RgbdLayout::bundlefusion, "bundlefusion"},
                                                                 {RgbdLayout::rtabmap, "rtabmap"},
                                                                 {RgbdLayout::replica, "replica"},
                                                                 {RgbdLayout::bop, "bop"},
                                                                 {RgbdLayout::icl_nuim, "icl_nuim"},
                                                                 {RgbdLayout::sun3d, "sun3d"}});
[[nodiscard]] constexpr std::string_view to_string(RgbdLayout layout) { return kRgbdLayoutNames.of(layout); }

/// Words for options.
inline constexpr auto kRgbdLayoutWords = make_names<RgbdLayout>({{RgbdLayout::automatic, "auto"},
                                                                 {RgbdLayout::seven_scenes, "seven-scenes"},
                                                                 {RgbdLayout::tum, "tum"},
                                                                 {RgbdLayout::princeton, "princeton"},
                                                                 {RgbdLayout::open3d, "open3d"},
                                                                 {RgbdLayout::scannet, "scannet"},
                                                                 {RgbdLayout::bundlefusion, "bundlefusion"},
                                                                 {RgbdLayout::rtabmap, "rtabmap"},
                                                                 {RgbdLayout::replica, "replica"},
                                                                 {RgbdLayout::bop, "bop"},
                                                                 {RgbdLayout::icl_nuim, "icl-nuim"},
                                                                 {RgbdLayout::sun3d, "sun3d"}});

struct RgbdFolderConfig {
  RgbdLayout layout{RgbdLayout::automatic};
  std::optional<Intrinsics> intrinsics{};             ///< instead of the folder's
  std::optional<Intrinsics> color_intrinsics{};       ///< the colour camera, where colours are not laid on the depths
  std::optional<Pose> T_color_depth{};                ///< instead of the folder's, with color_intrinsics
  std::optional<DepthEncoding> encoding{};            ///< instead of the layout's or the files'
  std::optional<double> min_range_m{};                ///< instead of the camera's
  std::optional<double> max_range_m{};                ///< instead of the camera's
  std::optional<Distortion> distortion{};             ///< undone on depth and colour
  std::optional<std::filesystem::path> mask_file{};   ///< PNG (0: ignore) or JSON polygons (inside: ignore)
  std::vector<PixelPolygon> mask_polygons{};          ///< mask of the camera's own robot
  std::optional<std::filesystem::path> poses_file{};  ///< instead of the folder's; matched by time if both have times,
                                                      ///< otherwise by order
  bool require_poses{true};  ///< a frame without a good pose is an error where the folder has poses
  bool read_color{true};
  double max_time_difference_s{0.02};  ///< between depth and colour, and depth and pose
  std::size_t first{0};                ///< frames to skip
  std::size_t every_nth{1};
  std::optional<std::size_t> count{};  ///< limit of the frames

  /// Answers invalid_argument for a step of 0, empty ranges, or a bad scale.
  [[nodiscard]] Status validate() const;
};

/// Properties of an opened folder, for messages and run files.
struct RgbdFolderInfo {
  RgbdLayout layout{RgbdLayout::automatic};
  DepthEncoding encoding;
  UnitsSource units_from{UnitsSource::layout};
  std::string intrinsics_from;  ///< "given", or the file
  bool has_poses{false};
  bool has_color{false};
  bool is_bag{false};              ///< no folder but a bag, read by io/bags; the layout is meaningless
  std::string damage;              ///< damage of a bag, for people; empty for a sound one
  std::vector<std::string> notes;  ///< what was left out or changed on the way in, and what is strange, for people
  std::vector<std::filesystem::path> depth_files{};  ///< depth images of a folder's frames in their order, each once
};

/// Correction of a recording's images: removes the lens' distortion, masks ignored pixels, mirrors images whose focal
/// length is negative along that axis, and clips depths to the camera's range. Masks are those of the images as they
/// are in the files.
class ImageCorrection {
 public:
  /// @param intrinsics  the images' own, with distortion and range; the config's take precedence.
  /// @return unsupported for distortion with a negative focal length.
  [[nodiscard]] static Result<ImageCorrection> create(Intrinsics intrinsics, int width, int height,
                                                      const RgbdFolderConfig& config);
  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }
  /// Correct an image. Answer size_mismatch unless it has the camera's size.
  [[nodiscard]] Result<DepthImage> apply(DepthImage depth) const;
  [[nodiscard]] Result<ColorImage> apply(ColorImage color) const;

 private:
  PinholeCamera camera_;
  std::optional<Undistorter> undistorter_;
  std::optional<MaskImage> mask_;
  bool mirror_u_{false};
  bool mirror_v_{false};
};

/// Frames of a folder in the order of their names or times. next() reads, decodes, undistorts, masks and clips; a
/// frame with a missing, corrupt or ill-sized image, or a bad pose, is an error that names it. One caller at a time.
class RgbdFolderSource : public CameraSource {
 public:
  [[nodiscard]] virtual const RgbdFolderInfo& info() const = 0;
  /// Returns one of the size() frames, as next() does, without moving on.
  [[nodiscard]] virtual Result<Frame> at(std::size_t position) const = 0;
  /// Returns its pose, without reading its images. Answers not_found where it has none; corrupt_data where it is
  /// unreadable.
  [[nodiscard]] virtual Result<Pose> pose_at(std::size_t position) const = 0;
};

/// Scans the folder and reads its first images; next() reads images. Images of a frame whose intrinsics differ from the
/// first frame's are moved onto the source's camera, as are colours of another size or with intrinsics of their own,
/// pixel by nearest pixel. Errors say what is missing and what to do: not_found (no folder, no frames, no intrinsics),
/// corrupt_data, size_mismatch, invalid_argument (no scale).
[[nodiscard]] Result<std::unique_ptr<RgbdFolderSource>> open_rgbd_folder(const std::filesystem::path& folder,
                                                                         const RgbdFolderConfig& config = {});

}  // namespace saccade
