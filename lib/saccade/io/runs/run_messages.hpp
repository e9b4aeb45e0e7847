// SPDX-License-Identifier: Apache-2.0
#pragma once
// RunMessages: a run as messages of ROS, for RViz, Foxglove and recordings. docs/guides/looking-at-runs.md.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "saccade/explore/recorder.hpp"
#include "saccade/io/messages/message_sink.hpp"

namespace saccade {

struct RunMessagesConfig {
  std::string frame_id{"world"};
  std::string camera_frame_id{"saccade_camera"};
  std::string prefix{"/saccade"};      ///< prefix of every topic except /tf
  std::size_t most_points{1'000'000};  ///< larger clouds are thinned evenly
  std::size_t most_candidates{200};    ///< keeps the best by gain
  /// Time of messages; the system's clock by default.
  std::function<messages::Time()> now{};
  /// Called once for each sink that fails; it gets no more messages, and the run continues.
  std::function<void(const Error&)> failed{};
};

/// Sends after the scan and each view: the occupied voxels with their colours, the frontier, a plan of the workspace,
/// the view's candidates, the camera's path, and its depth.
class RunMessages final : public Recorder {
 public:
  RunMessages(RunMessagesConfig config, const PinholeCamera& camera);
  void add(std::unique_ptr<messages::MessageSink> sink);
  /// Finishes its sinks. Call it at the end of a run, for whatever reason it ends.
  void finish();

  [[nodiscard]] Status scanned(ScanRecord& scan, const TsdfSnapshot& map) override;
  [[nodiscard]] Status viewed(ViewRecord& view, const TsdfSnapshot& map, std::span<const Frame> frames) override;

 private:
  [[nodiscard]] messages::Header header() const;
  template <class Message>
  void send(const std::string& topic, const Message& message);
  void send_map(const TsdfSnapshot& map);
  void send_view(const ViewRecord& view);
  void send_frame(const Frame& frame);
  void flush();
  [[nodiscard]] bool silent() const;
  void end(std::unique_ptr<messages::MessageSink>& sink, const Status& status);

  RunMessagesConfig config_;
  PinholeCamera camera_;
  messages::Time time_;
  std::vector<std::unique_ptr<messages::MessageSink>> sinks_;
};

}  // namespace saccade
