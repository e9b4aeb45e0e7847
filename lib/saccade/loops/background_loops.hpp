// SPDX-License-Identifier: Apache-2.0
#pragma once
// BackgroundLoops: closes loops in a thread of its own while frames are tracked and fused.

#include <cstddef>
#include <memory>
#include <vector>

#include "saccade/loops/loop_closer.hpp"
#include "saccade/tracking/reconstruction.hpp"

namespace saccade {

/// Runs a LoopCloser beside the thread that tracks and fuses. Once a loop is closed, the frames are fused again along
/// the corrected poses into a map of its own, up to the present; this map then takes the place of the other at the
/// border between two frames. The thread that fuses never waits: it hands over pointers, and takes the map when it is
/// ready. When that is depends on time, and so do the poses that are tracked afterwards; LoopCloser after the run does
/// not. One thread calls.
class BackgroundLoops {
 public:
  /// Starts the thread. `read` is called from it, with frames that were handed to fused(); it must not share state with
  /// the source of the frames.
  BackgroundLoops(LoopCloser closer, const TsdfConfig& map, const PinholeCamera& camera, ReadFrame read);
  /// Gives up what is not done yet.
  ~BackgroundLoops();
  BackgroundLoops(const BackgroundLoops&) = delete;
  BackgroundLoops& operator=(const BackgroundLoops&) = delete;

  /// Hands over a frame that was fused at this pose. Its images are taken, so that the newest frames need not be read.
  void fused(const Pose& T_world_camera, Frame frame);

  /// Exchanges the map where a corrected one holds every frame so far. @return whether it did. Microseconds: what is in
  /// the old map is freed by the other thread.
  bool correct(Reconstruction& reconstruction);

  /// Waits for what is left, with the last frame as a keyframe. Then no frame may follow. Errors: those of reading
  /// frames and of ray casting, from any time since the start.
  [[nodiscard]] Status finish();

  /// Gives up what is not done yet. Then no frame may follow; poses and counts are those of what was done.
  void give_up();

  /// Returns the pose at which each frame is in the reconstruction's map: that of the last exchange, and those handed
  /// over since. In the order of fused().
  [[nodiscard]] std::vector<Pose> poses_in_map() const;

  /// After finish(): the corrected pose of every frame, in the order of fused(); what was counted; the closures.
  [[nodiscard]] std::vector<Pose> poses() const;
  [[nodiscard]] const LoopCounts& counts() const;
  [[nodiscard]] std::vector<Closure> closures() const;
  /// Returns how often correct() exchanged the map.
  [[nodiscard]] std::size_t exchanges() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace saccade
