// SPDX-License-Identifier: Apache-2.0
#pragma once
// RunReader: the folder of a run as a document, again and again while the run goes on.

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

/// One thread at a time. What a folder holds: docs/formats.md. Of an exploration without maps of its views, as older
/// versions left them, the steps have poses, facts, pictures and the arm.
class RunReader {
 public:
  RunReader(std::filesystem::path folder, const Executor& executor);

  /// Steps that were read before are kept as they are. A journal goes before a result: of two runs in one folder it is
  /// that of the later one.
  /// @param live  the run goes on.
  /// @return not_found for a folder without a run; errors of the readers, naming the file.
  [[nodiscard]] Result<SceneDocument> read(bool live);

 private:
  struct ReadStep {
    Step step;
    std::vector<Layer> layers;
  };
  struct StepMap {
    std::size_t step{0};
    TsdfSnapshot map;
    TriangleMesh mesh;
  };

  [[nodiscard]] Result<nlohmann::json> read_result() const;
  [[nodiscard]] Status read_steps(const nlohmann::json& result);
  [[nodiscard]] Status read_step(const nlohmann::json& result, const nlohmann::json& view, std::size_t number);
  [[nodiscard]] Status add_choice(const nlohmann::json& result, std::size_t number, ReadStep& out);
  [[nodiscard]] Status add_attention(const StepMap& before, const ViewChoice& choice, std::size_t step,
                                     std::vector<Layer>& layers);
  void add_arm(const nlohmann::json& result, const std::optional<Configuration>& q, ReadStep& out);
  [[nodiscard]] Status add_map(std::size_t number, ReadStep& out);
  [[nodiscard]] Status add_end(SceneDocument& document) const;
  void add_trajectory(SceneDocument& document) const;

  std::filesystem::path folder_;
  Executor executor_;
  std::vector<ReadStep> steps_;
  std::optional<StepMap> last_map_;  ///< of the last step that has one
  AttentionLook attention_;
  std::string arm_name_;
  std::optional<ArmModel> arm_;  ///< of that name; nullopt: none could be read
  std::string why_no_arm_;       ///< it is not shown; empty: it is
};

}  // namespace saccade::server
