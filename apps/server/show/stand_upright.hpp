// SPDX-License-Identifier: Apache-2.0
#pragma once
// stand_upright: which way is up in a document, and from where it is looked at first.

#include <filesystem>
#include <span>

#include "saccade/cloud/upright.hpp"
#include "server/show/scene_document.hpp"

namespace saccade::server {

/// find_upright with the hints and with what read_upright_files finds beside `path`. With `may_guess` false, points
/// alone decide nothing: z stays up where there are no hints. Errors of read_upright_files.
[[nodiscard]] Status stand_upright(SceneDocument& document, const std::filesystem::path& path,
                                   std::span<const Eigen::Vector3f> points, UprightHints hints, bool may_guess);

}  // namespace saccade::server
