// SPDX-License-Identifier: Apache-2.0
#pragma once
// A DDS type whose messages stay the bytes that they are sent as: new_raw_type, raw_message, bytes_of.

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <cstddef>
#include <span>
#include <string>

namespace saccade::ros2 {

/// Makes a keyless type by its name. Nothing but the name is compared when readers and writers are matched, and bytes
/// are not looked at: who reads a message checks it. To be given to dds_create_topic_sertype, or to be unreferenced.
[[nodiscard]] ddsi_sertype* new_raw_type(const std::string& dds_name);

/// Makes a message of CDR bytes with their header of four bytes, which are copied.
[[nodiscard]] ddsi_serdata* raw_message(const ddsi_sertype* type, std::span<const std::byte> cdr);

/// CDR bytes of a message of such a type, with their header; they live as long as the message.
[[nodiscard]] std::span<const std::byte> bytes_of(const ddsi_serdata* message);

}  // namespace saccade::ros2
