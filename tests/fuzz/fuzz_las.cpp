// SPDX-License-Identifier: Apache-2.0
// Feeds the readers of LAS and of clouds in NumPy's arrays: tables that they accept fit together and become clouds.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/clouds/internal/npy_cloud.hpp"

namespace {

void check(const saccade::ColumnTable& table) {
  if (!table.validate()) std::abort();
  const auto cloud = saccade::cloud_from_fields(table);
  if (!cloud || cloud->positions_m.size() != table.rows) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span{data, size});
  if (const auto las = saccade::parse_las({bytes.begin(), bytes.end()})) check(las->table);
  if (const auto table = saccade::parse_npy_cloud(bytes)) check(*table);
  return 0;
}
