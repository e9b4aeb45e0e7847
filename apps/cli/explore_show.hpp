// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExploreShow: an exploration in the browser, and in Foxglove, while it runs.

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "explore_devices.hpp"
#include "serve.hpp"
#include "server/foxglove/foxglove_hub.hpp"
#include "server/show/run_reader.hpp"
#include "server/show/viewer_service.hpp"

namespace saccade::cli {

/// Reads the run's folder on a thread of its own whenever the run says that there is something new; the run does not
/// wait for it.
class ExploreShow {
 public:
  /// Serves the page and says where it is. `bar` outlives finish(). Errors: those of listen().
  [[nodiscard]] static Result<std::unique_ptr<ExploreShow>> start(const ServeOptions& options,
                                                                  const GlobalOptions& global, const Scene& scene,
                                                                  const std::filesystem::path& folder,
                                                                  ProgressBar& bar);
  ~ExploreShow();

  /// Takes the run's messages, for Foxglove.
  [[nodiscard]] std::unique_ptr<messages::MessageSink> message_sink() const;
  /// The folder has another view.
  void changed() { wake(Wanted::live); }
  /// The run is over; what it left is shown until Ctrl-C.
  void finish();

 private:
  enum class Wanted : std::uint8_t { nothing, live, end, stop };
  ExploreShow(std::unique_ptr<server::HttpServer> server, std::shared_ptr<server::FoxgloveHub> foxglove,
              const server::SceneDocument& document, const std::filesystem::path& folder, ProgressBar& bar);
  void wake(Wanted wanted);
  void read_and_show();

  std::optional<BrowserPage> page_;
  std::unique_ptr<server::HttpServer> server_;
  std::shared_ptr<server::FoxgloveHub> foxglove_;
  std::unique_ptr<server::ViewerService> service_;
  server::RunReader reader_;
  ProgressBar& bar_;
  std::mutex mutex_;
  std::condition_variable woken_;
  Wanted wanted_{Wanted::nothing};
  std::thread thread_;
};

}  // namespace saccade::cli
