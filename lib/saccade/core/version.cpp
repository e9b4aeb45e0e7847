// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/version.hpp"

namespace saccade {

std::string_view version() { return SACCADE_VERSION; }

}  // namespace saccade
