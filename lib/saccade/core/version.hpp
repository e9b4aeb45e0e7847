// SPDX-License-Identifier: Apache-2.0
#pragma once
// SACCADE_VERSION and version(): the version of the headers, and that of the library that is linked.

#include <string_view>

// A test holds these to project() of the top CMakeLists.txt.
#define SACCADE_VERSION_MAJOR 0
#define SACCADE_VERSION_MINOR 2
#define SACCADE_VERSION_PATCH 0
#define SACCADE_VERSION "0.2.0"

namespace saccade {

/// Returns the version of the library that is linked, "0.1.0". A program whose headers are of the same version finds it
/// equal to SACCADE_VERSION.
[[nodiscard]] std::string_view version();

}  // namespace saccade
