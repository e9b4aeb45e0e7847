// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "saccade/io/frames/internal/rgbd_layout.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// Returns the file with intrinsics in a folder that any layout may have.
std::optional<fs::path> intrinsics_file_in(const fs::path& folder) {
  for (const char* name : {"camera-intrinsics.txt", "intrinsics.K.txt", "intrinsics.txt", "camera.json",
                           "camera_primesense.json", "intrinsic.json", "camera_intrinsic.json", "intrinsics.json",
                           "camera_intrinsics.json", "camera_intrinsics.txt", "cam_params.json"}) {
    std::error_code ignored;
    if (fs::is_regular_file(folder / name, ignored)) return folder / name;
  }
  return std::nullopt;
}

/// Returns such a file in the folder or the one above it.
std::optional<fs::path> intrinsics_file(const fs::path& folder) {
  if (auto file = intrinsics_file_in(folder)) return file;
  return intrinsics_file_in(fs::absolute(folder / "x").parent_path().lexically_normal().parent_path());
}

}  // namespace

bool has_intrinsics_file(const fs::path& folder) { return intrinsics_file_in(folder).has_value(); }

Status find_intrinsics(const fs::path& folder, const RgbdFolderConfig& config, RgbdListing& listing) {
  if (config.intrinsics) {
    std::optional<double> units_per_m = listing.intrinsics ? listing.intrinsics->depth_units_per_m : std::nullopt;
    const auto file = listing.intrinsics ? std::nullopt : intrinsics_file(folder);
    if (const auto read = file ? read_intrinsics(*file) : Result<Intrinsics>{Intrinsics{}}; read && !units_per_m) {
      units_per_m = read->depth_units_per_m;
    }
    for (RgbdFrameFiles& frame : listing.frames) {
      if (!units_per_m && frame.intrinsics && *frame.intrinsics) units_per_m = (*frame.intrinsics)->depth_units_per_m;
      frame.intrinsics.reset();
    }
    listing.intrinsics = config.intrinsics;
    listing.intrinsics->depth_units_per_m = units_per_m;
    listing.intrinsics_from = "given";
  }
  for (const RgbdFrameFiles& frame : listing.frames) {
    if (!listing.intrinsics && frame.intrinsics && *frame.intrinsics) listing.intrinsics = **frame.intrinsics;
  }
  if (listing.intrinsics) return {};
  if (listing.frames.front().intrinsics) return listing.frames.front().intrinsics->error();
  if (const auto file = intrinsics_file(folder)) {
    SACCADE_TRY(listing.intrinsics, read_intrinsics(*file));
    listing.intrinsics_from = file->string();
    return {};
  }
  return Error{Errc::not_found,
               "no camera intrinsics here; pass --intrinsics fx,fy,cx,cy or add a camera-intrinsics.txt with the 3x3 "
               "matrix",
               folder.string()};
}

Result<DepthUnits> find_units(const fs::path& folder, const RgbdFolderConfig& config, const RgbdListing& listing) {
  if (config.encoding) return DepthUnits{*config.encoding, UnitsSource::given};
  if (listing.intrinsics->depth_units_per_m) {
    return DepthUnits{{*listing.intrinsics->depth_units_per_m, false}, UnitsSource::files};
  }
  if (listing.scale) return *listing.scale;
  return Error{Errc::invalid_argument,
               "nothing in this folder says how many depth samples make a metre; pass --depth-scale N (6553.5 in the "
               "Replica of NICE-SLAM, 1000 for millimetres)",
               folder.string()};
}

}  // namespace saccade
