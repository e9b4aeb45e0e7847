// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotationService: serves the page of saccade annotate. docs/reference/protocol.md.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "saccade/annotate/carried_labels.hpp"
#include "saccade/core/executor.hpp"
#include "server/annotate/annotation_answers.hpp"
#include "server/annotate/open_cloud.hpp"
#include "server/annotate/sequence_labels.hpp"
#include "server/message.hpp"
#include "server/service.hpp"

namespace saccade::server {

struct AnnotationServiceConfig {
  std::string title;
  std::string version;
  std::vector<ServedCloud> clouds;  ///< at least one; no two share a file to be written
  SessionStart start;
  bool is_sequence{false};                    ///< labels mean the same in all clouds and can be carried between them
  std::size_t threads{0};                     ///< as in Executor
  std::size_t graph_at_once_points{300'000};  ///< clouds with more points build their graph in the background
  std::size_t most_open_points{40'000'000};   ///< limit over all open clouds; a single cloud may have more
  std::size_t most_shown_points{12'000'000};  ///< limit per page, whatever its budget
  std::uintmax_t most_session_bytes{std::uintmax_t{2} << 30U};  ///< then it accepts no more actions; in memory it takes
                                                                ///< four times as much
};

/// Service for annotation. Clouds are read when a page opens them, and kept while one has them open; of the others the
/// last one. Every action is on the disk before it is answered. Wrong questions are rejected; no message of a page ends
/// the program.
class AnnotationService final : public Service {
 public:
  /// Runs work on the service's thread, after earlier work. Any thread may call it while the service lives.
  using Post = std::function<void(std::function<void()>)>;

  AnnotationService(AnnotationServiceConfig config, Clients& clients, Post post);

  /// Opens a cloud before any page does, on the service's thread. Errors as for a page.
  [[nodiscard]] Status prepare(std::size_t index);

  void opened(ConnectionId connection) override;
  void received(ConnectionId connection, std::span<const std::uint8_t> message) override;
  void closed(ConnectionId connection) override;
  [[nodiscard]] HttpAnswer get(const HttpRequest& request) override;

 private:
  /// One connection.
  struct Page {
    ConnectionId id{0};
    std::uint64_t client{0};  ///< 0: before its hello
    std::string name;         ///< name of the person, as that person gives it; may be empty
    std::optional<std::size_t> cloud;
    std::size_t budget{0};
    ShownPoints shown;
  };
  using Handler = Status (AnnotationService::*)(Page&, const Question&);

  // Each answers a question, or says why not.
  Status hello(Page& page, const Question& question);
  Status name(Page& page, const Question& question);
  Status open(Page& page, const Question& question);
  Status points(Page& page, const Question& question);
  Status octree(Page& page, const Question& question);
  Status tiles(Page& page, const Question& question);
  Status field(Page& page, const Question& question);
  Status segments(Page& page, const Question& question);
  Status action(Page& page, const Question& question);
  Status root(Page& page, const Question& question);
  Status tree(Page& page, const Question& question);
  Status margins(Page& page, const Question& question);
  Status boxes(Page& page, const Question& question);
  Status next_click(Page& page, const Question& question);
  Status save(Page& page, const Question& question);
  Status begin_anew(Page& page, const Question& question);

  [[nodiscard]] static Handler handler_of(const std::string& type);
  Status answer(Page& page, const Question& question);
  void abandon(Page& page);

  // Clouds.
  [[nodiscard]] Result<OpenCloud*> opened_cloud(std::size_t index, Page* page);
  [[nodiscard]] Result<OpenCloud*> cloud_of(const Page& page);
  [[nodiscard]] Result<OpenCloud*> ready_cloud_of(const Page& page);
  [[nodiscard]] Result<std::optional<CarrySource>> source_of(const Page& page, const Question& question);
  /// Tells a cloud that becomes ready what labels mean in the sequence.
  void begin(OpenCloud& cloud, const OpenCloud::Built& built);
  /// Tells the other open clouds of a sequence what labels mean now.
  void share_labels(std::size_t index, const OpenCloud::Change& change);
  [[nodiscard]] Result<std::uint32_t> point_of(const OpenCloud& cloud, const Question& question) const;
  [[nodiscard]] Status check_room(std::size_t index) const;
  Status make_room(std::size_t index, const OpenCloud& cloud, Page* page);
  std::size_t drop_unused();
  void build(std::size_t index, OpenCloud& cloud);
  void built(std::size_t index, const OpenCloud* cloud, const Result<OpenCloud::Built>& built);
  /// Switches the page to another cloud, or to none; its former cloud may be dropped.
  void leave(Page& page, std::optional<std::size_t> next = {});
  void show(Page& page, const OpenCloud& cloud, bool tiled);
  [[nodiscard]] Result<const Tiles*> tiles_of(const Page& page);
  [[nodiscard]] Result<std::vector<std::uint32_t>> chosen_points(const Page& page, const OpenCloud& cloud,
                                                                 nlohmann::json& head, const Question& question) const;

  // Notices to all pages with an open cloud.
  [[nodiscard]] std::vector<Page*> pages_of(std::size_t index);
  void send_progress(std::size_t index, const std::string& stage, std::size_t done, std::size_t total);
  void send_people(std::size_t index);
  void send_ready(std::size_t index, const OpenCloud& cloud);
  /// Origin of an action, as its notice names it.
  struct Author {
    std::uint64_t client{0};
    std::string name;
  };
  void send_changes(std::size_t index, const Author& author, const OpenCloud& cloud, const OpenCloud::Change& change,
                    const nlohmann::json& action);
  void send_read_only(std::size_t index, const std::string& why);

  AnnotationServiceConfig config_;
  Clients& clients_;
  Post post_;
  Executor executor_;
  std::map<ConnectionId, Page> pages_;
  std::optional<std::size_t> last_used_;
  SequenceLabels labels_;
  std::map<std::size_t, std::unique_ptr<OpenCloud>> clouds_;  ///< open clouds, by index
};

}  // namespace saccade::server
