// SPDX-License-Identifier: Apache-2.0
#pragma once
// md5_of: MD5 of bytes, the checksum that collections of meshes publish. It tells one file from another; it is no
// protection against forgeries.

#include <cstddef>
#include <span>
#include <string>

namespace saccade {

/// Returns the digest of RFC 1321 as 32 hexadecimal digits. O(bytes).
[[nodiscard]] std::string md5_of(std::span<const std::byte> bytes);

}  // namespace saccade
