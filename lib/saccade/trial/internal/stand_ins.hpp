// SPDX-License-Identifier: Apache-2.0
#pragma once
// stand_in: objects made by rule, in place of published ones that cannot be shipped.

#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/map/mesh.hpp"

namespace saccade {

/// Returns the closed bodies of a stand-in, which may overlap, in any unit, z up:
/// - "figure", in place of the Armadillo: a standing body with head, limbs, ears and a tail;
/// - "hare", in place of the Bunny: a sitting body with long ears;
/// - "coil", in place of the Dragon: a body wound twice about itself;
/// - "jug": a vessel with a handle, whose inside is surface, too.
/// invalid_argument for another name.
[[nodiscard]] Result<std::vector<TriangleMesh>> stand_in(std::string_view name);

}  // namespace saccade
