// SPDX-License-Identifier: Apache-2.0
#pragma once
// Checks of options that are lengths and places, metres.

#include <string>

#include "saccade/core/region.hpp"

namespace saccade::cli {

/// Requires a length from a micrometre to kMaxLength_m, metres. Throws a usage error of the option.
void require_length(double value_m, const std::string& option);
/// Requires a box within kMaxLength_m of the origin. Throws a usage error of the option.
void require_near(const Box& box, const std::string& option);

}  // namespace saccade::cli
