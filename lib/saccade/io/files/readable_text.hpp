// SPDX-License-Identifier: Apache-2.0
#pragma once
// Text from elsewhere, made fit for one line of a message.

#include <cstddef>
#include <string>
#include <string_view>

namespace saccade {

/// The first max_bytes of a text that may be anything: control characters become blanks, bytes that are no UTF-8 become
/// '?', and "..." stands where it was cut. Always valid UTF-8.
[[nodiscard]] std::string readable(std::string_view text, std::size_t max_bytes);

/// The last lines of a text, at most three, joined by " | ", each made readable; empty when there is none.
[[nodiscard]] std::string last_lines(std::string_view text);

}  // namespace saccade
