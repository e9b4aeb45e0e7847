// SPDX-License-Identifier: Apache-2.0
#include "server/annotate/open_cloud.hpp"

#include <limits>

#include "saccade/annotate/annotation_error.hpp"
#include "saccade/annotate/annotation_margin.hpp"
#include "saccade/io/clouds/label_io.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade::server {
namespace {

CloudFacts facts_of(const LoadedCloud& cloud) {
  const std::span<const Eigen::Vector3f> positions_m{cloud.points.positions_m};
  CloudFacts facts;
  facts.least_m.setConstant(std::numeric_limits<float>::max());
  facts.greatest_m.setConstant(std::numeric_limits<float>::lowest());
  for (const Eigen::Vector3f& p : positions_m) {
    if (!p.allFinite()) continue;
    ++facts.finite;
    facts.least_m = facts.least_m.cwiseMin(p);
    facts.greatest_m = facts.greatest_m.cwiseMax(p);
  }
  facts.upright = find_upright(positions_m, cloud.upright_hints);
  return facts;
}

}  // namespace

OpenCloud::OpenCloud(LoadedCloud cloud, std::size_t tiles_above_points, const Executor& executor)
    : executor_{executor}, cloud_{std::move(cloud)}, facts_{facts_of(cloud_)} {
  const std::span<const Eigen::Vector3f> positions_m{cloud_.points.positions_m};
  if (facts_.finite > tiles_above_points) {
    tiles_.emplace(positions_m, executor);
    facts_.spacing_m = tiles_->typical_spacing_m(positions_m, executor);
  } else {
    facts_.spacing_m = typical_spacing_m(positions_m, order(), executor);
  }
}

const DisplayOrder& OpenCloud::order() const {
  if (!order_) order_.emplace(cloud_.points.positions_m);
  return *order_;
}

OpenCloud::~OpenCloud() {
  if (!builder_.joinable()) return;
  building_->request_cancel();
  builder_.join();
}

Result<std::unique_ptr<OpenCloud>> OpenCloud::open(const ServedCloud& served, const SessionStart& start,
                                                   const Executor& executor, const Progress& progress) {
  constexpr std::size_t kStages{2};
  progress.report("reading", 0, kStages);
  SACCADE_TRY(LoadedCloud loaded, load_cloud(served.cloud));
  progress.report("reading", 1, kStages);
  std::unique_ptr<OpenCloud> cloud{new OpenCloud{std::move(loaded), start.tiles_above_points, executor}};
  cloud->served_ = served;
  cloud->start_ = start;
  const PointCloud& points = cloud->cloud_.points;
  if (!served.segments.empty()) {
    SACCADE_TRY(cloud->segments_, read_labels(served.segments, points.positions_m.size()));
  }
  cloud->subject_ = {served.cloud.filename().string(), points.positions_m.size(), hash_positions(points), start.graph};
  SACCADE_TRY(cloud->opened_, open_journal(served.session, cloud->subject_, start.checks));
  cloud->subject_.graph = cloud->opened_->saved.subject.graph;
  cloud->count(cloud->opened_->saved.actions);
  progress.report("reading", kStages, kStages);
  return cloud;
}

void OpenCloud::count(std::span<const AnnotationAction> actions) {
  sequence_ += actions.size();
  for (const AnnotationAction& action : actions) ++actions_by_client_[action.client];
}

Result<OpenCloud::Built> OpenCloud::build(const Executor& executor, const Progress& progress) const {
  const PointCloud& points = cloud_.points;
  SACCADE_TRY(Neighbourhood graph,
              in_file(build_graph(points, subject_.graph, start_.room, executor, progress), served_.cloud));
  Built built{std::make_shared<const Neighbourhood>(std::move(graph)), {}};
  if (served_.seeds.empty()) return built;
  progress.report("seeds", 0, 0);
  SACCADE_TRY(const std::vector<std::uint32_t> labels, read_labels(served_.seeds, points.positions_m.size()));
  SeedConfig config;
  config.share = start_.seed_share;
  SACCADE_TRY(built.seeds, in_file(label_seeds(built.graph, points, labels, config), served_.seeds));
  return built;
}

void OpenCloud::build_apart(const Executor& executor, Progress::Callback report,
                            std::function<void(std::shared_ptr<Result<Built>>)> finished) {
  SACCADE_EXPECTS(!builder_.joinable());
  building_ = std::make_shared<Progress>(std::move(report));
  builder_ = std::thread{[this, executor, progress = building_, finished = std::move(finished)] {
    try {
      finished(std::make_shared<Result<Built>>(build(executor, *progress)));
    } catch (const std::exception& problem) {  // there is no memory for it
      finished(std::make_shared<Result<Built>>(
          Error{Errc::unavailable, std::string{"the neighbourhood graph cannot be built: "} + problem.what(), {}}));
    }
  }};
}

void OpenCloud::begin(const Built& built) {
  SACCADE_EXPECTS(opened_ && !session_);
  graph_ = built.graph;
  const std::vector<AnnotationAction> before = opened_->saved.actions;
  session_ = AnnotationSession::restore(std::move(*opened_), graph_, executor_);
  opened_.reset();
  census_.emplace(annotation());
  begin_as_far_as_can_be(built.seeds, before);
}

void OpenCloud::begin_as_far_as_can_be(const std::optional<LabelSeeds>& seeds,
                                       std::span<const AnnotationAction> before) {
  if (read_only()) return;
  if (const Status begun = begin_with(seeds, before); !begun && !read_only()) failure_ = begun.error();
}

Status OpenCloud::begin_with(const std::optional<LabelSeeds>& seeds, std::span<const AnnotationAction> before) {
  // Seeds start an empty session, and continue one that was interrupted while planting.
  const std::optional<std::size_t> planted = seeds ? planted_before(*seeds, kProgramClient, before) : std::nullopt;
  for (std::size_t i = planted.value_or(0); planted && i < seeds->actions.size(); ++i) {
    const auto done = apply({kProgramClient, seeds->actions[i]});
    if (!done) return done.error();
  }
  const auto done = define(start_.presets);
  return done ? Status{} : done.error();
}

Result<OpenCloud::Change> OpenCloud::define(std::span<const NumberedLabel> labels) {
  std::vector<NumberedLabel> missing = missing_presets(labels, annotation());
  if (missing.empty()) return Change{{false, sequence_, {}, {}, {}}, {}};
  return apply({kProgramClient, DefineLabels{std::move(missing)}});
}

Result<std::filesystem::path> OpenCloud::begin_anew() {
  SACCADE_EXPECTS(ready());
  SACCADE_TRY(const std::filesystem::path kept, keep_aside(served_.session));
  auto session = AnnotationSession::open_or_create(served_.session, subject_.cloud_name, subject_.positions_hash,
                                                   graph_, executor_);
  if (!session) {
    std::error_code ignored;  // the earlier one exists at least under its new name
    std::filesystem::rename(kept, served_.session, ignored);
    return session.error();
  }
  session_ = std::move(*session);
  census_.emplace(annotation());
  margins_.clear();
  sequence_ = 0;
  actions_by_client_.clear();
  begin_as_far_as_can_be(std::nullopt, {});
  return kept;
}

Error OpenCloud::not_ready() const {
  return failure_.value_or(Error{Errc::unavailable, "the neighbourhood graph is being built; wait for \"ready\"", {}});
}

std::optional<Error> OpenCloud::read_only() const {
  if (failure_) return failure_;
  return session_ ? session_->read_only() : opened_->journal.refusal();
}

Result<OpenCloud::Change> OpenCloud::apply(AnnotationAction action) {
  const std::uint64_t client = action.client;
  SACCADE_TRY(const Applied applied, session_->apply(std::move(action)));
  if (!applied.done) return Change{applied, {}};
  sequence_ = applied.sequence;
  ++actions_by_client_[client];
  margins_.clear();
  return Change{applied, census_->update(annotation(), applied)};
}

std::span<const float> OpenCloud::margins() {
  if (margins_.empty()) margins_ = label_margins(annotation());
  return margins_;
}

std::span<const std::uint8_t> OpenCloud::ends() {
  if (ends_.empty()) {
    ends_ = cloud_ends(annotation().forest().neighbourhood(), cloud_.points.positions_m, cloud_.points.normals);
  }
  return ends_;
}

std::uint64_t OpenCloud::actions_of(std::uint64_t client) const {
  const auto found = actions_by_client_.find(client);
  return found == actions_by_client_.end() ? 0 : found->second;
}

bool OpenCloud::can_undo(std::uint64_t client) const { return ready() && annotation().history().can_undo(client); }
bool OpenCloud::can_redo(std::uint64_t client) const { return ready() && annotation().history().can_redo(client); }

}  // namespace saccade::server
