// SPDX-License-Identifier: Apache-2.0
#include "explore_show.hpp"

#include <chrono>

#include "interrupt.hpp"

namespace saccade::cli {
namespace {

/// Returns the document that is shown before the scan is done.
server::SceneDocument first_document(const Scene& scene) {
  server::SceneDocument document;
  document.title = "Exploration of " + scene.name;
  document.kind = server::DocumentKind::run;
  document.live = true;
  document.bounds = scene.workspace;
  document.facts = {{"scene", scene.name}, {"state", "scanning"}};
  document.layers = {server::box_layer("workspace", "Workspace", scene.workspace)};
  return document;
}

}  // namespace

Result<std::unique_ptr<ExploreShow>> ExploreShow::start(const ServeOptions& options, const GlobalOptions& global,
                                                        const Scene& scene, const std::filesystem::path& folder,
                                                        ProgressBar& bar) {
  auto foxglove = std::make_shared<server::FoxgloveHub>();
  SACCADE_TRY(std::unique_ptr<server::HttpServer> server, listen(options, foxglove));
  std::unique_ptr<ExploreShow> show{
      new ExploreShow{std::move(server), std::move(foxglove), first_document(scene), folder, bar}};
  show->server_->serve(*show->service_);
  announce_foxglove(*show->server_);
  show->page_ = announce(options, global, *show->server_);
  return show;
}

ExploreShow::ExploreShow(std::unique_ptr<server::HttpServer> server, std::shared_ptr<server::FoxgloveHub> foxglove,
                         const server::SceneDocument& document, const std::filesystem::path& folder, ProgressBar& bar)
    : server_{std::move(server)}, foxglove_{std::move(foxglove)}, reader_{folder, Executor{}}, bar_{bar} {
  server::HttpServer* const serving = server_.get();
  const auto post = [serving](std::function<void()> work) { serving->post(std::move(work)); };
  service_ = std::make_unique<server::ViewerService>(*server_, server::ViewerConfig{SACCADE_VERSION, post}, document);
  thread_ = std::thread{[this] { read_and_show(); }};
}

ExploreShow::~ExploreShow() {
  wake(Wanted::stop);
  thread_.join();
  server_.reset();  // before the service that it calls
}

std::unique_ptr<messages::MessageSink> ExploreShow::message_sink() const {
  return std::make_unique<server::FoxgloveSink>(foxglove_, nullptr);
}

void ExploreShow::wake(Wanted wanted) {
  {
    const std::scoped_lock lock{mutex_};
    wanted_ = wanted;
  }
  woken_.notify_one();
}

void ExploreShow::read_and_show() {
  for (;;) {
    Wanted wanted{Wanted::nothing};
    {
      std::unique_lock lock{mutex_};
      woken_.wait(lock, [this] { return wanted_ != Wanted::nothing; });
      wanted = std::exchange(wanted_, Wanted::nothing);
    }
    if (wanted == Wanted::stop) return;
    // A folder that cannot be read now may be complete the next time; the run itself reports what it cannot write, and
    // goes on whatever becomes of its picture.
    try {
      if (auto document = reader_.read(wanted == Wanted::live)) service_->update(*document);
    } catch (const std::exception&) {
      continue;
    }
  }
}

void ExploreShow::finish() {
  constexpr std::chrono::milliseconds kPoll{100};
  wake(Wanted::end);
  bar_.note("the run is over; it is shown until Ctrl-C");
  while (!interrupted()) std::this_thread::sleep_for(kPoll);
}

}  // namespace saccade::cli
