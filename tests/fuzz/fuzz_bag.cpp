// SPDX-License-Identifier: Apache-2.0
// Feeds bags of ROS 1 and MCAP files, and the frames and hands in them.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <string>

#include "saccade/io/bags/bags.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const int file = ::memfd_create("bag", 0);
  if (file < 0 || ::write(file, data, size) != static_cast<::ssize_t>(size)) std::abort();
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  if (const auto bag = saccade::Bag::open(path)) {
    std::vector<std::uint32_t> topics((*bag)->topics().size());
    std::iota(topics.begin(), topics.end(), 0U);
    if (const auto entries = (*bag)->entries(topics)) {
      for (const saccade::BagEntry& entry : *entries) static_cast<void>((*bag)->read(entry));
    }
  }
  if (const auto frames = saccade::open_bag_frames(path, {})) {
    for (std::size_t i = 0; i < (*frames)->size().value_or(0); ++i) static_cast<void>((*frames)->at(i));
  }
  static_cast<void>(saccade::read_bag_hand(path, "", ""));
  ::close(file);
  return 0;
}
