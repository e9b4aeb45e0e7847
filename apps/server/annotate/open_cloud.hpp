// SPDX-License-Identifier: Apache-2.0
#pragma once
// OpenCloud: a cloud that pages have open, with its annotation once the graph is built.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "saccade/annotate/graph_room.hpp"
#include "saccade/cloud/upright.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/progress.hpp"
#include "server/annotate/annotated_cloud.hpp"
#include "server/annotate/display_order.hpp"
#include "server/annotate/label_census.hpp"
#include "server/annotate/session_start.hpp"
#include "server/annotate/tiles.hpp"

namespace saccade::server {

/// Served cloud, and its files.
struct ServedCloud {
  std::filesystem::path cloud;
  std::filesystem::path session;
  std::filesystem::path seeds;           ///< labels that a session begins with; empty: none
  std::filesystem::path out;             ///< destination of `save` for the labels
  std::filesystem::path names;           ///< destination for the definitions of their numbers; empty: none
  std::filesystem::path segments{};      ///< segment of each point, to be accepted as labels; empty: none
  Pose T_world_cloud{Pose::Identity()};  ///< from the coordinates of the file
};

/// Settings for the beginning of sessions.
struct SessionStart {
  NeighbourhoodConfig graph;
  GraphRoom room;
  std::vector<GraphCheck> checks;  ///< checks of existing sessions
  std::vector<NumberedLabel> presets;
  double seed_share{0.99};
  std::size_t tiles_above_points{4'000'000};  ///< clouds with more finite points are kept as tiles, too
};

/// Facts about a cloud besides its points.
struct CloudFacts {
  std::size_t finite{0};
  Eigen::Vector3f least_m{0, 0, 0};
  Eigen::Vector3f greatest_m{0, 0, 0};
  double spacing_m{0.0};
  Upright upright{};
};

/// Client of the program's own actions: presets and seeds. No page can undo them.
inline constexpr std::uint64_t kProgramClient{0};

class OpenCloud {
 public:
  /// Slow results that depend on the cloud alone.
  struct Built {
    std::shared_ptr<const Neighbourhood> graph;
    std::optional<LabelSeeds> seeds;
  };
  /// Result of an action, with the labels whose rows changed.
  struct Change {
    Applied applied;
    std::set<std::uint32_t> labels;
  };

  /// Reads the cloud and locks its session, or begins one. Errors of load_cloud and open_journal.
  [[nodiscard]] static Result<std::unique_ptr<OpenCloud>> open(const ServedCloud& served, const SessionStart& start,
                                                               const Executor& executor, const Progress& progress);
  OpenCloud(const OpenCloud&) = delete;
  OpenCloud& operator=(const OpenCloud&) = delete;
  /// Cancels a running build.
  ~OpenCloud();

  /// Build the graph: at once, or on a separate thread, which calls `finished` at its end.
  [[nodiscard]] Result<Built> build(const Executor& executor, const Progress& progress) const;
  void build_apart(const Executor& executor, Progress::Callback report,
                   std::function<void(std::shared_ptr<Result<Built>>)> finished);
  /// Begins the annotation with the built graph. It is read-only where seeds or presets cannot be kept.
  void begin(const Built& built);
  /// Defines labels of which something else is known; `done` is false where there are none. Expects that it is ready.
  [[nodiscard]] Result<Change> define(std::span<const NumberedLabel> labels);
  /// Keeps the session under another name, which it returns, and begins an empty one. Expects that it is ready. Answers
  /// io_failure; then nothing has changed.
  [[nodiscard]] Result<std::filesystem::path> begin_anew();

  [[nodiscard]] const LoadedCloud& cloud() const { return cloud_; }
  /// Returns the order for pages without tiles. For a cloud with tiles it is made when it is first asked for.
  [[nodiscard]] const DisplayOrder& order() const;
  /// Returns the tiles; null: the cloud is not that large.
  [[nodiscard]] const Tiles* tiles() const { return tiles_ ? &*tiles_ : nullptr; }
  [[nodiscard]] const CloudFacts& facts() const { return facts_; }
  /// Returns the segment of each point, 0 for none; empty: there are no segments.
  [[nodiscard]] std::span<const std::uint32_t> segments() const { return segments_; }
  [[nodiscard]] const NeighbourhoodConfig& graph_config() const { return subject_.graph; }

  [[nodiscard]] bool ready() const { return census_.has_value(); }
  /// Returns why it cannot be annotated now: unavailable while the graph is built, or the reason of a failure.
  [[nodiscard]] Error not_ready() const;
  void fail(Error error) { failure_ = std::move(error); }
  /// Returns why nothing can be changed; nullopt: changes are or will be possible.
  [[nodiscard]] std::optional<Error> read_only() const;

  // These expect that it is ready.
  [[nodiscard]] const Annotation& annotation() const { return session_->annotation(); }
  [[nodiscard]] const LabelCensus& census() const { return *census_; }
  /// Applies an action as AnnotationSession::apply.
  [[nodiscard]] Result<Change> apply(AnnotationAction action);
  /// Returns label_margins, cached until the next action.
  [[nodiscard]] std::span<const float> margins();
  /// Returns cloud_ends.
  [[nodiscard]] std::span<const std::uint8_t> ends();

  /// Return the number of actions in the session, including undo and redo: in all, and of one client.
  [[nodiscard]] std::uint64_t sequence() const { return sequence_; }
  [[nodiscard]] std::uint64_t actions_of(std::uint64_t client) const;
  [[nodiscard]] bool can_undo(std::uint64_t client) const;
  [[nodiscard]] bool can_redo(std::uint64_t client) const;

 private:
  OpenCloud(LoadedCloud cloud, std::size_t tiles_above_points, const Executor& executor);
  [[nodiscard]] Status begin_with(const std::optional<LabelSeeds>& seeds, std::span<const AnnotationAction> before);
  void begin_as_far_as_can_be(const std::optional<LabelSeeds>& seeds, std::span<const AnnotationAction> before);
  void count(std::span<const AnnotationAction> actions);

  Executor executor_;
  ServedCloud served_;
  SessionStart start_;
  LoadedCloud cloud_;
  mutable std::optional<DisplayOrder> order_;
  std::optional<Tiles> tiles_;
  std::vector<std::uint32_t> segments_;
  CloudFacts facts_;
  SessionSubject subject_;
  std::optional<AnnotationJournal::Opened> opened_;  ///< until it is ready
  std::shared_ptr<const Neighbourhood> graph_;
  std::optional<AnnotationSession> session_;
  std::optional<LabelCensus> census_;
  std::optional<Error> failure_;
  std::uint64_t sequence_{0};
  std::map<std::uint64_t, std::uint64_t> actions_by_client_;
  std::vector<float> margins_;  ///< empty: not computed
  std::vector<std::uint8_t> ends_;
  std::shared_ptr<Progress> building_;
  std::thread builder_;
};

}  // namespace saccade::server
