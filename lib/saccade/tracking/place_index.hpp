// SPDX-License-Identifier: Apache-2.0
#pragma once
// PlaceIndex: finds keyframes that show the same place, by randomised ferns over small images.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/sensor/image.hpp"

namespace saccade {

struct PlaceIndexConfig {
  int columns{40};          ///< width of the small image that ferns look at, a grid of means
  int rows{30};             ///< its height
  std::size_t ferns{500};   ///< pixels that are tested, at random places and against random thresholds
  double min_depth_m{0.4};  ///< thresholds of depth lie within these two
  double max_depth_m{4.0};
  std::uint64_t seed{1};

  [[nodiscard]] Status validate() const;
};

/// Code of an image: per fern one bit each of depth, red, green and blue; kNoCode where there is no depth.
using PlaceCode = std::vector<std::uint8_t>;

struct PlaceMatch {
  std::size_t place{0};       ///< number that add() returned
  double dissimilarity{1.0};  ///< share of differing codes among the ferns that saw depth in both images
};

/// Randomised ferns (Glocker et al., "Real-Time RGB-D Camera Relocalization via Randomized Ferns for Keyframe
/// Encoding", TVCG 2015): a fern compares depth and colour at one pixel of a small image with a threshold each. Images
/// whose codes mostly agree show about the same from about the same place. That two places look alike this does not
/// tell. One writer; const members from any thread. Equal seeds make equal ferns on every machine.
class PlaceIndex {
 public:
  static constexpr std::uint8_t kNoCode{255};

  [[nodiscard]] static Result<PlaceIndex> create(const PlaceIndexConfig& config = {});

  /// Encodes an image of any size. Without colours, depth alone decides. Where less than a quarter of a cell of the
  /// small image has depth, its ferns have no code. Answers size_mismatch where colour and depth differ in size,
  /// invalid_argument for images smaller than the small one. O(pixels), one thread.
  [[nodiscard]] Result<PlaceCode> encode(const DepthImage& depth, const ColorImage* color) const;

  /// Adds a place and returns its number: 0, 1, …
  std::size_t add(PlaceCode code);
  [[nodiscard]] std::size_t size() const { return codes_.size(); }

  /// Returns up to `count` of the first `places` places, the most alike first, equal ones by their number. Expects a
  /// code of this index. O(places · ferns).
  [[nodiscard]] std::vector<PlaceMatch> nearest(const PlaceCode& code, std::size_t count, std::size_t places) const;
  [[nodiscard]] std::vector<PlaceMatch> nearest(const PlaceCode& code, std::size_t count) const {
    return nearest(code, count, size());
  }

  /// Returns the share of differing codes; 1 where fewer than a quarter of the ferns have codes in both.
  [[nodiscard]] static double dissimilarity(const PlaceCode& a, const PlaceCode& b);

 private:
  struct Fern {
    std::size_t cell{0};
    float depth_m{0.0F};
    Rgb8 color{};
  };
  explicit PlaceIndex(const PlaceIndexConfig& config);

  PlaceIndexConfig config_;
  std::vector<Fern> ferns_;
  std::vector<PlaceCode> codes_;
};

}  // namespace saccade
