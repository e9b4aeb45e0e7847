// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/image_io.hpp"

#include <png.h>

#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>
#include <string>

namespace saccade {
namespace {

constexpr std::size_t kSignatureBytes{8};
/// Deflate cannot expand data more than about 1032-fold.
constexpr std::uint64_t kMaxExpansion{1040};
constexpr png_alloc_size_t kMaxChunkBytes{
    1U << 23U};  // limit of chunks without pixels; libpng bounds the others by the size
constexpr int kCompressionLevel{6};

// libpng reports by longjmp. Every function that calls setjmp therefore holds only trivial values, as do the callbacks;
// owners of memory live in PngReader and PngWriter, outside of all jumps.

/// Keeps the first complaint of libpng; allocates nothing.
struct PngErrorHandler {
  std::array<char, 160> text{};

  void keep(const char* message) {
    if (text[0] == '\0') std::strncpy(text.data(), message, text.size() - 1);
  }
};

/// Handles errors and warnings alike: in the chunks read here, a warning of libpng means damage.
[[noreturn]] void on_complaint(png_structp png, png_const_charp message) {
  static_cast<PngErrorHandler*>(png_get_error_ptr(png))->keep(message);
  png_longjmp(png, 1);
}

class PngReader {
 public:
  explicit PngReader(std::span<const std::byte> file) : file_{file} {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &complaint_, on_complaint, on_complaint);
    if (png_ == nullptr) throw std::bad_alloc{};
    info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc{};
    }
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  /// Reads everything before the pixels.
  [[nodiscard]] Result<PngSize> read_size() {
    if (file_.size() < kSignatureBytes ||
        png_sig_cmp(reinterpret_cast<png_const_bytep>(file_.data()), 0, kSignatureBytes) != 0) {
      return Error{Errc::corrupt_data, "not a PNG file", "byte 0"};
    }
    if (!read_info()) {
      if (width() > kMaxImageEdge || height() > kMaxImageEdge) {
        return Error{Errc::unsupported,
                     "PNG of " + std::to_string(width()) + "x" + std::to_string(height()) + " pixels is larger than " +
                         std::to_string(kMaxImageEdge) + " pixels a side",
                     {}};
      }
      return corrupt(complaint_.text.data());
    }
    return PngSize{static_cast<int>(width()), static_cast<int>(height())};
  }

  /// Reads the rest, after read_size(), without applying a palette.
  [[nodiscard]] Result<PngPixels> read_pixels() {
    const std::uint64_t least_bytes = std::uint64_t{png_get_rowbytes(png_, info_)} * height();
    if (least_bytes > kMaxExpansion * file_.size()) return corrupt("too few bytes for its size");
    if (!start_pixels()) return corrupt(complaint_.text.data());
    PngPixels out{static_cast<int>(width()),
                  static_cast<int>(height()),
                  png_get_channels(png_, info_),
                  png_get_bit_depth(png_, info_) == 16 ? 16 : 8,
                  {}};
    const std::size_t row_bytes = png_get_rowbytes(png_, info_);
    out.bytes.resize(row_bytes * height());
    if (!read_rows(out.bytes.data(), row_bytes)) return corrupt(complaint_.text.data());
    if (offset_ != file_.size()) return corrupt("bytes after its end");
    if (png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE) return with_palette(out);
    return out;
  }

 private:
  static void read_bytes(png_structp png, png_bytep out, std::size_t count) {
    auto* self = static_cast<PngReader*>(png_get_io_ptr(png));
    if (count > self->file_.size() - self->offset_) png_error(png, "the file ends too early");
    std::memcpy(out, self->file_.data() + self->offset_, count);
    self->offset_ += count;
  }

  [[nodiscard]] std::uint32_t width() const { return png_get_image_width(png_, info_); }
  [[nodiscard]] std::uint32_t height() const { return png_get_image_height(png_, info_); }
  [[nodiscard]] Error corrupt(const char* what) const {
    return {Errc::corrupt_data, std::string{"corrupt or truncated PNG: "} + what, "byte " + std::to_string(offset_)};
  }

  [[nodiscard]] bool read_info() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_read_fn(png_, this, read_bytes);
    png_set_benign_errors(png_, 0);
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_user_limits(png_, kMaxImageEdge, kMaxImageEdge);
    png_set_chunk_malloc_max(png_, kMaxChunkBytes);
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);  // ancillary ones: checksum only
    png_read_info(png_, info_);
    return true;
  }

  [[nodiscard]] bool start_pixels() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_packing(png_);
    if (png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY) png_set_expand_gray_1_2_4_to_8(png_);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  [[nodiscard]] bool read_rows(png_bytep pixels, std::size_t row_bytes) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    for (int pass = 0; pass < passes_; ++pass) {
      for (std::size_t v = 0; v < height(); ++v) png_read_row(png_, pixels + v * row_bytes, nullptr);
    }
    png_read_end(png_, nullptr);
    return true;
  }

  /// Applies the palette; libpng would turn indices beyond it into black.
  [[nodiscard]] Result<PngPixels> with_palette(const PngPixels& indices) const {
    png_colorp colors = nullptr;
    int count = 0;
    png_get_PLTE(png_, info_, &colors, &count);
    PngPixels out{indices.width, indices.height, 3, 8, {}};
    out.bytes.reserve(indices.bytes.size() * 3);
    for (const std::uint8_t index : indices.bytes) {
      if (index >= count) return corrupt("a pixel outside of the palette");
      out.bytes.insert(out.bytes.end(), {colors[index].red, colors[index].green, colors[index].blue});
    }
    return out;
  }

  std::span<const std::byte> file_;
  std::size_t offset_{0};
  int passes_{1};
  PngErrorHandler complaint_;
  png_structp png_{nullptr};
  png_infop info_{nullptr};
};

class PngWriter {
 public:
  PngWriter() {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &complaint_, on_complaint, on_complaint);
    if (png_ == nullptr) throw std::bad_alloc{};
    info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_write_struct(&png_, nullptr);
      throw std::bad_alloc{};
    }
  }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }

  [[nodiscard]] Result<std::vector<std::byte>> write(const PngPixels& pixels, std::size_t row_bytes) {
    if (!write_all(pixels, row_bytes)) {
      return Error{Errc::unsupported, std::string{"cannot be written as PNG: "} + complaint_.text.data(), {}};
    }
    return std::move(file_);
  }

 private:
  static void append(png_structp png, png_bytep data, std::size_t count) {
    if (!static_cast<PngWriter*>(png_get_io_ptr(png))->append_bytes(data, count)) png_error(png, "out of memory");
  }
  static void flush(png_structp /*png*/) {}

  /// Appends bytes. No exception may pass through libpng.
  [[nodiscard]] bool append_bytes(png_const_bytep data, std::size_t count) noexcept {
    try {
      const auto bytes = std::as_bytes(std::span{data, count});
      file_.insert(file_.end(), bytes.begin(), bytes.end());
      return true;
    } catch (const std::exception&) {
      return false;
    }
  }

  [[nodiscard]] bool write_all(const PngPixels& pixels, std::size_t row_bytes) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    static constexpr std::array<int, 5> kColorTypes{0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                                    PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
    png_set_write_fn(png_, this, append, flush);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(pixels.width), static_cast<png_uint_32>(pixels.height),
                 pixels.sample_bits, kColorTypes[static_cast<std::size_t>(pixels.channels)], PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(png_, kCompressionLevel);
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_ALL_FILTERS);
    png_write_info(png_, info_);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
    for (std::size_t v = 0; v < static_cast<std::size_t>(pixels.height); ++v) {
      png_write_row(png_, pixels.bytes.data() + v * row_bytes);
    }
    png_write_end(png_, nullptr);
    return true;
  }

  std::vector<std::byte> file_;
  PngErrorHandler complaint_;
  png_structp png_{nullptr};
  png_infop info_{nullptr};
};

}  // namespace

Result<PngSize> png_size(std::span<const std::byte> file) { return PngReader{file}.read_size(); }

Result<PngPixels> decode_png(std::span<const std::byte> file) {
  PngReader reader{file};
  SACCADE_CHECK(reader.read_size());
  return reader.read_pixels();
}

Result<std::vector<std::byte>> encode_png(const PngPixels& pixels) {
  SACCADE_EXPECTS(pixels.width > 0 && pixels.height > 0 && pixels.channels >= 1 && pixels.channels <= 4);
  SACCADE_EXPECTS(pixels.sample_bits == 8 || pixels.sample_bits == 16);
  const auto pixel_bytes = static_cast<std::size_t>(pixels.channels * pixels.sample_bits / 8);
  const std::size_t row_bytes = pixel_bytes * static_cast<std::size_t>(pixels.width);
  SACCADE_EXPECTS(pixels.bytes.size() == row_bytes * static_cast<std::size_t>(pixels.height));
  return PngWriter{}.write(pixels, row_bytes);
}

}  // namespace saccade
