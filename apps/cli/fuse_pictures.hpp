// SPDX-License-Identifier: Apache-2.0
#pragma once
// The pictures of a fusion run.

#include <filesystem>

#include "fuse_frames.hpp"
#include "fuse_measures.hpp"
#include "run_folder.hpp"

namespace saccade::cli {

/// fusion-first.png, fusion-middle.png, fusion-last.png: a measured depth image, the map as seen from its pose, and
/// their difference. ternary.png: occupied, empty and unknown, seen from where the first frame was taken.
[[nodiscard]] Status write_fuse_pictures(const RunFolder& out, const TsdfSnapshot& map, const PinholeCamera& camera,
                                         const RgbdFolderSource& source, const RgbdFolderConfig& config,
                                         const FuseRecord& record, const Executor& executor, ProgressBar& progress);

}  // namespace saccade::cli
