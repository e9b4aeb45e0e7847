// SPDX-License-Identifier: Apache-2.0
#include "frame_options.hpp"

#include "add_value.hpp"

#include <CLI/CLI.hpp>
#include <cmath>

namespace saccade::cli {
namespace {

constexpr auto kEncodingWords =
    make_names<DepthEncoding>({{{1000.0, false}, "mm"}, {{5000.0, false}, "tum"}, {{10000.0, true}, "bit-rotated"}});

/// Options for colour images that are not registered to the depth images.
void add_color_camera_options(CLI::App& command, RgbdFolderConfig& folder) {
  CLI::Option* camera =
      command
          .add_option_function<std::string>(
              "--color-camera",
              [&folder](const std::string& text) {
                const std::vector<double> n = parse_numbers("--color-camera", text, 4);
                if (!(n[0] > 0.0 && n[1] > 0.0)) usage_error("--color-camera", "focal lengths must be positive");
                folder.color_intrinsics = Intrinsics{n[0], n[1], n[2], n[3], {}, {}, {}, {}, {}};
              },
              "focal lengths and principal point of the colour images, pixels, where they are not registered to the "
              "depth images: their colours are laid on the depths")
          ->type_name("FX,FY,CX,CY");
  command
      .add_option_function<std::string>(
          "--color-at",
          [&folder](const std::string& text) {
            const std::vector<double> n = parse_numbers("--color-at", text, 0);
            if (n.size() != 3 && n.size() != 7) {
              usage_error("--color-at", "takes X,Y,Z or X,Y,Z,QX,QY,QZ,QW, not " + text);
            }
            Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
            if (n.size() == 7) turn = Eigen::Quaterniond{n[6], n[3], n[4], n[5]};
            constexpr double kLeastLength{1e-6};
            if (!(turn.norm() > kLeastLength)) usage_error("--color-at", "has a quaternion of length 0");
            folder.T_color_depth = (Eigen::Translation3d{n[0], n[1], n[2]} * turn.normalized()).inverse();
          },
          "place of the colour camera in the depth camera's frame (x right, y down, z forward; metres), and its turn "
          "as "
          "a quaternion (default: the same place)")
      ->type_name("X,Y,Z[,QX,QY,QZ,QW]")
      ->needs(camera);
}

void add_reading_options(CLI::App& command, FrameOptions& options) {
  add_camera_options(command, options.camera, false);
  command
      .add_option_function<std::string>(
          "--distortion",
          [&options](const std::string& text) {
            const std::vector<double> n = parse_numbers("--distortion", text, 0);
            options.folder.distortion = Distortion::from_coefficients(n);
            if (n.size() < 4 || !options.folder.distortion) {
              throw CLI::ValidationError("--distortion", "4 to 8 numbers expected: k1,k2,p1,p2,k3,k4,k5,k6");
            }
          },
          "lens distortion (Brown-Conrady, as OpenCV orders it; the last four may be left out), undone on the way in")
      ->type_name("K1,K2,P1,P2,K3,K4,K5,K6");
  add_color_camera_options(command, options.folder);
  add_choice(command, "--layout", options.folder.layout, kRgbdLayoutWords, "how the files are named; auto: recognised");
  add_choice(command, "--depth-encoding", options.folder.encoding, kEncodingWords,
             "meaning of depth samples (default: the layout's): 1/1000 m, 1/5000 m, 1/10000 m rotated by three bits");
  add_value(command, "--depth-scale", options.depth_scale, "N",
            "depth samples per metre, instead of the folder's or the encoding's");
  add_value(command, "--poses", options.folder.poses_file, "FILE",
            "camera poses, instead of the folder's (TUM, matrices, KITTI, g2o, JSON)");
  command
      .add_option_function<std::vector<std::string>>(
          "--mask",
          [&options](const std::vector<std::string>& values) {
            for (const std::string& text : values) {
              if (auto polygon = parse_polygon("--mask", text)) {
                options.folder.mask_polygons.push_back(std::move(*polygon));
              } else if (options.folder.mask_file) {
                usage_error("--mask", "takes one file and any number of polygons");
              } else {
                options.folder.mask_file = text;
              }
            }
          },
          "pixels to ignore, such as the camera's own robot: PNG (0 is ignored), JSON polygons, or U,V;U,V;U,V")
      ->type_name("FILE|POLYGON")
      ->allow_extra_args(false);
  add_value(command, "--fill-gaps", options.fill_gaps_px, "PIXELS",
            "close gaps of up to PIXELS pixels between similar depths, as registered depth images have them "
            "(default: 2 where the first frame is full of such gaps, else 0)");
  add_value(command, "--first", options.folder.first, "N", "leave out the first N frames")->check(check_whole_number);
  add_value(command, "--count", options.folder.count, "N", "use at most N frames")->check(check_whole_number);
  add_value(command, "--every", options.folder.every_nth, "N", "use every n-th frame")->check(check_whole_number);
}

void add_bag_options(CLI::App& command, BagFramesConfig& bag) {
  add_value(command, "--depth", bag.depth, "TOPIC", "depth images in a bag (default: the only topic of depth)");
  add_value(command, "--info", bag.info, "TOPIC", "their camera_info (default: beside them)");
  add_value(command, "--color", bag.color, "TOPIC", "colour images in a bag, registered to the depth images");
  add_value(command, "--world-frame", bag.world_frame, "FRAME",
            "frame of TF in which a bag's camera poses are (default: the root of the camera's tree)");
}

Result<std::unique_ptr<RgbdFolderSource>> open_source(const FrameOptions& options, const RgbdFolderConfig& reading) {
  if (is_bag(options.frames)) {
    if (reading.color_intrinsics) {
      return Error{Errc::invalid_argument, "--color-camera and --color-at are for folders; this is a bag",
                   options.frames.string()};
    }
    BagFramesConfig bag = options.bag;
    bag.reading = reading;
    return open_bag_frames(options.frames, bag);
  }
  std::error_code ignored;
  if (!std::filesystem::exists(std::filesystem::status(options.frames, ignored))) {
    return Error{Errc::not_found, "there is no such file or folder", options.frames.string()};
  }
  if (std::filesystem::is_regular_file(options.frames, ignored)) {
    return Error{Errc::invalid_argument,
                 "this file is neither a bag of ROS 1 nor an MCAP file; other frames are read from a folder",
                 options.frames.string()};
  }
  const BagFramesConfig& bag = options.bag;
  if (!bag.depth.empty() || !bag.info.empty() || !bag.color.empty() || !bag.world_frame.empty()) {
    return Error{Errc::invalid_argument,
                 "--depth, --info, --color and --world-frame are for bags of ROS and MCAP files; this is a folder",
                 options.frames.string()};
  }
  return open_rgbd_folder(options.frames, reading);
}

/// The tracking mode that was asked for or that the folder allows.
Result<TrackingMode> choose_tracking(const FrameOptions& options, const RgbdFolderInfo& info) {
  if (!options.tracking) return info.has_poses ? TrackingMode::forced : TrackingMode::icp;
  if (needs_pose(*options.tracking) && !info.has_poses) {
    return Error{Errc::not_found,
                 "there are no camera poses for --tracking " + std::string{to_string(*options.tracking)} +
                     "; pass --poses FILE, or use --tracking icp or rgbd",
                 options.frames.string()};
  }
  return *options.tracking;
}

}  // namespace

void add_frame_options(CLI::App& command, FrameOptions& options) {
  add_value(command, "frames", options.frames, "DIR|BAG",
            "folder of RGB-D frames, bag of ROS (.bag) or MCAP file (.mcap)")
      ->required();
  add_choice(
      command, "--tracking", options.tracking, kTrackingModeNames,
      "icp: by the depth images alone; rgbd: by depths and colours, for fast motion too, and found again after a "
      "loss; hint: ICP from the given poses; forced: the given poses as they are (default: forced where there "
      "are poses, else icp)");
  add_bag_options(command, options.bag);
  add_reading_options(command, options);
}

void check_frame_options(FrameOptions& options) {
  if (options.fill_gaps_px) require_ok(GapFilling{*options.fill_gaps_px}.validate(), "--fill-gaps");
  if (options.depth_scale) {
    require_positive(*options.depth_scale, "--depth-scale");
    if (!options.folder.encoding) options.folder.encoding = DepthEncoding{};
    options.folder.encoding->units_per_m = *options.depth_scale;
  }
  options.folder.intrinsics = options.camera.given_intrinsics();
  options.folder.min_range_m = options.camera.min_range_m;
  options.folder.max_range_m = options.camera.max_range_m;
  const PinholeCamera camera = options.camera.camera(PinholeCamera{});
  if (!(camera.min_range_m >= 0.0) || !std::isfinite(camera.min_range_m)) {
    usage_error("--min-range", "must not be negative");
  }
  if (options.camera.max_range_m) require_positive(*options.camera.max_range_m, "--max-range");
  if (options.camera.min_range_m && options.camera.max_range_m &&
      *options.camera.min_range_m >= *options.camera.max_range_m) {
    usage_error("--min-range", "must be below --max-range");
  }
  require_ok(options.folder.validate(), "--every, --count");
}

Status check_beside_frames(const FrameOptions& options, const std::filesystem::path& file, const char* option) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  const auto whole = [&ignored](const fs::path& path) { return fs::weakly_canonical(path, ignored); };
  const auto is_read = [&](const std::optional<fs::path>& other) { return other && whole(file) == whole(*other); };
  const fs::path from_folder = whole(file).lexically_relative(whole(options.frames));
  const bool is_inside = !from_folder.empty() && *from_folder.begin() != "..";
  if (!is_inside && !is_read(options.folder.mask_file) && !is_read(options.folder.poses_file)) return {};
  return Error{Errc::invalid_argument,
               std::string{"is read, or lies among the frames, and would be replaced by "} + option +
                   "; name another file there",
               file.string()};
}

Result<OpenFrames> open_frames(const FrameOptions& options) {
  OpenFrames frames;
  frames.folder = options.folder;
  SACCADE_TRY(frames.source, open_source(options, frames.folder));
  SACCADE_TRY(frames.tracking, choose_tracking(options, frames.source->info()));
  if (!needs_pose(frames.tracking)) {
    frames.folder.require_poses = false;
    SACCADE_TRY(frames.source, open_source(options, frames.folder));
  }
  return frames;
}

void warn_of_damage(const std::filesystem::path& frames, const RgbdFolderInfo& info, Outcome& outcome) {
  for (const std::string& note : info.notes) outcome.warnings.push_back("warning: " + frames.string() + ": " + note);
  if (info.damage.empty()) return;
  outcome.warnings.push_back("warning: " + frames.string() + ": " + info.damage + "; what could be read was read");
}

}  // namespace saccade::cli
