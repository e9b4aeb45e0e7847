// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/frames/depth_io.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "saccade/io/files/file_io.hpp"
#include "support/depth_files.hpp"
#include "support/png_maker.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

using test::bytes_of_values;
using test::make_exr;
using test::make_npy;
using test::make_tiff;

constexpr DepthUnits kLayout{{1000.0, false}, UnitsSource::layout};
constexpr DepthUnits kGiven{{100.0, false}, UnitsSource::given};

/// Returns the pixels, or the error's text as an exception would show it.
std::vector<float> depths(const std::string& file, const DepthUnits& units = kLayout) {
  const auto depth = decode_depth_image(as_byte_span(file), units);
  EXPECT_TRUE(depth) << depth.error().to_string();
  return depth ? depth->pixels() : std::vector<float>{};
}

std::string refusal(const std::string& file, const DepthUnits& units = kLayout) {
  const auto depth = decode_depth_image(as_byte_span(file), units);
  EXPECT_FALSE(depth);
  return depth ? "accepted" : depth.error().to_string();
}

bool reads_exr() {
  const auto depth = decode_depth_image(as_byte_span(make_exr(1, 1, {"Z"}, {1.0F})), kLayout);
  return depth || depth.error().message.find("lacks") == std::string::npos;
}

const std::vector<std::uint16_t> kWhole{0, 500, 1000, 65535};
const std::vector<float> kWholeMetres{0.0F, 0.5F, 1.0F, 0.0F};
const std::vector<float> kReal{-1.0F, 0.25F, std::numeric_limits<float>::quiet_NaN(),
                               std::numeric_limits<float>::infinity()};
const std::vector<float> kRealMetres{0.0F, 0.25F, 0.0F, 0.0F};

TEST(DepthImageFile, EveryFormatGivesTheSameMetres) {
  const std::string whole = bytes_of_values(kWhole);
  std::string swapped = whole;
  for (std::size_t i = 0; i + 1 < swapped.size(); i += 2) std::swap(swapped[i], swapped[i + 1]);
  for (const std::string& file :
       {make_tiff(2, 2, 16, 1, whole), make_npy("<u2", "(2, 2)", whole), make_npy("<u2", "(2, 2, 1)", whole),
        "P5\n# by a test\n2 2\n65535\n" + swapped, std::string{"P2 2 2 65535 0 500 1000 65535\n"}}) {
    EXPECT_EQ(depths(file), kWholeMetres) << file.substr(0, 2);
  }
  EXPECT_EQ(depths(make_npy("<u2", "(2, 2)", bytes_of_values(std::vector<std::uint16_t>{0, 1000, 500, 65535}), true)),
            kWholeMetres);
  EXPECT_EQ(depths(make_npy("<i4", "(1, 3)", bytes_of_values(std::vector<std::int32_t>{-5, 1500, 90000}))),
            (std::vector<float>{0.0F, 1.5F, 90.0F}));
}

TEST(DepthImageFile, FloatsAreMetresUnlessAScaleIsGiven) {
  EXPECT_EQ(depths(make_tiff(2, 2, 32, 3, bytes_of_values(kReal))), kRealMetres);
  EXPECT_EQ(depths(make_npy("<f4", "(2, 2)", bytes_of_values(kReal))), kRealMetres);
  EXPECT_EQ(depths(make_npy("<f8", "(1, 2)", bytes_of_values(std::vector<double>{1.5, -0.5}))),
            (std::vector<float>{1.5F, 0.0F}));
  EXPECT_EQ(depths(make_npy("<f4", "(1, 1)", bytes_of_values(std::vector<float>{150.0F})), kGiven),
            (std::vector<float>{1.5F}));
}

TEST(DepthImageFile, ExrHasDepthInOneChannelOrInEqualColors) {
  if (!reads_exr()) GTEST_SKIP() << "this build lacks libopenexr-dev";
  using Names = std::vector<std::string>;
  for (const Names& names : {Names{"Y"}, Names{"Depth.V"}, Names{"Z"}, Names{"A", "B", "G", "R", "Z"},
                             Names{"Image.B", "Image.G", "Image.R"}}) {
    EXPECT_EQ(depths(make_exr(2, 2, names, kReal)), kRealMetres) << names.front();
  }
  const std::string exr = make_exr(2, 2, {"Z"}, kReal);
  EXPECT_NE(refusal(make_exr(2, 2, {"X", "Y"}, kReal)).find("the channels X, Y"), std::string::npos);
  EXPECT_NE(refusal(make_exr(2, 2, {"Z"}, kReal, 1)).find("cropped"), std::string::npos);
  EXPECT_NE(refusal(make_exr(16384, 16384, {"Z"}, {})).find("OpenEXR"), std::string::npos);
  EXPECT_NE(refusal(make_exr(1 << 20, 1, {"Z"}, {})).find("OpenEXR"), std::string::npos);
  std::string colors = make_exr(2, 2, {"B", "G", "R"}, kReal);
  colors[colors.size() - 6] = 'x';
  EXPECT_NE(refusal(colors).find("of colours"), std::string::npos);
  for (std::size_t bytes = 4; bytes < exr.size(); bytes += 7) {
    EXPECT_NE(refusal(exr.substr(0, bytes)).find("OpenEXR"), std::string::npos) << bytes;
  }
}

TEST(DepthImageFile, EightBitsNeedAScale) {
  test::PngSpec spec;
  spec.width = 2;
  spec.height = 1;
  spec.bit_depth = 8;
  spec.color_type = 0;
  spec.rows = std::string{"\0\x32\xFF", 3};  // filter 0, samples 50 and 255
  const std::string png = test::make_png(spec);
  const std::string pgm{"P5 2 1 255\n\x32\xFF"};
  for (const std::string& file : {png, pgm}) {
    EXPECT_NE(refusal(file).find("--depth-scale N"), std::string::npos);
    EXPECT_EQ(depths(file, kGiven), (std::vector<float>{0.5F, 2.55F}));
  }
}

TEST(DepthImageFile, DamageAndOtherKindsAreRefusedWithWhatToDo) {
  const std::string tiff = make_tiff(2, 2, 16, 1, bytes_of_values(kWhole));
  const std::string npy = make_npy("<u2", "(2, 2)", bytes_of_values(kWhole));
  const std::vector<std::pair<std::string, const char*>> cases{
      {"", "neither PNG, TIFF, PGM, NPY nor EXR"},
      {"\x76\x2f\x31\x01 and more", "OpenEXR"},
      {"\xff\xd8\xff\xe0", "JPEG"},
      {"PK\x03\x04", "numpy.save"},
      {tiff.substr(0, tiff.size() - 30), "TIFF"},
      {tiff.substr(0, 12), "TIFF"},
      {make_tiff(2, 2, 16, 1, bytes_of_values(kWhole).substr(0, 4)), "TIFF"},
      {make_tiff(2, 2, 16, 1, bytes_of_values(kWhole), 1, 7), "compression 7"},
      {make_tiff(20000, 2, 16, 1, bytes_of_values(kWhole)), "larger than"},
      {make_tiff(16384, 16384, 16, 1, bytes_of_values(kWhole)), "too few bytes"},
      {make_tiff(1, 1, 8, 1, std::string(3, '\1'), 3), "one channel"},
      {npy + "x", "fewer or more"},
      {npy.substr(0, npy.size() - 1), "fewer or more"},
      {make_npy("<u2", "(4,)", bytes_of_values(kWhole)), "(height, width)"},
      {make_npy(">u2", "(2, 2)", bytes_of_values(kWhole)), "astype"},
      {"P5 2 2 65535\nabc", "ends too early"},
      {"P5 2 1 255\nabc", "bytes after its end"},
      {"P5 2 1 100\n\x70\x70", "beyond the largest"},
      {"P2 2 1 9 1 x", "not a number"},
      {"P2 20000 1 9 1", "larger than"}};
  for (const auto& [file, part] : cases) {
    EXPECT_NE(refusal(file).find(part), std::string::npos) << refusal(file) << " for " << part;
  }
}

TEST(DepthImageFile, TheErrorNamesTheFile) {
  const test::TempFolder folder;
  const auto path = folder.write("0.exr", "\x76\x2f\x31\x01");
  EXPECT_EQ(read_depth_image(path, kLayout).error().context, path.string());
  EXPECT_EQ(read_depth_image(folder / "none.png", kLayout).error().code, Errc::not_found);
}

}  // namespace
}  // namespace saccade
