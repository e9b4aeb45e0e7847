// SPDX-License-Identifier: Apache-2.0
#pragma once
// TableOptions: what the tables of the thesis are made from, and how much of it.

#include <cstdint>
#include <filesystem>
#include <string>

namespace saccade::reproduce {

struct TableOptions {
  std::size_t poses{0};  ///< view poses of Table 2.9 that are evaluated, evenly spread; 0: all
  std::uint64_t seed{1};
  std::filesystem::path hands;   ///< folder of the thesis' recorded hands; see experiments/hand_data.hpp
  std::size_t noise_seeds{20};   ///< seeds of the noise on hands that Table 2.4 sums over
  std::filesystem::path clouds;  ///< folder of labelled clouds for the tables of annotation; empty: simulated ones
  int image_width_px{0};         ///< width of simulated cameras, where a table heeds it; 0: each table's own
  std::size_t frames{0};         ///< frames of the scan of Table 2.1 and of each scene of surfels; 0: all
  std::string surfel_scene;      ///< the only scene of surfels; empty: all
  std::size_t placements{16};    ///< places of the grid of SV-LCCP's seeds
  /// Leaves out what Saccade adds: the updates of Tables 2.7 and 2.8 (docs/guides/update.md), and mode filter and
  /// segmentation of Tables 4.1 to 4.3 and their figures (decision 41).
  bool as_printed{false};
  bool quick{false};  ///< numbers that were not given are reduced: see quick_options
  bool draws{false};  ///< plots and pictures are made, too
};

/// The options with whatever was not given reduced so that each table takes about a minute.
/// @param given  the options as they were given, unset ones at their defaults
[[nodiscard]] TableOptions quick_options(TableOptions given);

/// Lists the changes of quick_options, for a note: "128 pixels (--image-width), 40 frames (--frames)…".
[[nodiscard]] std::string quick_note();

}  // namespace saccade::reproduce
