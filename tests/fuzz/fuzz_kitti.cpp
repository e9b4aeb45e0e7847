// SPDX-License-Identifier: Apache-2.0
// Feeds the readers of KITTI's scans and SemanticKITTI's labels: every byte of what they accept is used once.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/clouds/internal/kitti_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span{data, size});
  const auto scan = saccade::parse_kitti_scan(bytes);
  if (scan.ok() != (size > 0 && size % 16 == 0)) std::abort();
  if (scan) {
    if (scan->rows * scan->row_bytes() != size || !scan->validate()) std::abort();
    if (saccade::cloud_from_fields(*scan).value().positions_m.size() != scan->rows) std::abort();
  }
  const auto labels = saccade::parse_kitti_labels(bytes);
  if (labels.ok() != (size % 4 == 0) || (labels && labels->size() * 4 != size)) std::abort();
  return 0;
}
