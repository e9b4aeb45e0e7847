// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/rgbd_folder.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/internal/rgbd_layout.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

Status check_size(const PinholeCamera& camera, int width, int height) {
  if (width == camera.width && height == camera.height) return {};
  return Error{Errc::size_mismatch,
               "image is " + size_text(width, height) + ", not " + size_text(camera.width, camera.height),
               {}};
}

class FolderSource final : public RgbdFolderSource {
 public:
  FolderSource(ImageCorrection correction, RgbdFolderInfo info, std::vector<RgbdFrameFiles> frames,
               const RgbdFolderConfig& config)
      : correction_{std::move(correction)},
        info_{std::move(info)},
        frames_{std::move(frames)},
        every_nth_{config.every_nth},
        first_{config.first},
        require_poses_{config.require_poses && info_.has_poses},
        read_color_{config.read_color} {}

  [[nodiscard]] const PinholeCamera& camera() const override { return correction_.camera(); }
  [[nodiscard]] std::optional<std::size_t> size() const override { return frames_.size(); }
  [[nodiscard]] const RgbdFolderInfo& info() const override { return info_; }

  [[nodiscard]] Result<std::optional<Frame>> next() override {
    if (position_ == frames_.size()) return std::optional<Frame>{};
    SACCADE_TRY(Frame frame, at(position_++));
    return std::optional{std::move(frame)};
  }

  [[nodiscard]] Result<Frame> at(std::size_t position) const override {
    SACCADE_EXPECTS(position < frames_.size());
    auto frame = read(frames_[position]);
    if (!frame) return of_frame(frame.error(), position);
    frame->index = first_ + position * every_nth_;
    return frame;
  }

  [[nodiscard]] Result<Pose> pose_at(std::size_t position) const override {
    SACCADE_EXPECTS(position < frames_.size());
    auto pose = read_pose(frames_[position]);
    if (!pose) return of_frame(pose.error(), position);
    return pose;
  }

 private:
  [[nodiscard]] Error of_frame(Error error, std::size_t position) const {
    const std::string name = "frame " + frames_[position].name;
    error.context = error.context.empty() ? name : name + ", " + error.context;
    return error;
  }

  [[nodiscard]] Result<Frame> read(const RgbdFrameFiles& files) const {
    Frame frame;
    frame.name = files.name;
    frame.time_s = files.time_s;
    auto pose = read_pose(files);
    if (pose) {
      frame.T_world_camera = *pose;
    } else if (require_poses_) {
      return pose.error();
    }
    SACCADE_TRY(frame.depth, read_depth(files));
    if (read_color_ && files.color) {
      SACCADE_TRY(frame.color, read_frame_color(*files.color));
    }
    return frame;
  }

  [[nodiscard]] static Result<Pose> read_pose(const RgbdFrameFiles& files) {
    if (files.T_world_camera) return *files.T_world_camera;
    if (!files.pose_file) return Error{Errc::not_found, "has no pose, as others here have", {}};
    SACCADE_TRY(const auto poses, read_poses(*files.pose_file));
    if (poses.size() != 1) return Error{Errc::corrupt_data, "one 4x4 matrix expected", files.pose_file->string()};
    return poses.front();
  }

  [[nodiscard]] Result<DepthImage> read_depth(const RgbdFrameFiles& files) const {
    if (!files.depth) return Error{Errc::not_found, "its depth image is missing", {}};
    SACCADE_TRY(const Image16 samples, read_png16(*files.depth));
    return in_file(correction_.apply(decode_depth(samples, info_.encoding)), *files.depth);
  }

  [[nodiscard]] Result<ColorImage> read_frame_color(const fs::path& path) const {
    SACCADE_TRY(ColorImage color, saccade::read_color(path));
    return in_file(correction_.apply(std::move(color)), path);
  }

  ImageCorrection correction_;
  RgbdFolderInfo info_;
  std::vector<RgbdFrameFiles> frames_;
  std::size_t every_nth_;
  std::size_t first_;
  bool require_poses_;
  bool read_color_;
  std::size_t position_{0};
};

/// Intrinsics given, of the layout's own file, or of a file beside the frames.
Status find_intrinsics(const fs::path& folder, const RgbdFolderConfig& config, RgbdListing& listing) {
  if (config.intrinsics) {
    listing.intrinsics = config.intrinsics;
    listing.intrinsics_from = "given";
  }
  if (listing.intrinsics) return {};
  const fs::path above = fs::absolute(folder / "x").parent_path().lexically_normal().parent_path();
  for (const fs::path& place : {folder, above}) {
    for (const char* name : {"camera-intrinsics.txt", "intrinsics.K.txt", "intrinsics.txt", "camera.json",
                             "camera_primesense.json", "intrinsic.json", "camera_intrinsic.json"}) {
      std::error_code ignored;
      if (!fs::is_regular_file(place / name, ignored)) continue;
      SACCADE_TRY(listing.intrinsics, read_intrinsics(place / name));
      listing.intrinsics_from = (place / name).string();
      return {};
    }
  }
  return Error{Errc::not_found,
               "no camera intrinsics here; pass --intrinsics fx,fy,cx,cy or add a camera-intrinsics.txt with the 3x3 "
               "matrix",
               folder.string()};
}

/// Size of the first depth image whose header can be read.
Result<PngSize> first_size(const std::vector<RgbdFrameFiles>& frames) {
  std::optional<Error> first_error;
  for (const RgbdFrameFiles& frame : frames) {
    if (!frame.depth) continue;
    const auto size = read_png_size(*frame.depth);
    if (size) return size;
    if (!first_error) first_error = size.error();
  }
  SACCADE_EXPECTS(first_error.has_value());
  return Error{first_error->code, "no depth image here can be read; the first: " + first_error->message,
               first_error->context};
}

Result<std::optional<MaskImage>> find_mask(const RgbdFolderConfig& config, const PinholeCamera& camera) {
  std::vector<PixelPolygon> polygons = config.mask_polygons;
  if (config.mask_file && config.mask_file->extension() == ".json") {
    SACCADE_TRY(const std::string text, read_text_file(*config.mask_file));
    SACCADE_TRY(auto read, parse_polygons(text));
    polygons.insert(polygons.end(), read.begin(), read.end());
  } else if (config.mask_file) {
    SACCADE_TRY(MaskImage mask, read_mask(*config.mask_file));
    if (mask.width() != camera.width || mask.height() != camera.height) {
      return Error{Errc::size_mismatch,
                   "the mask is " + size_text(mask.width(), mask.height()) + ", the depth images are " +
                       size_text(camera.width, camera.height),
                   config.mask_file->string()};
    }
    if (polygons.empty()) return std::optional{std::move(mask)};
    SACCADE_TRY(const MaskImage drawn, mask_from_polygons(camera.width, camera.height, polygons));
    for (std::size_t i = 0; i < mask.size(); ++i) mask.data()[i] = std::min(mask.data()[i], drawn.data()[i]);
    return std::optional{std::move(mask)};
  }
  if (polygons.empty()) return std::optional<MaskImage>{};
  SACCADE_TRY(MaskImage mask, mask_from_polygons(camera.width, camera.height, polygons));
  return std::optional{std::move(mask)};
}

std::vector<RgbdFrameFiles> selected(std::vector<RgbdFrameFiles> all, const RgbdFolderConfig& config) {
  std::vector<RgbdFrameFiles> chosen;
  const std::size_t limit = config.count.value_or(all.size());
  for (std::size_t i = config.first; i < all.size() && chosen.size() < limit;) {
    chosen.push_back(std::move(all[i]));
    if (all.size() - i <= config.every_nth) break;
    i += config.every_nth;
  }
  return chosen;
}

}  // namespace

Result<ImageCorrection> ImageCorrection::create(Intrinsics intrinsics, int width, int height,
                                                const RgbdFolderConfig& config) {
  if (config.min_range_m) intrinsics.min_range_m = config.min_range_m;
  if (config.max_range_m) intrinsics.max_range_m = config.max_range_m;
  ImageCorrection correction;
  SACCADE_TRY(correction.camera_, intrinsics.camera(width, height));
  const Distortion distortion = config.distortion.value_or(intrinsics.distortion.value_or(Distortion{}));
  if (!distortion.is_zero()) {
    SACCADE_TRY(correction.undistorter_, Undistorter::create(correction.camera_, distortion));
  }
  SACCADE_TRY(correction.mask_, find_mask(config, correction.camera_));
  return correction;
}

Result<DepthImage> ImageCorrection::apply(DepthImage depth) const {
  SACCADE_CHECK(check_size(camera_, depth.width(), depth.height()));
  if (undistorter_) {
    SACCADE_TRY(depth, undistorter_->undistort(depth));
  }
  if (mask_) SACCADE_CHECK(apply_mask(*mask_, depth));
  clip_to_range(camera_, depth);
  return depth;
}

Result<ColorImage> ImageCorrection::apply(ColorImage color) const {
  SACCADE_CHECK(check_size(camera_, color.width(), color.height()));
  return undistorter_ ? undistorter_->undistort(color) : Result<ColorImage>{std::move(color)};
}

Status RgbdFolderConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "RGB-D folder"}; };
  if (every_nth == 0) return fail("the step between frames must be at least 1");
  if (count && *count == 0) return fail("the number of frames must be at least 1");
  if (!(max_time_difference_s >= 0.0)) return fail("the largest time difference must not be negative");
  if (encoding) SACCADE_CHECK(encoding->validate());
  if (distortion) SACCADE_CHECK(distortion->validate());
  return {};
}

Result<std::unique_ptr<RgbdFolderSource>> open_rgbd_folder(const fs::path& folder, const RgbdFolderConfig& config) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(RgbdListing listing, list_rgbd_folder(folder, config));
  if (listing.frames.size() <= config.first) {
    return Error{Errc::invalid_argument,
                 "there are only " + std::to_string(listing.frames.size()) + " frames, none left after skipping " +
                     std::to_string(config.first),
                 folder.string()};
  }
  SACCADE_CHECK(find_intrinsics(folder, config, listing));
  SACCADE_TRY(const PngSize size, first_size(listing.frames));
  SACCADE_TRY(ImageCorrection correction,
              ImageCorrection::create(*listing.intrinsics, size.width, size.height, config));
  RgbdFolderInfo info{listing.layout,
                      config.encoding.value_or(listing.encoding),
                      listing.intrinsics_from,
                      listing.has_poses,
                      false,
                      false,
                      {}};
  info.has_color = config.read_color && std::any_of(listing.frames.begin(), listing.frames.end(),
                                                    [](const RgbdFrameFiles& f) { return f.color.has_value(); });
  return std::unique_ptr<RgbdFolderSource>{std::make_unique<FolderSource>(
      std::move(correction), std::move(info), selected(std::move(listing.frames), config), config)};
}

}  // namespace saccade
