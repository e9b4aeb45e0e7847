// SPDX-License-Identifier: Apache-2.0
#pragma once
// RefusalCounts as JSON and back.

#include <nlohmann/json.hpp>

#include "saccade/core/result.hpp"
#include "saccade/robot/refusal.hpp"

namespace saccade {

/// {"no_ik": 3, …}: how many by reason; those that did not occur are left out.
[[nodiscard]] nlohmann::json refusals_to_json(const RefusalCounts& refused);
/// The inverse; reasons that are not known are passed over. corrupt_data for anything else.
[[nodiscard]] Result<RefusalCounts> refusals_from_json(const nlohmann::json& value);

}  // namespace saccade
