// SPDX-License-Identifier: Apache-2.0
// saccade annotate with a page: a person labels the cloud, or the clouds of a folder, in the browser.
#include <chrono>
#include <cstdlib>
#include <future>
#include <iostream>
#include <mutex>

#include "annotate.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "json_output.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/sessions/label_presets.hpp"
#include "serve.hpp"
#include "server/annotate/annotation_service.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What the service posts goes to the server, as long as there is one.
class PostBox {
 public:
  explicit PostBox(server::HttpServer& server) : server_{&server} {}
  void post(std::function<void()> work) {
    const std::lock_guard lock{mutex_};
    if (server_ != nullptr) server_->post(std::move(work));
  }
  void close() {
    const std::lock_guard lock{mutex_};
    server_ = nullptr;
  }

 private:
  std::mutex mutex_;
  server::HttpServer* server_;
};

/// NAME_labels.SUFFIX beside a cloud; of a folder labels/NAME.SUFFIX in it, as labels are no clouds of the folder.
fs::path default_labels(const AnnotateOptions& options, const fs::path& cloud) {
  fs::path file = labels_beside(options.of_folder() ? options.cloud / "labels" : cloud.parent_path(), cloud);
  if (!options.of_folder()) file.replace_filename(file.stem().string() + "_labels" + file.extension().string());
  if (!check_labels_path(file)) file.replace_extension(".pcd");
  return file;
}

fs::path names_of(const fs::path& labels) { return fs::path{labels}.replace_extension(".names.json"); }

/// Labels that somebody else has put where they go unasked stay there.
Status check_default_labels(const fs::path& file, const CloudJob& job) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  const bool ours = fs::exists(names_of(file), ignored);
  const bool is_seeds = !job.seeds.empty() && fs::equivalent(file, job.seeds, ignored);
  if (ours && !is_seeds) return {};
  return Error{Errc::invalid_argument,
               "is there already, and would be replaced by the labels; name another place: --out", file.string()};
}

Result<std::vector<CloudJob>> plan_page(AnnotateOptions options, const GlobalOptions& global) {
  if (options.of_folder() && options.session.empty()) options.session = options.cloud;
  SACCADE_TRY(std::vector<CloudJob> jobs, plan_jobs(options));
  for (CloudJob& job : jobs) {
    if (job.session.empty()) job.session = fs::path{job.cloud}.replace_extension(".sacann");
  }
  SACCADE_CHECK(check_outputs(options, jobs, global));
  for (CloudJob& job : jobs) {
    if (job.files.out.empty()) {
      job.files.out = default_labels(options, job.cloud);
      SACCADE_CHECK(check_default_labels(job.files.out, job));
    }
    if (job.files.names.empty()) job.files.names = names_of(job.files.out);
  }
  return jobs;
}

Result<server::AnnotationServiceConfig> service_config(const AnnotateOptions& options, std::span<const CloudJob> jobs,
                                                       const GlobalOptions& global) {
  server::AnnotationServiceConfig config;
  const fs::path shown = options.cloud.has_filename() ? options.cloud : options.cloud.parent_path();
  config.title = shown.filename().string();
  config.version = SACCADE_VERSION;
  config.threads = global.threads;
  config.start.graph = options.graph;
  config.start.checks = options.given_graph;
  config.start.seed_share = options.seed_share;
  if (!options.presets.empty()) {
    SACCADE_TRY(config.start.presets, read_label_presets(options.presets));
  }
  for (const CloudJob& job : jobs) {
    config.clouds.push_back({job.cloud, job.session, job.seeds, job.files.out, job.files.names});
  }
  return config;
}

/// Of one cloud what is wrong with it or its session is said before there is a page. Whoever ends the program meanwhile
/// does not wait for a large cloud to be read: what is not read has nothing to keep, and a session is whole at any
/// time.
Status prepare(server::AnnotationService& service, server::HttpServer& server) {
  constexpr std::chrono::milliseconds kLookEvery{50};
  auto prepared = std::make_shared<std::promise<Status>>();
  std::future<Status> done = prepared->get_future();
  server.post([&service, prepared] { prepared->set_value(service.prepare(0)); });
  while (done.wait_for(kLookEvery) != std::future_status::ready) {
    if (!interrupted()) continue;
    std::cerr << "saccade annotate: interrupted" << std::endl;
    std::_Exit(interrupt_status());
  }
  return done.get();
}

}  // namespace

bool AnnotateOptions::opens_page() const {
  return page || !serve.given.empty() || (truth.empty() && script.empty() && session.empty() && seeds.empty());
}

Result<int> serve_annotation(const AnnotateOptions& options, const GlobalOptions& global) {
  const Stopwatch clock;
  SACCADE_TRY(const std::vector<CloudJob> jobs, plan_page(options, global));
  SACCADE_TRY(server::AnnotationServiceConfig config, service_config(options, jobs, global));
  SACCADE_TRY(std::unique_ptr<server::HttpServer> server, listen(options.serve));
  const auto posts = std::make_shared<PostBox>(*server);
  server::AnnotationService service{std::move(config), *server,
                                    [posts](std::function<void()> work) { posts->post(std::move(work)); }};
  Status ready;
  if (!options.of_folder()) ready = prepare(service, *server);
  const int status = ready ? serve(options.serve, global, *server, service) : 0;
  posts->close();
  server.reset();  // before the service that it serves
  if (!ready) return ready.error();
  json clouds = json::array();
  for (const CloudJob& job : jobs) {
    clouds.push_back(
        {{"file", job.cloud.string()}, {"session", job.session.string()}, {"labels", job.files.out.string()}});
  }
  SACCADE_CHECK(
      write_result("annotate", global, global.executor(), {{"total", clock.elapsed_ms()}}, {{"clouds", clouds}}));
  return status;
}

}  // namespace saccade::cli
