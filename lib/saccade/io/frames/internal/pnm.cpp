// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/internal/sample_image.hpp"

namespace saccade {
namespace {

/// Reader of a PGM or PPM: words of the header, then samples.
class PnmReader {
 public:
  explicit PnmReader(std::string_view file) : file_{file} {}

  [[nodiscard]] Result<SampleImage> read() {
    const char kind = file_[1];
    at_ = 2;
    SACCADE_TRY(const std::size_t width, number("the width"));
    SACCADE_TRY(const std::size_t height, number("the height"));
    SACCADE_TRY(max_, number("the largest value"));
    if (max_ < 1 || max_ > 65535) return fail("the largest value is not within 1 and 65535");
    SACCADE_CHECK(check_edges(width, height));
    SampleImage image;
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.channels = kind == '3' || kind == '6' ? 3 : 1;
    image.kind = max_ > 255 ? SampleKind::whole16 : SampleKind::whole8;
    const std::size_t samples = width * height * static_cast<std::size_t>(image.channels);
    if (samples > 2 * (file_.size() - at_)) return fail("too few bytes for its size");
    image.values.reserve(samples);
    SACCADE_CHECK(kind == '2' || kind == '3' ? read_plain(samples, image.values) : read_binary(samples, image.values));
    return image;
  }

 private:
  [[nodiscard]] Error fail(std::string what) const {
    return {Errc::corrupt_data, "corrupt or truncated PGM or PPM: " + std::move(what), "byte " + std::to_string(at_)};
  }

  void skip_blanks() {
    while (at_ < file_.size()) {
      if (file_[at_] == '#') {
        at_ = std::min(file_.find('\n', at_), file_.size());
      } else if (std::string_view{" \t\r\n"}.find(file_[at_]) != std::string_view::npos) {
        ++at_;
      } else {
        return;
      }
    }
  }

  [[nodiscard]] Result<std::size_t> number(const char* what) {
    skip_blanks();
    const std::size_t end = std::min(file_.find_first_not_of("0123456789", at_), file_.size());
    const auto value = parse_integer<std::uint32_t>(file_.substr(at_, end - at_));
    if (!value) return fail(std::string{what} + " is not a number");
    at_ = end;
    return std::size_t{*value};
  }

  [[nodiscard]] Status add(std::size_t value, std::vector<float>& values) const {
    if (value > max_) return fail("a sample beyond the largest value");
    values.push_back(static_cast<float>(value));
    return {};
  }

  [[nodiscard]] Status read_plain(std::size_t samples, std::vector<float>& values) {
    for (std::size_t i = 0; i < samples; ++i) {
      SACCADE_TRY(const std::size_t value, number("a sample"));
      SACCADE_CHECK(add(value, values));
    }
    skip_blanks();
    return at_ == file_.size() ? Status{} : Status{fail("bytes after its end")};
  }

  [[nodiscard]] Status read_binary(std::size_t samples, std::vector<float>& values) {
    ++at_;  // one blank ends the header
    const std::size_t width = max_ > 255 ? 2 : 1;
    const std::size_t left = file_.size() - std::min(at_, file_.size());
    if (left != samples * width) return fail(left < samples * width ? "it ends too early" : "bytes after its end");
    for (std::size_t i = 0; i < samples; ++i) {
      std::size_t value = 0;
      for (std::size_t b = 0; b < width; ++b) value = value << 8U | static_cast<unsigned char>(file_[at_++]);
      SACCADE_CHECK(add(value, values));
    }
    return {};
  }

  std::string_view file_;
  std::size_t at_{0};
  std::size_t max_{0};
};

}  // namespace

bool is_pnm(std::span<const std::byte> file) {
  const std::string_view text = as_text(file);
  return text.size() > 2 && text[0] == 'P' && std::string_view{"2356"}.find(text[1]) != std::string_view::npos;
}

Result<SampleImage> decode_pnm(std::span<const std::byte> file) {
  SACCADE_EXPECTS(is_pnm(file));
  return PnmReader{as_text(file)}.read();
}

Status check_edges(std::size_t width, std::size_t height) {
  if (width == 0 || height == 0) return Error{Errc::corrupt_data, "an image without pixels", {}};
  if (width <= kMaxImageEdge && height <= kMaxImageEdge) return {};
  return Error{Errc::unsupported,
               "an image of " + std::to_string(width) + "x" + std::to_string(height) + " pixels is larger than " +
                   std::to_string(kMaxImageEdge) + " pixels a side",
               {}};
}

}  // namespace saccade
