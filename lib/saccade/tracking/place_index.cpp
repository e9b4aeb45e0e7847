// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/place_index.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "saccade/core/seeded_random.hpp"

namespace saccade {
namespace {

/// Mean of what lies in one cell of the small image.
struct PlaceCell {
  float depth_m{0.0F};  ///< 0: too little depth
  std::array<float, 3> color{};
};

PlaceCell cell_mean(const DepthImage& depth, const ColorImage* color, int u0, int u1, int v0, int v1) {
  double depth_sum{0.0};
  std::size_t returns{0};
  std::array<std::uint64_t, 3> color_sum{};
  for (int v = v0; v < v1; ++v) {
    for (int u = u0; u < u1; ++u) {
      const float z = depth(u, v);
      if (z > 0.0F && std::isfinite(z)) {
        depth_sum += static_cast<double>(z);
        ++returns;
      }
      if (color == nullptr) continue;
      for (std::size_t k = 0; k < 3; ++k) color_sum.at(k) += (*color)(u, v).at(k);
    }
  }
  const auto pixels = static_cast<std::size_t>((u1 - u0) * (v1 - v0));
  PlaceCell cell;
  if (4 * returns >= pixels) cell.depth_m = static_cast<float>(depth_sum / static_cast<double>(returns));
  for (std::size_t k = 0; k < 3; ++k) {
    cell.color.at(k) = static_cast<float>(color_sum.at(k)) / static_cast<float>(pixels);
  }
  return cell;
}

}  // namespace

Status PlaceIndexConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "place index"}; };
  if (columns < 1 || rows < 1) return fail("the small image needs a size");
  if (ferns < 1) return fail("at least one fern is needed");
  if (!(min_depth_m > 0.0) || !(max_depth_m > min_depth_m)) return fail("the depths must be positive and increase");
  return {};
}

PlaceIndex::PlaceIndex(const PlaceIndexConfig& config) : config_{config} {
  SeededRandom random{config.seed};
  const auto cells = static_cast<std::size_t>(config.columns) * static_cast<std::size_t>(config.rows);
  for (std::size_t i = 0; i < config.ferns; ++i) {
    Fern fern;
    fern.cell = random.below(cells);
    fern.depth_m = static_cast<float>(random.uniform(config.min_depth_m, config.max_depth_m));
    for (std::uint8_t& threshold : fern.color) threshold = static_cast<std::uint8_t>(random.below(256));
    ferns_.push_back(fern);
  }
}

Result<PlaceIndex> PlaceIndex::create(const PlaceIndexConfig& config) {
  SACCADE_CHECK(config.validate());
  return PlaceIndex{config};
}

Result<PlaceCode> PlaceIndex::encode(const DepthImage& depth, const ColorImage* color) const {
  const int width = depth.width();
  const int height = depth.height();
  if (color != nullptr && (color->width() != width || color->height() != height)) {
    return Error{Errc::size_mismatch, "colour and depth differ in size", "place index"};
  }
  if (width < config_.columns || height < config_.rows) {
    return Error{Errc::invalid_argument, "the image is smaller than the index's small images", "place index"};
  }
  std::vector<PlaceCell> cells;
  for (int row = 0; row < config_.rows; ++row) {
    for (int column = 0; column < config_.columns; ++column) {
      cells.push_back(cell_mean(depth, color, column * width / config_.columns, (column + 1) * width / config_.columns,
                                row * height / config_.rows, (row + 1) * height / config_.rows));
    }
  }
  PlaceCode code;
  for (const Fern& fern : ferns_) {
    const PlaceCell& cell = cells[fern.cell];
    if (!(cell.depth_m > 0.0F)) {
      code.push_back(kNoCode);
      continue;
    }
    unsigned bits = cell.depth_m > fern.depth_m ? 1U : 0U;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = 2U * bits + (cell.color.at(k) > static_cast<float>(fern.color.at(k)) ? 1U : 0U);
    }
    code.push_back(static_cast<std::uint8_t>(bits));
  }
  return code;
}

std::size_t PlaceIndex::add(PlaceCode code) {
  SACCADE_EXPECTS(code.size() == ferns_.size());
  codes_.push_back(std::move(code));
  return codes_.size() - 1;
}

double PlaceIndex::dissimilarity(const PlaceCode& a, const PlaceCode& b) {
  SACCADE_EXPECTS(a.size() == b.size());
  std::size_t compared{0};
  std::size_t different{0};
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == kNoCode || b[i] == kNoCode) continue;
    ++compared;
    if (a[i] != b[i]) ++different;
  }
  if (4 * compared < a.size() || compared == 0) return 1.0;
  return static_cast<double>(different) / static_cast<double>(compared);
}

std::vector<PlaceMatch> PlaceIndex::nearest(const PlaceCode& code, std::size_t count, std::size_t places) const {
  std::vector<PlaceMatch> matches;
  for (std::size_t i = 0; i < std::min(places, codes_.size()); ++i) {
    matches.push_back({i, dissimilarity(code, codes_[i])});
  }
  const std::size_t kept = std::min(count, matches.size());
  std::partial_sort(matches.begin(), matches.begin() + static_cast<std::ptrdiff_t>(kept), matches.end(),
                    [](const PlaceMatch& a, const PlaceMatch& b) {
                      return a.dissimilarity != b.dissimilarity ? a.dissimilarity < b.dissimilarity : a.place < b.place;
                    });
  matches.resize(kept);
  return matches;
}

}  // namespace saccade
