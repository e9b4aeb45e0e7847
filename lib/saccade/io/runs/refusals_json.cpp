// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/runs/run_json.hpp"

#include <string>

namespace saccade {

nlohmann::json refusals_to_json(const RefusalCounts& refused) {
  nlohmann::json counts = nlohmann::json::object();
  for (const Refusal refusal : kRefusalNames.values) {
    if (refused.of(refusal) > 0) counts[std::string{to_string(refusal)}] = refused.of(refusal);
  }
  return counts;
}

Result<RefusalCounts> refusals_from_json(const nlohmann::json& value) {
  const Error wrong{Errc::corrupt_data, "refusals must be an object of counts", {}};
  if (!value.is_object()) return wrong;
  RefusalCounts counts;
  for (const Refusal refusal : kRefusalNames.values) {
    const auto entry = value.find(std::string{to_string(refusal)});
    if (entry == value.end()) continue;
    if (!entry->is_number_unsigned()) return wrong;
    counts.add(refusal, entry->get<std::size_t>());
  }
  return counts;
}

}  // namespace saccade
