// SPDX-License-Identifier: Apache-2.0
#pragma once
// Actions of an annotation as bytes in the records of a journal: append_action, read_action.

#include <cstddef>
#include <span>
#include <vector>

#include "saccade/annotate/action.hpp"

namespace saccade {

void append_action(const AnnotationAction& action, std::vector<std::byte>& out);

/// Reads an action back. Answers corrupt_data unless the bytes are exactly one action. Does not check what it names
/// (check_action).
[[nodiscard]] Result<AnnotationAction> read_action(std::span<const std::byte> bytes);

}  // namespace saccade
