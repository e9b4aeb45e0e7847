// SPDX-License-Identifier: Apache-2.0
#pragma once
// asked_action: the action that a page requests on its open cloud.

#include <nlohmann/json.hpp>
#include <span>

#include "saccade/annotate/annotation.hpp"
#include "saccade/annotate/carried_labels.hpp"
#include "saccade/core/executor.hpp"

namespace saccade::server {

/// Cloud that an action is for.
struct AskedOn {
  std::span<const Eigen::Vector3f> positions_m;
  std::span<const std::uint32_t> segments;  ///< segment of each point; empty: there are none
  const Annotation& annotation;
  const CarrySource* before{nullptr};  ///< cloud whose labels are carried; nullptr: none is named
};

/// @param head  head of the question: `action`, as in a line of an annotation script without `client`, `trees` and
/// `hidden`.
/// @return invalid_argument for an action on another cloud, for an invalid action, one that takes too much work
/// (docs/reference/protocol.md), and as resolve_action. It may still not fit the annotation (Annotation::validate).
[[nodiscard]] Result<AnnotationAction> asked_action(const nlohmann::json& head, const AskedOn& subject,
                                                    std::uint64_t client, const Executor& executor);

}  // namespace saccade::server
