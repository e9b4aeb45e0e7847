// SPDX-License-Identifier: Apache-2.0
// OpenEXR is optional: without it an EXR is an error that names the conversion.
#include <cstring>

#include "saccade/io/frames/internal/sample_image.hpp"

#ifdef SACCADE_HAS_OPENEXR
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfVersion.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saccade/core/names.hpp"
#include "saccade/io/frames/image_io.hpp"
#endif

namespace saccade {

bool is_exr(std::span<const std::byte> file) {
  return file.size() >= 4 && std::memcmp(file.data(), "\x76\x2f\x31\x01", 4) == 0;
}

#ifndef SACCADE_HAS_OPENEXR

Result<SampleImage> decode_exr(std::span<const std::byte> /*file*/) {
  return Error{Errc::unsupported,
               "an OpenEXR image, and this build lacks libopenexr-dev; convert it to floats in TIFF: "
               "oiiotool IN.exr --ch 0 -d float -o OUT.tif",
               {}};
}

#else

namespace {

/// Bytes that OpenEXR reads as a file. What it throws ends in decode_exr.
class ExrMemory final : public Imf::IStream {
 public:
  explicit ExrMemory(std::span<const std::byte> file) : Imf::IStream{"image"}, file_{file} {}
  bool read(char* out, int count) override {
    if (count < 0 || static_cast<std::size_t>(count) > file_.size() - offset_) {
      throw std::runtime_error{"it ends too early"};
    }
    std::memcpy(out, file_.data() + offset_, static_cast<std::size_t>(count));
    offset_ += static_cast<std::size_t>(count);
    return offset_ < file_.size();
  }
  uint64_t tellg() override { return offset_; }
  void seekg(uint64_t offset) override {
    if (offset > file_.size()) throw std::runtime_error{"it ends too early"};
    offset_ = offset;
  }

 private:
  std::span<const std::byte> file_;
  std::size_t offset_{0};
};

Error exr_refusal(std::string what) { return {Errc::unsupported, std::move(what), {}}; }

/// Returns the name behind the last dot: layers stand before it.
std::string_view plain_name(std::string_view channel) { return channel.substr(channel.rfind('.') + 1); }

std::vector<std::string> channel_names(const Imf::ChannelList& channels) {
  std::vector<std::string> names;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) names.emplace_back(channel.name());
  return names;
}

/// Returns the channels that hold depth: one, or R, G and B, which must be equal. Empty: it cannot be told.
std::vector<std::string> depth_channels(const std::vector<std::string>& names) {
  if (names.size() == 1) return names;
  constexpr std::array<std::string_view, 5> kDepthNames{"Z", "z", "depth", "Depth", "V"};
  std::vector<std::string> found;
  std::copy_if(names.begin(), names.end(), std::back_inserter(found), [&](const std::string& name) {
    return std::find(kDepthNames.begin(), kDepthNames.end(), plain_name(name)) != kDepthNames.end();
  });
  if (found.size() == 1) return found;
  found.clear();
  for (const char* color : {"R", "G", "B"}) {
    const auto name = std::find_if(names.begin(), names.end(), [&](const auto& n) { return plain_name(n) == color; });
    if (name == names.end()) return {};
    found.push_back(*name);
  }
  return found;
}

std::vector<float> read_channel(Imf::InputFile& file, const std::string& name, int width, int height) {
  const Imath::Box2i window = file.header().dataWindow();
  std::vector<float> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  Imf::FrameBuffer buffer;
  buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), window));
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return values;
}

Result<SampleImage> read_depth_channel(Imf::InputFile& file, std::size_t file_bytes) {
  const Imath::Box2i window = file.header().dataWindow();
  const Imath::Box2i display = file.header().displayWindow();
  const auto edge = [](int min, int max) { return static_cast<std::size_t>(std::int64_t{max} - min + 1); };
  SACCADE_CHECK(check_edges(edge(window.min.x, window.max.x), edge(window.min.y, window.max.y)));
  constexpr std::size_t kMaxExrExpansion{4096};
  const std::size_t bytes = edge(window.min.x, window.max.x) * edge(window.min.y, window.max.y) * sizeof(float);
  if (bytes > kMaxExrExpansion * file_bytes) {
    return Error{Errc::corrupt_data, "corrupt or truncated OpenEXR image: too few bytes for its size", {}};
  }
  if (window != display) return exr_refusal("an OpenEXR image cropped to a part of its display window; save the whole");
  const std::vector<std::string> names = channel_names(file.header().channels());
  const std::vector<std::string> depths = depth_channels(names);
  if (depths.empty()) {
    return exr_refusal("an OpenEXR image of the channels " +
                       joined(names, ", ", [](const std::string& name) { return name; }) +
                       "; depth is the only channel, one named Z, depth or V, or R, G and B of equal values");
  }
  for (const std::string& name : depths) {
    const Imf::Channel& channel = file.header().channels()[name];
    if (channel.xSampling != 1 || channel.ySampling != 1) return exr_refusal("an OpenEXR image of subsampled depth");
  }
  SampleImage image{static_cast<int>(edge(window.min.x, window.max.x)),
                    static_cast<int>(edge(window.min.y, window.max.y)),
                    1,
                    SampleKind::real,
                    {}};
  image.values = read_channel(file, depths.front(), image.width, image.height);
  for (std::size_t i = 1; i < depths.size(); ++i) {
    const std::vector<float> other = read_channel(file, depths[i], image.width, image.height);
    if (std::memcmp(other.data(), image.values.data(), other.size() * sizeof(float)) != 0) {
      return exr_refusal("an OpenEXR image of colours; depth needs one channel, or R, G and B of equal values");
    }
  }
  return image;
}

}  // namespace

Result<SampleImage> decode_exr(std::span<const std::byte> file) {
  static const bool limited = [] {
    Imf::Header::setMaxImageSize(kMaxImageEdge, kMaxImageEdge);  // OpenEXR allocates by what a header states
    return true;
  }();
  (void)limited;
  try {
    ExrMemory memory{file};
    constexpr int kNoThreads{0};
    Imf::InputFile exr{memory, kNoThreads};
    if (Imf::isMultiPart(exr.version()) || Imf::isNonImage(exr.version())) {
      return exr_refusal("an OpenEXR file of several parts or of deep pixels; save one flat image");
    }
    return read_depth_channel(exr, file.size());
  } catch (const std::exception& fault) {
    std::string why{fault.what()};
    std::replace(why.begin(), why.end(), '\n', ' ');
    return Error{Errc::corrupt_data, "corrupt or truncated OpenEXR image: " + why, {}};
  }
}

#endif

}  // namespace saccade
