// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace saccade::reproduce {

/// Where the thesis' data set of recorded hands (§2.4.2) is published.
constexpr const char* kHandDataAddress{"https://github.com/RMonica/hand-polhemus-dataset"};

}  // namespace saccade::reproduce
