// SPDX-License-Identifier: Apache-2.0
#pragma once
// AnnotationService: what stands behind the page of saccade annotate. docs/protocol.md.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/executor.hpp"
#include "server/annotate/open_cloud.hpp"
#include "server/message.hpp"
#include "server/service.hpp"

namespace saccade::server {

struct AnnotationServiceConfig {
  std::string title;
  std::string version;
  std::vector<ServedCloud> clouds;  ///< at least one; no two share a file that is written
  SessionStart start;
  std::size_t threads{0};                     ///< as of Executor
  std::size_t graph_at_once_points{300'000};  ///< of more points the graph is built apart from questions
  std::size_t most_open_points{40'000'000};   ///< of all open clouds together; one alone may have more
  std::size_t most_shown_points{12'000'000};  ///< to a page, whatever its budget
  std::uintmax_t most_session_bytes{std::uintmax_t{2} << 30U};  ///< then it takes no more; in memory it has four times
};

/// Clouds are read when a page opens them, and kept while one has them open; of the others the last. Every action is on
/// the disk before it is answered. Questions that are wrong are refused; nothing that a page says ends the program.
class AnnotationService final : public Service {
 public:
  /// Runs work on the thread of the service, after what was posted before. Any thread may call it, as long as the
  /// service lives.
  using Post = std::function<void(std::function<void()>)>;

  AnnotationService(AnnotationServiceConfig config, Clients& clients, Post post);

  /// Opens a cloud before a page does. On the thread of the service. Errors as where a page opens it.
  [[nodiscard]] Status prepare(std::size_t index);

  void opened(ConnectionId connection) override;
  void received(ConnectionId connection, std::span<const std::uint8_t> message) override;
  void closed(ConnectionId connection) override;
  [[nodiscard]] HttpAnswer get(const HttpRequest& request) override;

 private:
  /// One connection.
  struct Page {
    ConnectionId id{0};
    std::uint64_t client{0};  ///< 0: it has not said hello
    std::optional<std::size_t> cloud;
    std::size_t budget{0};
    std::size_t shown{0};
  };
  using Handler = Status (AnnotationService::*)(Page&, const Question&);

  // Each answers, or says why not.
  Status hello(Page& page, const Question& question);
  Status open(Page& page, const Question& question);
  Status points(Page& page, const Question& question);
  Status action(Page& page, const Question& question);
  Status root(Page& page, const Question& question);
  Status tree(Page& page, const Question& question);
  Status margins(Page& page, const Question& question);
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
  [[nodiscard]] Result<std::uint32_t> point_of(const OpenCloud& cloud, const Question& question) const;
  [[nodiscard]] Status check_room(std::size_t index) const;
  Status make_room(std::size_t index, const OpenCloud& cloud, Page* page);
  std::size_t drop_unused();
  void build(std::size_t index, OpenCloud& cloud);
  void built(std::size_t index, const OpenCloud* cloud, const Result<OpenCloud::Built>& built);
  /// The page has this cloud instead, or none: the one that it had may be dropped.
  void leave(Page& page, std::optional<std::size_t> next = {});
  void show(Page& page, const OpenCloud& cloud);

  // Notices, to all pages that have a cloud open.
  [[nodiscard]] std::vector<Page*> pages_of(std::size_t index);
  void send_progress(std::size_t index, const std::string& stage, std::size_t done, std::size_t total);
  void send_people(std::size_t index);
  void send_ready(std::size_t index, const OpenCloud& cloud);
  void send_changes(std::size_t index, const OpenCloud& cloud, const OpenCloud::Change& change, std::uint64_t client);
  void send_read_only(std::size_t index, const std::string& why);

  AnnotationServiceConfig config_;
  Clients& clients_;
  Post post_;
  Executor executor_;
  std::map<ConnectionId, Page> pages_;
  std::optional<std::size_t> last_used_;
  std::map<std::size_t, std::unique_ptr<OpenCloud>> clouds_;  ///< that are open, by index
};

}  // namespace saccade::server
