// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/overlap.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>
#include <vector>

namespace saccade {

Result<ConsistencyError> consistency_error(std::span<const std::uint32_t> segments,
                                           std::span<const std::uint32_t> truth) {
  if (segments.size() != truth.size()) {
    return Error{Errc::size_mismatch, "as many labels as true labels are needed", "consistency error"};
  }
  std::unordered_map<std::uint32_t, std::size_t> of_segment, of_truth;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> both;  // (segment, truth) of each point
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] == kUnlabelled) continue;
    of_segment[segments[i]] += 1;
    of_truth[truth[i]] += 1;
    both.emplace_back(segments[i], truth[i]);
  }
  std::sort(both.begin(), both.end());
  ConsistencyError error;
  error.points = both.size();
  for (std::size_t i = 0; i < both.size();) {
    const std::size_t first = i;
    while (i < both.size() && both[i] == both[first]) ++i;
    const auto shared = static_cast<double>(i - first);
    const std::size_t larger = std::max(of_segment.at(both[first].first), of_truth.at(both[first].second));
    error.bidirectional += shared * (1.0 - shared / static_cast<double>(larger));
  }
  if (error.points > 0) error.bidirectional /= static_cast<double>(error.points);
  return error;
}

}  // namespace saccade
