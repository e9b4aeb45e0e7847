// SPDX-License-Identifier: Apache-2.0
#pragma once
// Actions of an annotation as bytes, as the records of a journal hold them: append_action, read_action.

#include <cstddef>
#include <span>
#include <vector>

#include "saccade/annotate/action.hpp"

namespace saccade {

void append_action(const AnnotationAction& action, std::vector<std::byte>& out);

/// The inverse. corrupt_data unless the bytes are one action, no more and no fewer. What it names is not looked at
/// (check_action).
[[nodiscard]] Result<AnnotationAction> read_action(std::span<const std::byte> bytes);

}  // namespace saccade
