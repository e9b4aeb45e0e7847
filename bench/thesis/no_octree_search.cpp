// SPDX-License-Identifier: Apache-2.0
// octree_search where PCL was not found.
#include "thesis/ray_search.hpp"

namespace saccade::thesis {

Result<std::unique_ptr<RaySearch>> octree_search(const StopVolume&) {
  return Error{Errc::unavailable, "not built (needs libpcl-dev)", "PCL"};
}

}  // namespace saccade::thesis
