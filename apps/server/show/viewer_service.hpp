// SPDX-License-Identifier: Apache-2.0
#pragma once
// ViewerService: answers pages that view a document. docs/reference/protocol.md, "Viewer".

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "server/message.hpp"
#include "server/service.hpp"
#include "server/show/scene_document.hpp"

namespace saccade::server {

struct ViewerConfig {
  std::string version;  ///< version of the program, for hello
  /// Runs work on the service's thread: HttpServer::post.
  std::function<void(std::function<void()>)> post;
};

class ViewerService final : public Service {
 public:
  /// `clients` must outlive the service.
  ViewerService(Clients& clients, ViewerConfig config, const SceneDocument& document);

  /// Replaces the document and notifies pages. From any thread; the service must live until the posted work has run.
  void update(const SceneDocument& document);

  void opened(ConnectionId connection) override;
  void received(ConnectionId connection, std::span<const std::uint8_t> message) override;
  void closed(ConnectionId connection) override;
  [[nodiscard]] HttpAnswer get(const HttpRequest& request) override;

 private:
  using Buffers = std::map<std::string, std::shared_ptr<const LayerBuffer>, std::less<>>;

  /// Content that clients can request by name; nothing else is accessible.
  struct Shown {
    nlohmann::json document;
    Buffers buffers;
    std::map<std::string, std::filesystem::path, std::less<>> pictures;
    nlohmann::json report;                                            ///< null: there is none
    std::map<std::string, std::filesystem::path, std::less<>> files;  ///< pictures of the report
  };

  [[nodiscard]] static Shown prepare(const SceneDocument& document);
  void replace(Shown shown);
  [[nodiscard]] Result<SharedMessage> answer(ConnectionId connection, const Question& question);
  [[nodiscard]] Result<SharedMessage> answer_hello(ConnectionId connection, const Question& question);
  [[nodiscard]] Result<SharedMessage> answer_buffer(const Question& question) const;
  [[nodiscard]] HttpAnswer answer_report() const;

  Clients& clients_;
  ViewerConfig config_;
  Shown shown_;
  Buffers earlier_;  ///< buffers of the previous document, which pages may still be reading
  std::uint64_t revision_{1};
  std::set<ConnectionId> greeted_;  ///< connections that said hello and receive updates
};

}  // namespace saccade::server
