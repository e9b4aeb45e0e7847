// SPDX-License-Identifier: Apache-2.0
// Feeds messages of ROS 1 and ROS 2: the first byte is the type and the layout. What is read is written and read again.
#include <cstdint>
#include <cstdlib>

#include "saccade/io/messages/messages.hpp"

namespace {

namespace messages = saccade::messages;

template <class Message>
void read(messages::Wire wire, std::span<const std::byte> bytes) {
  const auto message = messages::read_message<Message>(wire, bytes);
  if (!message) return;
  const auto written = messages::write_message(wire, *message);
  const auto again = messages::read_message<Message>(wire, written);
  if (!again || messages::write_message(wire, *again) != written) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const messages::Wire wire = (data[0] & 1) == 0 ? messages::Wire::ros1 : messages::Wire::cdr;
  const auto bytes = std::as_bytes(std::span{data + 1, size - 1});
  switch (data[0] >> 1) {
    case 0: read<messages::Image>(wire, bytes); break;
    case 1: read<messages::CameraInfo>(wire, bytes); break;
    case 2: read<messages::TFMessage>(wire, bytes); break;
    case 3: read<messages::PointCloud2>(wire, bytes); break;
    case 4: read<messages::JointState>(wire, bytes); break;
    case 5: read<messages::JointTrajectory>(wire, bytes); break;
    case 6: read<messages::MarkerArray>(wire, bytes); break;
    case 7: read<messages::CompressedImage>(wire, bytes); break;
    default: read<messages::PoseStamped>(wire, bytes); break;
  }
  return 0;
}
