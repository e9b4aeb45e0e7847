// SPDX-License-Identifier: Apache-2.0
#pragma once
// label_file: labels of a cloud as a file for the browser to keep.

#include <string>

#include "server/annotate/annotated_cloud.hpp"
#include "server/service.hpp"

namespace saccade::server {

/// @param format  pcd, ply, txt, csv, label, npy, names.txt or names.json.
/// @return invalid_argument for another one; errors of write_labels. It is written in a folder of its own among
/// temporary files, which is gone afterwards.
[[nodiscard]] Result<HttpAnswer> label_file(const LoadedCloud& cloud, const LabelledPoints& labels,
                                            const std::string& format);

}  // namespace saccade::server
