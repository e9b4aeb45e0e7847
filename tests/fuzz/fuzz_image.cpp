// SPDX-License-Identifier: Apache-2.0
// Feeds the image readers: the input as it is, and as the header fields and rows of a PNG whose checksums are right.
// Whatever PNG is accepted must come back the same after it was written.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "support/png_maker.hpp"

namespace {

void check_png(std::span<const std::byte> file) {
  const auto pixels = saccade::decode_png(file);
  if (!pixels || pixels->bytes.size() > 100000) return;
  const auto written = saccade::encode_png(*pixels);
  if (!written) std::abort();
  const auto again = saccade::decode_png(*written);
  if (!again || again->bytes != pixels->bytes) std::abort();
}

void check_all(std::span<const std::byte> file) {
  check_png(file);
  static_cast<void>(saccade::decode_png16(file));
  static_cast<void>(saccade::decode_color(file));
  static_cast<void>(saccade::decode_mask(file));
  static_cast<void>(saccade::png_size(file));
}

/// A PNG out of free bytes: size, kind of pixels, a palette, and rows.
std::string png_of(std::string_view input) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(input[i]); };
  saccade::test::PngSpec spec;
  spec.width = byte(0) + 256U * (byte(1) & 1U);
  spec.height = byte(2);
  spec.bit_depth = byte(3);
  spec.color_type = byte(4);
  spec.interlaced = byte(5) == 1;
  input.remove_prefix(6);
  spec.palette = input.substr(0, 12);
  spec.rows = input.substr(std::min<std::size_t>(12, input.size()));
  return saccade::test::make_png(spec);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input{reinterpret_cast<const char*>(data), size};
  check_all(saccade::as_byte_span(input));
  if (size < 8) return 0;
  const std::string png = png_of(input);
  check_all(saccade::as_byte_span(png));
  return 0;
}
