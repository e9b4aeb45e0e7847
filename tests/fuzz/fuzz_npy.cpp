// SPDX-License-Identifier: Apache-2.0
// Feeds the readers of NumPy's arrays and of surfels in one; what they accept is read again from a header of our own.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "saccade/io/clouds/surfel_array.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/npy_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span{data, size});
  if (const auto surfels = saccade::decode_surfels(bytes)) {
    const auto again = saccade::encode_surfels(*surfels);
    if (saccade::encode_surfels(saccade::decode_surfels(again).value()) != again) std::abort();
  }
  const auto column = saccade::parse_npy(bytes);
  if (!column) return 0;
  constexpr std::array<const char*, 8> kTypes{"|i1", "|u1", "<i2", "<u2", "<i4", "<u4", "<i8", "<u8"};
  const std::array<std::size_t, 1> shape{column->bytes.size() / column->row_bytes()};
  std::string again = saccade::npy_header(kTypes.at(static_cast<std::size_t>(column->type)), shape);
  again += saccade::as_text(column->bytes);
  const auto same = saccade::parse_npy(saccade::as_byte_span(again));
  if (!same || *same != *column) std::abort();
  return 0;
}
