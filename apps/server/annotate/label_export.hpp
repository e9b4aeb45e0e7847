// SPDX-License-Identifier: Apache-2.0
#pragma once
// label_file: labels of a cloud as a file to download.

#include <string>

#include "server/annotate/annotated_cloud.hpp"
#include "server/service.hpp"

namespace saccade::server {

/// @param format  pcd, ply, txt, csv, label, npy, names.txt, names.json, boxes.json or boxes.txt.
/// @return invalid_argument for another format; errors of write_labels. The file is written in its own temporary
/// folder, which is removed afterwards.
[[nodiscard]] Result<HttpAnswer> label_file(const LoadedCloud& cloud, const LabelledPoints& labels,
                                            const std::string& format);

}  // namespace saccade::server
