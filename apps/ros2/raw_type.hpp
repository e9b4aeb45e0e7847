// SPDX-License-Identifier: Apache-2.0
#pragma once
// DDS type whose messages remain serialised bytes: new_raw_type, raw_message, bytes_of.

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <cstddef>
#include <span>
#include <string>

namespace saccade::ros2 {

/// Makes a keyless type by its name. Matching of readers and writers compares only the name, and bytes are not checked:
/// the reader of a message checks it. Pass it to dds_create_topic_sertype, or unreference it.
[[nodiscard]] ddsi_sertype* new_raw_type(const std::string& dds_name);

/// Makes a message from a copy of CDR bytes with their header of four bytes.
[[nodiscard]] ddsi_serdata* raw_message(const ddsi_sertype* type, std::span<const std::byte> cdr);

/// Returns the CDR bytes of such a message, with their header; they live as long as the message.
[[nodiscard]] std::span<const std::byte> bytes_of(const ddsi_serdata* message);

}  // namespace saccade::ros2
