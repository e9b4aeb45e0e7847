// SPDX-License-Identifier: Apache-2.0
#pragma once
// open_rgbd_folder: a folder of RGB-D frames as a CameraSource; RgbdFolderConfig; the layouts that are recognised.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "saccade/core/result.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/sensor/distortion.hpp"
#include "saccade/sensor/mask.hpp"

namespace saccade {

/// How the files of a folder are named. `automatic` recognises them in this order:
///
/// | layout      | recognised by         | depth             | colour               | poses              | encoding |
/// |-------------|-----------------------|-------------------|----------------------|--------------------|--------------|
/// | princeton   | cam.info.txt          | NAME.depth.png    | NAME.color.png, .jpg | cam.info.txt       | 1/10000 m,
/// bit-rotated | | seven_scenes| *.depth.png           | NAME.depth.png    | NAME.color.png, .jpg | NAME.pose.txt |
/// 1/1000 m     | | tum         | depth.txt             | listed            | rgb.txt              | groundtruth.txt |
/// 1/5000 m     | | open3d      | depth/                | depth/*.png       | color/NAME.*         | trajectory.log |
/// 1/1000 m     |
///
/// Intrinsics, unless given: cam.info.txt (the colour camera's, to which its depth is registered), else the first of
/// camera-intrinsics.txt, intrinsics.K.txt, intrinsics.txt, camera.json, camera_primesense.json, intrinsic.json,
/// camera_intrinsic.json in the folder or the one above it. Poses are camera-to-world, metres.
enum class RgbdLayout { automatic, seven_scenes, tum, princeton, open3d };
inline constexpr auto kRgbdLayoutNames = make_names<RgbdLayout>({{RgbdLayout::automatic, "automatic"},
                                                                 {RgbdLayout::seven_scenes, "seven_scenes"},
                                                                 {RgbdLayout::tum, "tum"},
                                                                 {RgbdLayout::princeton, "princeton"},
                                                                 {RgbdLayout::open3d, "open3d"}});
[[nodiscard]] constexpr std::string_view to_string(RgbdLayout layout) { return kRgbdLayoutNames.of(layout); }

struct RgbdFolderConfig {
  RgbdLayout layout{RgbdLayout::automatic};
  std::optional<Intrinsics> intrinsics{};             ///< instead of the folder's
  std::optional<DepthEncoding> encoding{};            ///< instead of the layout's
  std::optional<double> min_range_m{};                ///< instead of the camera's
  std::optional<double> max_range_m{};                ///< instead of the camera's
  std::optional<Distortion> distortion{};             ///< undone on depth and colour
  std::optional<std::filesystem::path> mask_file{};   ///< PNG (0: ignore) or JSON polygons (inside: ignore)
  std::vector<PixelPolygon> mask_polygons{};          ///< pixels of the camera's own robot
  std::optional<std::filesystem::path> poses_file{};  ///< instead of the folder's; by time if both have it, else order
  bool require_poses{true};  ///< where the folder has poses, a frame without a good one is an error
  bool read_color{true};
  double max_time_difference_s{0.02};  ///< between depth and colour, and depth and pose
  std::size_t first{0};                ///< skip so many frames
  std::size_t every_nth{1};
  std::optional<std::size_t> count{};  ///< at most so many frames

  /// invalid_argument for a step of 0, empty ranges, or a bad scale.
  [[nodiscard]] Status validate() const;
};

/// What was found, for messages and run files.
struct RgbdFolderInfo {
  RgbdLayout layout{RgbdLayout::automatic};
  DepthEncoding encoding;
  std::string intrinsics_from;  ///< "given", or the file
  bool has_poses{false};
  bool has_color{false};
  bool is_bag{false};  ///< no folder: io/bags reads those, and the layout means nothing
  std::string damage;  ///< what is wrong with a bag, for people; empty where nothing is
};

/// What is done to the images of a recording before they are used: the lens' distortion is undone, ignored pixels are
/// masked, depths clipped to the camera's range.
class ImageCorrection {
 public:
  /// @param intrinsics  of the images, with their own distortion and range; the config's come first.
  [[nodiscard]] static Result<ImageCorrection> create(Intrinsics intrinsics, int width, int height,
                                                      const RgbdFolderConfig& config);
  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }
  /// size_mismatch unless the image has the camera's size.
  [[nodiscard]] Result<DepthImage> apply(DepthImage depth) const;
  [[nodiscard]] Result<ColorImage> apply(ColorImage color) const;

 private:
  PinholeCamera camera_;
  std::optional<Undistorter> undistorter_;
  std::optional<MaskImage> mask_;
};

/// Frames of a folder in the order of their names or times. next() reads, decodes, undistorts, masks and clips; a
/// frame with a missing, corrupt or ill-sized image, or a bad pose, is an error that names it. One caller at a time.
class RgbdFolderSource : public CameraSource {
 public:
  [[nodiscard]] virtual const RgbdFolderInfo& info() const = 0;
  /// One of the size() frames, as next() reads it, but without moving on.
  [[nodiscard]] virtual Result<Frame> at(std::size_t position) const = 0;
  /// Its pose, without reading its images. not_found: it has none; corrupt_data: it cannot be read.
  [[nodiscard]] virtual Result<Pose> pose_at(std::size_t position) const = 0;
};

/// Looks the folder through and reads the first image's size; images are read by next(). Errors say what is missing
/// and what to do: not_found (no folder, no frames, no intrinsics), corrupt_data, size_mismatch, invalid_argument.
[[nodiscard]] Result<std::unique_ptr<RgbdFolderSource>> open_rgbd_folder(const std::filesystem::path& folder,
                                                                         const RgbdFolderConfig& config = {});

}  // namespace saccade
