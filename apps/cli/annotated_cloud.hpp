// SPDX-License-Identifier: Apache-2.0
#pragma once
// The files that labels of a cloud are written to.

#include <filesystem>

#include "saccade/core/executor.hpp"
#include "server/annotate/annotated_cloud.hpp"

namespace saccade::cli {

using server::labelled_points;
using server::LabelledPoints;
using server::LabelRow;
using server::load_cloud;
using server::LoadedCloud;

/// Where labels go; empty: nowhere.
struct LabelFiles {
  std::filesystem::path out;
  std::filesystem::path names;    ///< .txt or .json
  std::filesystem::path picture;  ///< .png
  std::filesystem::path margins;  ///< .pcd or .ply
  std::filesystem::path boxes;    ///< .json or .txt
};

[[nodiscard]] Status write_label_files(const LabelFiles& files, const LoadedCloud& cloud, const LabelledPoints& labels,
                                       const Executor& executor);

}  // namespace saccade::cli
