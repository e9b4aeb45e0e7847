// SPDX-License-Identifier: Apache-2.0
// saccade annotate with a page: a person labels the cloud, or the clouds of a folder, in the browser.
#include <mutex>

#include "annotate.hpp"
#include "saccade/io/sessions/label_presets.hpp"
#include "serve.hpp"
#include "server/annotate/annotation_service.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Posts work of the service to the server, as long as there is one.
class ServerHandle {
 public:
  explicit ServerHandle(server::HttpServer& server) : server_{&server} {}
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

/// Keeps labels of another program from being replaced where --out is not given. invalid_argument.
Status check_default_labels(const fs::path& file, const CloudJob& job) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  const bool ours = fs::exists(names_of(file), ignored);
  const bool is_seeds = !job.seeds.empty() && fs::equivalent(file, job.seeds, ignored);
  if (ours && !is_seeds) return {};
  return Error{Errc::invalid_argument,
               "is there already, and would be replaced by the labels; name another place: --out", file.string()};
}

Result<JobList> plan_page(AnnotateOptions options, const GlobalOptions& global) {
  if (options.of_folder() && options.session.empty()) options.session = options.cloud;
  SACCADE_TRY(JobList list, plan_jobs(options));
  std::vector<CloudJob>& jobs = list.jobs;
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
  return list;
}

Result<server::AnnotationServiceConfig> service_config(const AnnotateOptions& options, std::span<const CloudJob> jobs,
                                                       const GlobalOptions& global) {
  server::AnnotationServiceConfig config;
  const fs::path shown = options.cloud.has_filename() ? options.cloud : options.cloud.parent_path();
  config.title = shown.filename().string();
  if (options.clouds.size() > 1) config.title += " and " + std::to_string(options.clouds.size() - 1) + " more";
  config.version = SACCADE_VERSION;
  config.is_sequence = options.is_sequence();
  config.threads = global.threads;
  config.start.graph = options.graph;
  config.start.checks = options.given_graph;
  config.start.seed_share = options.seed_share;
  config.start.room = options.room;
  config.start.tiles_above_points = options.tiles_above_points;
  if (!options.presets.empty()) {
    SACCADE_TRY(config.start.presets, read_label_presets(options.presets));
  }
  for (const CloudJob& job : jobs) {
    config.clouds.push_back(
        {job.cloud, job.session, job.seeds, job.files.out, job.files.names, job.segments, job.T_world_cloud});
  }
  return config;
}

class ServedAnnotation final : public AnnotatePage {
 public:
  ServedAnnotation(const AnnotateOptions& options, const GlobalOptions& global, JobList list,
                   server::AnnotationServiceConfig config, std::unique_ptr<server::HttpServer> server)
      : options_{options},
        global_{global},
        jobs_{std::move(list.jobs)},
        notes_{std::move(list.notes)},
        server_{std::move(server)},
        posts_{std::make_shared<ServerHandle>(*server_)},
        service_{std::move(config), *server_,
                 [posts = posts_](std::function<void()> work) { posts->post(std::move(work)); }} {}
  ServedAnnotation(const ServedAnnotation&) = delete;
  ServedAnnotation& operator=(const ServedAnnotation&) = delete;
  ~ServedAnnotation() override {
    posts_->close();
    server_.reset();  // before the service that it serves
  }

  /// Finds what is wrong with one cloud or its session before there is a page. Ctrl-C does not wait for a large cloud
  /// to be read: nothing of it has to be kept, and a session is whole at any time.
  [[nodiscard]] Status prepare() {
    return run_before_page("annotate", *server_, [this] { return service_.prepare(0); });
  }

  [[nodiscard]] json result() const override {
    json clouds = json::array();
    for (const CloudJob& job : jobs_) {
      clouds.push_back(
          {{"file", job.cloud.string()}, {"session", job.session.string()}, {"labels", job.files.out.string()}});
    }
    json result{{"clouds", std::move(clouds)}};
    if (!notes_.empty()) result["notes"] = notes_;
    return result;
  }

  void serve() override { cli::serve(options_.serve, global_, *server_, service_); }

 private:
  const AnnotateOptions& options_;
  const GlobalOptions& global_;
  std::vector<CloudJob> jobs_;
  std::vector<std::string> notes_;
  std::unique_ptr<server::HttpServer> server_;
  std::shared_ptr<ServerHandle> posts_;
  server::AnnotationService service_;
};

}  // namespace

bool AnnotateOptions::opens_page() const {
  return page || !serve.given.empty() || (truth.empty() && script.empty() && session.empty() && seeds.empty());
}

Result<std::unique_ptr<AnnotatePage>> AnnotatePage::open(const AnnotateOptions& options, const GlobalOptions& global) {
  SACCADE_TRY(JobList list, plan_page(options, global));
  SACCADE_TRY(server::AnnotationServiceConfig config, service_config(options, list.jobs, global));
  SACCADE_TRY(std::unique_ptr<server::HttpServer> server, listen(options.serve));
  auto page =
      std::make_unique<ServedAnnotation>(options, global, std::move(list), std::move(config), std::move(server));
  if (!options.of_several()) SACCADE_CHECK(page->prepare());
  return std::unique_ptr<AnnotatePage>{std::move(page)};
}

}  // namespace saccade::cli
