// SPDX-License-Identifier: Apache-2.0
#pragma once
// Labels that are known before annotation begins, from a file.

#include <filesystem>
#include <string_view>
#include <vector>

#include "saccade/annotate/label_table.hpp"

namespace saccade {

/// YAML or JSON: `labels: [{number, name, class, instance, color}]`. Only the number must be there; a colour is
/// "#rrggbb" or [red, green, blue] in 0 to 255, and generated where it is left out.
/// @return corrupt_data with line and column.
[[nodiscard]] Result<std::vector<NumberedLabel>> parse_label_presets(std::string_view text);
/// The same; not_found and io_failure.
[[nodiscard]] Result<std::vector<NumberedLabel>> read_label_presets(const std::filesystem::path& path);

}  // namespace saccade
