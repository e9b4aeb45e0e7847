// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/rgbd_folder.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/depth_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/internal/image_mapping.hpp"
#include "saccade/io/frames/internal/rgbd_layout.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

Status check_size(const PinholeCamera& camera, int width, int height) {
  if (width == camera.width && height == camera.height) return {};
  return Error{Errc::size_mismatch,
               "image is " + size_text(width, height) + ", not " + size_text(camera.width, camera.height),
               {}};
}

/// Returns the part of an image that one of several cameras took.
template <class T>
Image<T> strip_of(const Image<T>& image, const CameraStrip& strip) {
  const int width = std::max(image.width() / strip.cameras, 1);
  const int first = std::min(width * strip.camera, image.width() - width);
  Image<T> part{width, image.height()};
  for (int v = 0; v < image.height(); ++v) std::copy_n(image.row(v) + first, width, part.row(v));
  return part;
}

class FolderSource final : public RgbdFolderSource {
 public:
  FolderSource(ImageCorrection correction, ImageRays rays, RgbdFolderInfo info, std::vector<RgbdFrameFiles> frames,
               const RgbdFolderConfig& config)
      : correction_{std::move(correction)},
        rays_{std::move(rays)},
        info_{std::move(info)},
        frames_{std::move(frames)},
        every_nth_{config.every_nth},
        first_{config.first},
        require_poses_{config.require_poses && info_.has_poses},
        read_color_{info_.has_color} {}

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
    std::optional<Intrinsics> own;
    if (files.intrinsics) {
      SACCADE_TRY(own, own_intrinsics(*files.intrinsics));
    }
    auto pose = read_pose(files);
    if (pose) {
      frame.T_world_camera = *pose;
    } else if (require_poses_) {
      return pose.error();
    }
    SACCADE_TRY(DepthImage depth, read_depth(files, own));
    const bool has_color = read_color_ && files.color;
    if (has_color && !rays_.is_bent) {
      SACCADE_TRY(frame.color, read_frame_color(files, own, depth));
    }
    SACCADE_TRY(frame.depth, in_file(correction_.apply(std::move(depth)), *files.depth));
    if (has_color && rays_.is_bent) {
      SACCADE_TRY(const ColorImage color, read_raw_color(files));
      frame.color = seen_from_depth(color, color_rays(own).value_or(*rays_.color), frame.depth, rays_.depth,
                                    rays_.T_color_depth.value_or(Pose::Identity()));
    }
    return frame;
  }

  /// Returns a frame's own intrinsics. Lenses are corrected once for all frames, and must not differ.
  [[nodiscard]] Result<Intrinsics> own_intrinsics(const Result<Intrinsics>& read) const {
    if (!read) return read.error();
    SACCADE_TRY(Intrinsics own, rays_.of_depth(*read));
    const bool is_same_lens = own.distortion.value_or(Distortion{}) == rays_.depth.distortion.value_or(Distortion{}) &&
                              (has_same_rays(own, rays_.depth) || own.distortion.value_or(Distortion{}).is_zero());
    if (is_same_lens) return own;
    return Error{Errc::unsupported, "its lens differs from the first frame's; write the images undistorted", {}};
  }

  [[nodiscard]] static Result<Pose> read_pose(const RgbdFrameFiles& files) {
    if (files.T_world_camera) return *files.T_world_camera;
    if (!files.pose_file) return Error{Errc::not_found, "has no pose, as others here have", {}};
    SACCADE_TRY(const auto poses, read_poses(*files.pose_file));
    if (poses.size() != 1) return Error{Errc::corrupt_data, "one 4x4 matrix expected", files.pose_file->string()};
    return poses.front();
  }

  /// Returns depths with the rays of the source, not yet corrected.
  [[nodiscard]] Result<DepthImage> read_depth(const RgbdFrameFiles& files, const std::optional<Intrinsics>& own) const {
    if (!files.depth) return Error{Errc::not_found, "its depth image is missing", {}};
    DepthUnits scale{info_.encoding, info_.units_from};
    if (own && own->depth_units_per_m && scale.source == UnitsSource::files) {
      scale.encoding.units_per_m = *own->depth_units_per_m;
    }
    SACCADE_TRY(DepthImage depth, read_depth_image(*files.depth, scale));
    if (files.strip) depth = strip_of(depth, *files.strip);
    const Status size = check_size(correction_.camera(), depth.width(), depth.height());
    if (!size) return in_file(size.error(), *files.depth);
    if (!own || has_same_rays(*own, rays_.depth)) return depth;
    return seen_with(depth, *own, rays_.depth, rays_.width, rays_.height);
  }

  /// Returns the colours as they are in the file.
  [[nodiscard]] Result<ColorImage> read_raw_color(const RgbdFrameFiles& files) const {
    SACCADE_TRY(ColorImage color, saccade::read_color(*files.color));
    if (files.strip) color = strip_of(color, *files.strip);
    if (color.width() == rays_.color_width && color.height() == rays_.color_height) return color;
    return Error{Errc::size_mismatch,
                 "image is " + size_text(color.width(), color.height()) + ", not " +
                     size_text(rays_.color_width, rays_.color_height),
                 files.color->string()};
  }

  /// Returns the rays of a frame's colours where they are not those of its depths.
  [[nodiscard]] std::optional<Intrinsics> color_rays(const std::optional<Intrinsics>& own) const {
    if (own && (rays_.color || !has_same_rays(*own, rays_.depth))) return rays_.at_color_size(*own);
    return rays_.color;
  }

  /// Returns colours in the depth camera's place, corrected.
  [[nodiscard]] Result<ColorImage> read_frame_color(const RgbdFrameFiles& files, const std::optional<Intrinsics>& own,
                                                    const DepthImage& depth) const {
    SACCADE_TRY(ColorImage color, read_raw_color(files));
    const std::optional<Intrinsics> from = color_rays(own);
    if (from && rays_.T_color_depth) {
      color = seen_from_depth(color, *from, depth, rays_.depth, *rays_.T_color_depth);
    } else if (from) {
      color = seen_with(color, *from, rays_.depth, rays_.width, rays_.height);
    }
    return in_file(correction_.apply(std::move(color)), *files.color);
  }

  ImageCorrection correction_;
  ImageRays rays_;
  RgbdFolderInfo info_;
  std::vector<RgbdFrameFiles> frames_;
  std::size_t every_nth_;
  std::size_t first_;
  bool require_poses_;
  bool read_color_;
  std::size_t position_{0};
};

constexpr std::size_t kTriedImages{100};

/// Returns the first depth image that can be read.
Result<DepthImage> first_depth(const std::vector<RgbdFrameFiles>& frames, DepthUnits scale) {
  scale.source = scale.source == UnitsSource::layout ? UnitsSource::layout : UnitsSource::given;
  std::optional<Error> first_error;
  std::size_t tried = 0;
  for (const RgbdFrameFiles& frame : frames) {
    if (!frame.depth) continue;
    auto depth = read_depth_image(*frame.depth, scale);
    if (depth) return frame.strip ? strip_of(*depth, *frame.strip) : *std::move(depth);
    if (!first_error) first_error = depth.error();
    if (++tried == kTriedImages) break;
  }
  if (!first_error) return Error{Errc::not_found, "there is no depth frame here", {}};
  return Error{first_error->code, "no depth image here can be read; the first: " + first_error->message,
               first_error->context};
}

/// Finds how colours lie on depths. Colours that cannot be laid on them are left out, with a note.
void find_color_rays(const RgbdListing& listing, const RgbdFolderConfig& config, ImageRays& rays,
                     RgbdFolderInfo& info) {
  std::optional<ColorImage> first;
  std::size_t tried = 0;
  for (const RgbdFrameFiles& frame : listing.frames) {
    if (first || !config.read_color || !frame.color || ++tried > kTriedImages) continue;
    if (auto color = read_color(*frame.color)) {
      first = frame.strip ? strip_of(*color, *frame.strip) : *std::move(color);
    }
  }
  info.has_color = first.has_value() || tried > 0;
  if (!first) return;
  rays.color_width = first->width();
  rays.color_height = first->height();
  const bool is_same_size = rays.color_width == rays.width && rays.color_height == rays.height;
  const std::string sizes = "colour images of " + size_text(rays.color_width, rays.color_height);
  const auto leave_out = [&](const std::string& why) {
    info.has_color = false;
    info.notes.push_back("the " + sizes + " are left out: " + why);
  };
  if (listing.color_intrinsics) {
    rays.color = *listing.color_intrinsics;
    if (rays.color->width && rays.color->height) {
      rays.color = scaled(*rays.color, static_cast<double>(rays.color_width) / *rays.color->width,
                          static_cast<double>(rays.color_height) / *rays.color->height);
    }
    const bool is_in_place = !listing.T_color_depth || listing.T_color_depth->isApprox(Pose::Identity(), 1e-6);
    if (!is_in_place) rays.T_color_depth = listing.T_color_depth;
    if (is_in_place && is_same_size && has_same_rays(*rays.color, rays.depth)) rays.color.reset();
  } else if (!is_same_size) {
    if (!ImageRays::is_same_shape(rays.color_width, rays.color_height, rays.width, rays.height)) {
      return leave_out("they have another shape than the depth images, " + size_text(rays.width, rays.height) +
                       ", and nothing says how they lie on them");
    }
    rays.color = rays.at_color_size(rays.depth);
    if (config.distortion) rays.color->distortion = config.distortion;
    info.notes.push_back("the " + sizes + " are taken for the view of the depth images, " +
                         size_text(rays.width, rays.height) + ", and scaled to it");
  }
  const auto is_lens = [](const std::optional<Distortion>& lens) { return lens && !lens->is_zero(); };
  rays.is_bent = rays.color && (is_lens(rays.color->distortion) ||
                                is_lens(config.distortion ? config.distortion : rays.depth.distortion));
}

Result<std::optional<MaskImage>> find_mask(const RgbdFolderConfig& config, const PinholeCamera& camera) {
  std::vector<PixelPolygon> polygons = config.mask_polygons;
  if (config.mask_file && config.mask_file->extension() == ".json") {
    SACCADE_TRY(const std::string text, read_text_file(*config.mask_file));
    SACCADE_TRY(auto read, in_file(parse_polygons(text), *config.mask_file));
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

/// Images that several cameras share follow one another.
std::vector<fs::path> depth_files_of(const std::vector<RgbdFrameFiles>& frames) {
  std::vector<fs::path> files;
  for (const RgbdFrameFiles& frame : frames) {
    if (frame.depth && (files.empty() || files.back() != *frame.depth)) files.push_back(*frame.depth);
  }
  return files;
}

}  // namespace

Result<ImageCorrection> ImageCorrection::create(Intrinsics intrinsics, int width, int height,
                                                const RgbdFolderConfig& config) {
  if (config.min_range_m) intrinsics.min_range_m = config.min_range_m;
  if (config.max_range_m) intrinsics.max_range_m = config.max_range_m;
  ImageCorrection correction;
  const Distortion distortion = config.distortion.value_or(intrinsics.distortion.value_or(Distortion{}));
  correction.mirror_u_ = intrinsics.fx < 0.0;
  correction.mirror_v_ = intrinsics.fy < 0.0;
  if ((correction.mirror_u_ || correction.mirror_v_) && !distortion.is_zero()) {
    return Error{Errc::unsupported,
                 "a negative focal length (a mirrored image axis) together with lens distortion; write the images "
                 "undistorted",
                 "camera intrinsics"};
  }
  if (correction.mirror_u_) intrinsics.cx = width - 1 - intrinsics.cx;
  if (correction.mirror_v_) intrinsics.cy = height - 1 - intrinsics.cy;
  intrinsics.fx = std::abs(intrinsics.fx);
  intrinsics.fy = std::abs(intrinsics.fy);
  SACCADE_TRY(correction.camera_, intrinsics.camera(width, height));
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
  depth = mirrored(std::move(depth), mirror_u_, mirror_v_);
  clip_to_range(camera_, depth);
  return depth;
}

Result<ColorImage> ImageCorrection::apply(ColorImage color) const {
  SACCADE_CHECK(check_size(camera_, color.width(), color.height()));
  if (undistorter_) return undistorter_->undistort(color);
  return mirrored(std::move(color), mirror_u_, mirror_v_);
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
  if (config.color_intrinsics) {
    listing.color_intrinsics = config.color_intrinsics;
    listing.T_color_depth = config.T_color_depth;
  }
  RgbdFolderInfo info;
  info.layout = listing.layout;
  info.has_poses = listing.has_poses;
  info.intrinsics_from = listing.intrinsics_from;
  info.notes = listing.notes;
  SACCADE_TRY(const DepthUnits scale, find_units(folder, config, listing));
  info.encoding = scale.encoding;
  info.units_from = scale.source;
  SACCADE_TRY(const DepthImage first, first_depth(listing.frames, scale));
  ImageRays rays{first.width(), first.height(), *listing.intrinsics};
  rays.are_color = listing.intrinsics_are_color && !config.intrinsics;
  SACCADE_TRY(rays.depth, rays.of_depth(rays.depth));
  SACCADE_TRY(ImageCorrection correction, ImageCorrection::create(rays.depth, rays.width, rays.height, config));
  find_color_rays(listing, config, rays, info);
  if (rays.depth.fx < 0.0 || rays.depth.fy < 0.0) {
    info.notes.emplace_back("a focal length is negative: the images are mirrored along that axis");
  }
  if (std::string doubt = Intrinsics::doubt(correction.camera()); !doubt.empty())
    info.notes.push_back(std::move(doubt));
  std::vector<RgbdFrameFiles> frames = selected(std::move(listing.frames), config);
  info.depth_files = depth_files_of(frames);
  return std::unique_ptr<RgbdFolderSource>{std::make_unique<FolderSource>(std::move(correction), std::move(rays),
                                                                          std::move(info), std::move(frames), config)};
}

}  // namespace saccade
