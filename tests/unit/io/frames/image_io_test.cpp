// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/image_io.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <iostream>
#include <random>

#include "saccade/io/files/file_io.hpp"
#include "support/places.hpp"
#include "support/png_maker.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::make_png;
using test::PngSpec;
using test::TempFolder;

Result<PngPixels> decode(const std::string& file) { return decode_png(as_byte_span(file)); }

fs::path sample(const char* name) { return test::source_folder() / "tests/fuzz/corpus/image" / name; }

std::string message(const std::string& file) {
  const auto pixels = decode(file);
  return pixels ? "fine" : pixels.error().to_string();
}

TEST(Png, RoundTripsEveryKindOfPixels) {
  constexpr std::uint32_t kSeed{3};
  std::mt19937 random{kSeed};
  std::size_t cases = 0;
  for (int channels = 1; channels <= 4; ++channels) {
    for (const int bits : {8, 16}) {
      for (int round = 0; round < 12; ++round) {
        PngPixels pixels{1 + static_cast<int>(random() % 40), 1 + static_cast<int>(random() % 30), channels, bits, {}};
        pixels.bytes.resize(static_cast<std::size_t>(pixels.width * pixels.height * channels * bits / 8));
        // Smooth, random and constant pictures prefer different row filters.
        std::uint8_t value = 0;
        for (auto& b : pixels.bytes)
          b = value = static_cast<std::uint8_t>(value + (random() % (1U + 60U * (round % 3))));
        const auto file = encode_png(pixels);
        ASSERT_TRUE(file) << file.error().to_string();
        const auto back = decode_png(*file);
        ASSERT_TRUE(back) << back.error().to_string();
        EXPECT_EQ(back->width, pixels.width);
        EXPECT_EQ(back->height, pixels.height);
        EXPECT_EQ(back->channels, channels);
        EXPECT_EQ(back->sample_bits, bits);
        EXPECT_EQ(back->bytes, pixels.bytes);
        EXPECT_EQ(encode_png(pixels).value(), *file);
        ++cases;
      }
    }
  }
  std::cout << "seed " << kSeed << ", cases " << cases << "\n";
  EXPECT_EQ(cases, 96U);
}

TEST(Png, FiltersAreThoseOfTheStandard) {
  // Two rows of three grey pixels; expected values worked out by hand from ISO/IEC 15948, clause 9.
  const auto rows_of = [](const std::string& second) {
    return decode(make_png({.width = 3, .height = 2, .rows = std::string{"\0\x0A\x14\x1E", 4} + second}));
  };
  using Row = std::vector<std::uint8_t>;
  const auto second_row = [&](const std::string& row) {
    const auto pixels = rows_of(row);
    return pixels ? Row{pixels->bytes.begin() + 3, pixels->bytes.end()} : Row{};
  };
  EXPECT_EQ(second_row(std::string{"\0\x01\x02\x03", 4}), (Row{1, 2, 3}));  // none
  EXPECT_EQ(second_row("\x01\x01\x02\x03"), (Row{1, 3, 6}));                // sub
  EXPECT_EQ(second_row("\x02\x01\x02\x03"), (Row{11, 22, 33}));             // up
  EXPECT_EQ(second_row("\x03\x01\x02\x03"), (Row{6, 15, 25}));              // average, rounded down
  EXPECT_EQ(second_row("\x04\x01\x02\x03"), (Row{11, 22, 33}));             // Paeth, here always up
  EXPECT_TRUE(second_row("\x05\x01\x02\x03").empty());
}

TEST(Png, SmallSamplesAndPalettesAreExpanded) {
  const auto bits = decode(make_png({.width = 10, .height = 1, .bit_depth = 1, .rows = std::string{"\0\xA5\x40", 3}}));
  ASSERT_TRUE(bits) << bits.error().to_string();
  EXPECT_EQ(bits->bytes, (std::vector<std::uint8_t>{255, 0, 255, 0, 0, 255, 0, 255, 0, 255}));
  const auto nibbles =
      decode(make_png({.width = 3, .height = 1, .bit_depth = 4, .rows = std::string{"\0\x1F\x80", 3}}));
  ASSERT_TRUE(nibbles);
  EXPECT_EQ(nibbles->bytes, (std::vector<std::uint8_t>{17, 255, 136}));
  PngSpec palette{.width = 2, .height = 1, .bit_depth = 2, .color_type = 3, .palette = "abcdef", .rows = {"\0\x10", 2}};
  const auto colors = decode(make_png(palette));
  ASSERT_TRUE(colors) << colors.error().to_string();
  EXPECT_EQ(colors->channels, 3);
  EXPECT_EQ(colors->bytes, (std::vector<std::uint8_t>{'a', 'b', 'c', 'd', 'e', 'f'}));
}

TEST(Png, InterlacedFilesAreRead) {
  // 2x2 pixels: the first, the sixth and the seventh pass of Adam7; the others are empty.
  const std::string rows{"\0\1\0\2\0\3\4", 7};
  const auto pixels = decode(make_png({.width = 2, .height = 2, .interlaced = true, .rows = rows}));
  ASSERT_TRUE(pixels) << pixels.error().to_string();
  EXPECT_EQ(pixels->bytes, (std::vector<std::uint8_t>{1, 2, 3, 4}));
}

TEST(Png, SixteenBitsComeInTheOrderOfTheMachine) {
  const auto pixels =
      decode(make_png({.width = 1, .height = 1, .bit_depth = 16, .rows = std::string{"\0\x12\x34", 3}}));
  ASSERT_TRUE(pixels) << pixels.error().to_string();
  ASSERT_EQ(pixels->bytes.size(), 2U);
  std::uint16_t value = 0;
  std::memcpy(&value, pixels->bytes.data(), 2);
  EXPECT_EQ(value, 0x1234);
}

/// `good` with one more chunk after its header.
std::string with_chunk(const PngSpec& good, const std::string& chunk) {
  const std::size_t header_bytes = test::png_header(good).size();
  return make_png(good).insert(header_bytes, chunk);
}

TEST(Png, AncillaryChunksDoNotChangePixelsButTheirDamageCounts) {
  const PngSpec good{.width = 1, .height = 1, .rows = {"\0\x40", 2}};
  const std::string gamma = test::png_chunk("gAMA", test::big_endian(22222));
  const std::string see_through = test::png_chunk("tRNS", std::string{"\0\x40", 2});
  for (const std::string& chunk : {gamma, see_through, test::png_chunk("iCCP", "no profile")}) {
    const auto pixels = decode(with_chunk(good, chunk));
    ASSERT_TRUE(pixels) << pixels.error().to_string();
    EXPECT_EQ(pixels->channels, 1);
    EXPECT_EQ(pixels->bytes, std::vector<std::uint8_t>{0x40});
  }
  std::string damaged = gamma;
  damaged[9] ^= 1;
  EXPECT_NE(message(with_chunk(good, damaged)).find("gAMA: CRC"), std::string::npos)
      << message(with_chunk(good, damaged));
}

TEST(Png, DamageIsAnErrorThatSaysWhere) {
  const PngSpec good{.width = 2, .height = 2, .rows = {"\0\1\2\0\3\4", 6}};
  EXPECT_EQ(message(make_png(good)), "fine");
  const auto expect_refused = [](const std::string& file, const char* words) {
    const std::string said = message(file);
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_NE(said.find("byte "), std::string::npos) << said;
  };
  const auto expect = [&](auto change, const char* words) {
    PngSpec spec = good;
    change(spec);
    expect_refused(make_png(spec), words);
  };
  expect_refused("", "not a PNG");
  expect([](PngSpec& s) { s.width = 0; }, "width is zero");
  expect([](PngSpec& s) { s.height = 0; }, "height is zero");
  expect([](PngSpec& s) { s.height = 16384, s.width = 16384; }, "too few bytes");
  expect([](PngSpec& s) { s.bit_depth = 5; }, "bit depth");
  expect([](PngSpec& s) { s.color_type = 1; }, "color type");
  expect([](PngSpec& s) { s.rows[0] = 7; }, "filter");
  expect([](PngSpec& s) { s.rows.pop_back(); }, "Not enough image data");
  expect([](PngSpec& s) { s.rows += 'x'; }, "Too much image data");
  expect([](PngSpec& s) { s.color_type = 3; }, "PLTE");
  expect([](PngSpec& s) { s.color_type = 3, s.palette = "abcdef"; }, "palette");
  expect_refused(make_png(good) + "x", "bytes after its end");
  expect_refused(test::png_header(good) + test::png_chunk("IEND", ""), "out of place");
  expect_refused(with_chunk(good, test::png_chunk("ABCD", "")), "ABCD");
  std::string wrong_sum = test::stored_zlib(good.rows);
  wrong_sum.back() ^= 1;
  const std::string tail = test::png_chunk("IDAT", wrong_sum) + test::png_chunk("IEND", "");
  expect_refused(test::png_header(good) + tail, "incorrect data check");
}

TEST(Png, SizesBeyondTheLimitAreNamed) {
  for (const auto& [width, height] :
       {std::pair{2U, 16385U}, std::pair{16385U, 2U}, std::pair{0x7FFFFFFFU, 0x7FFFFFFFU}}) {
    const auto pixels = decode(make_png({.width = width, .height = height}));
    ASSERT_FALSE(pixels);
    EXPECT_EQ(pixels.error().code, Errc::unsupported);
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    EXPECT_NE(pixels.error().message.find(size), std::string::npos) << pixels.error().message;
  }
  EXPECT_EQ(message(make_png({.width = 0xFFFFFFFFU})).rfind("fine"), std::string::npos);
  PngPixels wide{1000001, 1, 1, 8, std::vector<std::uint8_t>(1000001)};
  const auto file = encode_png(wide);
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().message.find("width"), std::string::npos) << file.error().message;
}

TEST(Png, EveryCutAndEveryFlippedByteIsNoticed) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  std::size_t tried = 0;
  for (const char* name : {"depth.png", "grey.png"}) {
    const auto file = read_text_file(sample(name));
    ASSERT_TRUE(file) << file.error().to_string();
    ASSERT_EQ(message(*file), "fine");
    for (std::size_t i = 0; i < file->size(); ++i) {
      EXPECT_NE(message(file->substr(0, i)), "fine") << name << " cut to " << i;
      std::string flipped = *file;
      flipped[i] = static_cast<char>(flipped[i] ^ 0x10);
      EXPECT_NE(message(flipped), "fine") << name << " byte " << i;
      ++tried;
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_GT(tried, 100U);
}

TEST(ImageIo, ReadsFilesOfOtherPrograms) {
  const auto depth = read_png16(sample("depth.png"));
  ASSERT_TRUE(depth) << depth.error().to_string();
  for (int v = 0; v < 6; ++v) {
    for (int u = 0; u < 8; ++u) EXPECT_EQ((*depth)(u, v), 1000 * v + u);
  }
  const auto png = read_color(sample("color.png"));
  ASSERT_TRUE(png);
  EXPECT_EQ(png->width(), 24);
  EXPECT_EQ((*png)(3, 5), (Rgb8{30, 40, 20}));
  for (const char* name : {"tiny.jpg", "progressive.jpg"}) {
    const auto jpeg = read_color(sample(name));
    ASSERT_TRUE(jpeg) << jpeg.error().to_string();
    ASSERT_EQ(jpeg->size(), png->size());
    for (std::size_t i = 0; i < png->size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(jpeg->data()[i][c], png->data()[i][c], 14) << name;
    }
  }
  const auto grey = read_color(sample("grey.png"));
  ASSERT_TRUE(grey);
  EXPECT_EQ((*grey)(3, 5), (Rgb8{30, 30, 30}));
  const auto mask = read_mask(sample("grey.png"));
  ASSERT_TRUE(mask);
  EXPECT_EQ((*mask)(0, 0), 0);
  EXPECT_EQ((*mask)(1, 0), 255);
}

TEST(ImageIo, DamagedJpegsAreErrorsAndNothingIsPrinted) {
  const auto file = read_text_file(sample("tiny.jpg"));
  ASSERT_TRUE(file);
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  std::size_t refused = 0;
  for (std::size_t size = 0; size < file->size(); ++size) {
    const std::string cut = file->substr(0, size);
    refused += decode_color(as_byte_span(cut)) ? 0U : 1U;
    // Cut in the middle, but with an end marker.
    const std::string ended = cut + "\xFF\xD9";
    static_cast<void>(decode_color(as_byte_span(ended)));
  }
  std::string half = file->substr(0, file->size() - 40) + "\xFF\xD9";
  const auto decoded = decode_color(as_byte_span(half));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(refused, file->size());
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().code, Errc::corrupt_data);
}

TEST(ImageIo, ErrorsNameTheFile) {
  const TempFolder folder;
  EXPECT_EQ(read_png16(folder / "none.png").error().code, Errc::not_found);
  const auto path = folder.write("text.png", "hello, this is text");
  EXPECT_EQ(read_color(path).error().to_string().rfind(path.string(), 0), 0U);
  EXPECT_NE(read_color(path).error().message.find("neither PNG, JPEG"), std::string::npos);
  EXPECT_EQ(read_png16(sample("color.png")).error().code, Errc::unsupported);
  EXPECT_EQ(read_png16(folder.path()).error().code, Errc::io_failure);
  EXPECT_EQ(write_png(folder / "x.png", ColorImage{}).error().code, Errc::invalid_argument);
  EXPECT_EQ(write_png(folder / "no/such/x.png", ColorImage{1, 1}).error().code, Errc::io_failure);
  EXPECT_EQ(read_png_size(sample("depth.png"))->width, 8);
  EXPECT_FALSE(read_png_size(path));
}

TEST(DepthEncoding, DecodesAndEncodes) {
  Image16 samples{4, 1};
  samples(0, 0) = 0;
  samples(1, 0) = 65535;
  samples(2, 0) = 5000;
  samples(3, 0) = 1;
  const DepthImage tum = decode_depth(samples, {5000.0, false});
  EXPECT_EQ(tum.pixels(), (std::vector<float>{0.0F, 0.0F, 1.0F, 0.0002F}));
  // The sample 12345 (1.2345 m at 10000 per metre), rotated left by three bits.
  const Image16 rotated{1, 1, static_cast<std::uint16_t>((12345U << 3U) | (12345U >> 13U))};
  EXPECT_FLOAT_EQ(decode_depth(rotated, {10000.0, true})(0, 0), 1.2345F);
  std::size_t checked = 0;
  for (const bool bit_rotated : {false, true}) {
    Image16 all{65535, 1};
    for (int i = 0; i < 65535; ++i) all(i, 0) = static_cast<std::uint16_t>(i);
    const DepthEncoding encoding{1000.0, bit_rotated};
    const Image16 back = encode_depth(decode_depth(all, encoding), encoding);
    EXPECT_EQ(back, all);
    checked += back.size();
  }
  EXPECT_EQ(checked, 2U * 65535U);
  DepthImage odd{3, 1, std::vector<float>{-1.0F, std::numeric_limits<float>::quiet_NaN(), 70.0F}};
  EXPECT_EQ(encode_depth(odd, {}), (Image16{3, 1}));
  EXPECT_FALSE((DepthEncoding{0.0, false}.validate()));
  EXPECT_FALSE((DepthEncoding{std::numeric_limits<double>::quiet_NaN(), false}.validate()));
}

}  // namespace
}  // namespace saccade
