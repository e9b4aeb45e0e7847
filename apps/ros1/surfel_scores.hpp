// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelScene: known and unknown surfels, and scores of views of them. Standard types: included by C++17 and C++20
// files.

#include <atomic>
#include <memory>
#include <mutex>

#include "kinfu_types.hpp"

namespace saccade::ros1 {

struct PlainSurfel {
  std::array<float, 3> position{}, normal{};
  std::array<std::uint8_t, 4> rgba{};
  float radius{0.0F};
  bool unknown{false};
};

/// Filter: nothing, a sphere (centre, radius) or a box (minimum, maximum). It contains a surfel whose centre lies
/// inside.
struct SurfelFilter {
  std::uint32_t type{0};
  std::vector<float> data;
};

struct SurfelQuestion {
  PlainCamera camera;
  double min_range{0.0}, max_range{0.0};
  double occupied_score{0.0}, unknown_score{0.0}, distance_weight{0.0}, absolute_weight{0.0};
  SurfelFilter counted;  ///< other surfels still hide those behind them
  SurfelFilter present;  ///< other surfels are ignored
  bool with_images{false}, with_color{false}, with_clouds{false}, lighting{false};
};

/// Score of one view.
struct SurfelScore {
  double score{0.0}, occupied{0.0}, unknown{0.0}, out_of_range{0.0};
  std::vector<std::uint8_t> image;  ///< one byte per pixel, or four with colour
  PlainCloud cloud;                 ///< camera frame; intensity: distance, negative for unknown
};

class SurfelScene {
 public:
  /// Replaces the surfels; evaluations in progress keep theirs. Any thread.
  void set(std::vector<PlainSurfel> surfels);
  /// Evaluates poses. Returns an error text for a bad question; `scores` then is empty.
  std::string evaluate(const SurfelQuestion& question, const std::vector<PlainPose>& poses,
                       const std::atomic<bool>& cancelled, std::vector<SurfelScore>& scores) const;

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const std::vector<PlainSurfel>> surfels_ = std::make_shared<std::vector<PlainSurfel>>();
};

}  // namespace saccade::ros1
