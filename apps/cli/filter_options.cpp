// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <set>

#include "declaration.hpp"
#include "filter.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> kDepthSuffixes{".png", ".pgm", ".tif", ".tiff", ".npy", ".exr"};
/// Parts of the names of images that lie beside depth images, as `scene sequence` and data sets name them.
constexpr std::array<std::string_view, 5> kOtherImages{".label.", ".color.", ".colour.", ".rgb.", "mask"};

void declare_steps(Options& options, DepthFilterConfig& filter) {
  options.choice("--method", filter.method, kDepthFilterMethodNames,
                 "surface keeps the points that lie on a surface; thesis removes every point that may be wrong");
  options.value("--baseline", filter.baseline_m, "METRES", "distance from the camera to the infrared emitter, metres");
  options.choice(
      "--emitter", filter.emitter_side, kEmitterSideNames,
      "the emitter's side in the image; shadows fall to the other side (right where the driver mirrors images)");
  options.angle("--veil-angle", filter.veil_angle_rad,
                "a point with a neighbour so nearly behind or before it is a veil point, degrees");
  constexpr std::array<std::string_view, 2> kSteps{"shadow", "veil"};
  const auto only = [&filter](const std::string& step) {
    filter.remove_shadow_points = step == "shadow";
    filter.remove_veil_points = step == "veil";
  };
  add_words(options.group(), "--only", kSteps, only, "do only one of the two steps");
}

bool is_depth_name(const fs::path& file) {
  const std::string suffix = file.extension().string();
  return std::find(kDepthSuffixes.begin(), kDepthSuffixes.end(), suffix) != kDepthSuffixes.end();
}

bool is_other_image(const fs::path& file) {
  const std::string name = file.filename().string();
  return std::any_of(kOtherImages.begin(), kOtherImages.end(),
                     [&name](std::string_view part) { return name.find(part) != std::string::npos; });
}

/// Opens a folder of RGB-D frames, if it is one. Without intrinsics it is one all the same.
/// @return the source, and whether it knows the camera; null for any other folder.
std::pair<std::unique_ptr<RgbdFolderSource>, bool> known_folder(const fs::path& folder) {
  RgbdFolderConfig config;
  config.read_color = false;
  if (auto opened = open_rgbd_folder(folder, config)) return {std::move(*opened), true};
  config.intrinsics.emplace();
  config.intrinsics->fx = config.intrinsics->fy = 1.0;
  if (auto opened = open_rgbd_folder(folder, config)) return {std::move(*opened), false};
  return {nullptr, false};
}

void add_known_frames(const fs::path& folder, const RgbdFolderSource& source, bool takes_camera, FilterInput& input) {
  const RgbdFolderInfo& info = source.info();
  for (const fs::path& file : info.depth_files) {
    InputFrame frame{file, true, {}, info.encoding};
    if (takes_camera) frame.camera = source.camera();
    input.frames.push_back(std::move(frame));
  }
  std::string note = folder.string() + ": is a folder of RGB-D frames (layout " +
                     std::string{kRgbdLayoutWords.of(info.layout)} + "); its " +
                     std::to_string(info.depth_files.size()) + " depth images are taken";
  if (takes_camera) note += ", with the camera of " + info.intrinsics_from;
  input.notes.push_back(std::move(note));
}

/// Adds the depth images of a folder in no known layout, by name.
Status add_images(const fs::path& folder, FilterInput& input) {
  std::error_code code;
  std::error_code ignored;
  std::set<fs::path> files;
  std::set<fs::path> others;
  for (const fs::directory_entry& entry : fs::directory_iterator{folder, code}) {
    if (!is_depth_name(entry.path()) || fs::is_directory(entry.path(), ignored)) continue;
    (is_other_image(entry.path()) ? others : files).insert(entry.path());
  }
  if (code) return Error{Errc::io_failure, "cannot be listed: " + code.message(), folder.string()};
  const std::string beside = others.empty() ? ""
                                            : others.begin()->filename().string() + " and such are labels, colours " +
                                                  "or masks by their names";
  if (files.empty()) {
    return Error{Errc::not_found,
                 "there are no depth images in this folder: no PNG, PGM, TIFF, NPY or EXR" +
                     (beside.empty() ? "" : " but for others: " + beside),
                 folder.string()};
  }
  for (const fs::path& file : files) input.frames.push_back({file, true, {}, {}});
  if (!others.empty()) {
    input.notes.push_back(folder.string() + ": " + std::to_string(others.size()) + " images are left out: " + beside +
                          "; name them to filter them all the same");
  }
  return {};
}

}  // namespace

Result<FilterInput> filter_input(const FilterOptions& options) {
  const bool names_camera = options.camera_options.preset || options.camera_options.intrinsics;
  std::error_code ignored;
  FilterInput input;
  for (const fs::path& path : options.frames) {
    if (!fs::is_directory(path, ignored)) {
      input.frames.push_back({path, false, {}, {}});
      continue;
    }
    const auto [source, has_camera] = known_folder(path);
    if (source && !source->info().depth_files.empty()) {
      add_known_frames(path, *source, has_camera && !names_camera, input);
    } else {
      SACCADE_CHECK(add_images(path, input));
    }
  }
  return input;
}

void declare_filter(Options& declared, FilterOptions& options) {
  declared
      .value("frames", options.frames, "FRAMES...",
             "depth images (16-bit PNG, PGM, TIFF, NPY or EXR), or folders of them")
      .required();
  declared.folder(
      {.help =
           "folder for the filtered frames, PNG files of the same names, filter.json, and pictures before and after",
       .files = {kFilterFile},
       .document = kFilterFile,
       .required = true,
       .opened_by_command = true});
  add_camera_options(declared.group(), options.camera_options, false);
  declared.value("--depth-scale", options.depth_scale, "UNITS",
                 "depth samples per metre, also of the results (default: 1000; floats are metres)");
  declare_steps(declared, options.filter);
  declared.value("--pictures", options.pictures, "N", "draw pictures of the first N frames").whole_number();
  declared.flag("--no-pictures{false}", options.write_pictures, "draw no pictures");
}

void check_filter_options(FilterOptions& options) {
  options.camera = options.camera_options.camera(camera_preset("kinect-v2").value());
  require_ok(options.camera.validate(), "the camera");
  if (options.depth_scale) options.encoding.units_per_m = *options.depth_scale;
  require_positive(options.encoding.units_per_m, "--depth-scale");
  require_ok(options.filter.validate(), "--baseline, --veil-angle");
}

}  // namespace saccade::cli
