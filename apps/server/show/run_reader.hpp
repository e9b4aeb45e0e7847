// SPDX-License-Identifier: Apache-2.0
#pragma once
// RunReader: the folder of a run as a document, re-read while the run continues.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "saccade/arm/arm_model.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/explore/view_record.hpp"
#include "server/show/map_layers.hpp"
#include "server/show/scene_document.hpp"

namespace saccade::server {

/// Reader of a run folder. One thread at a time. Content of a folder: docs/reference/formats.md. Without maps of views,
/// as in older versions, the steps have poses, facts, images and the arm. The update of a cell has the views of all its
/// tasks, in their order.
class RunReader {
 public:
  /// @param up  stated by the user; else files in the folder tell it, and without any it is z.
  RunReader(std::filesystem::path folder, const Executor& executor, std::optional<Eigen::Vector3d> up = {});

  /// Reads the folder. Steps that were read before are kept. A journal takes precedence over a result: with two runs in
  /// one folder it belongs to the later one.
  /// @param live  the run continues.
  /// @return not_found for a folder without a run, saying what its page is, if it has one; errors of the readers,
  /// naming the file.
  [[nodiscard]] Result<SceneDocument> read(bool live);

 private:
  struct ReadStep {
    Step step;
    std::vector<Layer> layers;
  };
  /// A view in the record.
  struct RecordedView {
    std::size_t number{0};  ///< from 1, in its task
    std::size_t task{0};    ///< from 1; 0: the run has no tasks
    nlohmann::json view{};
  };
  struct StepMap {
    std::size_t step{0};
    TsdfSnapshot map;
    TriangleMesh mesh;
  };

  /// Returns the record that a command wrote of the run, or would write if it ended now.
  [[nodiscard]] Result<nlohmann::json> read_record() const;
  [[nodiscard]] Status read_steps(const nlohmann::json& result);
  [[nodiscard]] Status read_step(const nlohmann::json& result, const RecordedView& recorded);
  [[nodiscard]] static std::vector<RecordedView> views_in(const nlohmann::json& result);
  [[nodiscard]] Status add_choice(const nlohmann::json& result, std::size_t number, ReadStep& out);
  [[nodiscard]] Status add_attention(const StepMap& before, const ViewChoice& choice, std::size_t step,
                                     std::vector<Layer>& layers);
  void add_arm(const nlohmann::json& result, const std::optional<Configuration>& q, ReadStep& out);
  [[nodiscard]] Status add_map(std::size_t number, ReadStep& out);
  [[nodiscard]] Status add_end(SceneDocument& document) const;
  void add_trajectory(SceneDocument& document) const;

  std::filesystem::path folder_;
  Executor executor_;
  std::optional<Eigen::Vector3d> up_;
  std::vector<ReadStep> steps_;
  std::optional<StepMap> last_map_;  ///< map of the last step that has one
  AttentionLook attention_;
  std::string arm_name_;
  std::optional<ArmModel> arm_;  ///< arm of that name; nullopt: not readable
  std::string why_no_arm_;       ///< reason why it is not shown; empty: it is shown
};

}  // namespace saccade::server
