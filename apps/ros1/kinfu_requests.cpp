// SPDX-License-Identifier: Apache-2.0
#include "kinfu_requests.hpp"

#include <std_msgs/Header.h>
#include <std_msgs/String.h>
#include <unistd.h>

#include "kinfu_messages.hpp"

using saccade::ros1::MapAnswer;
using saccade::ros1::MapUpload;
using saccade::ros1::Question;

namespace {

constexpr double kKeep_s{30.0};
constexpr double kGrace_s{1.0};  ///< after the first subscriber: a latched message is sent after it connected
constexpr const char* kBusy{"16 requests are being answered already"};

std::string request_name(const kinfu_msgs::KinfuTsdfRequest& request) {
  return "request " + std::to_string(request.tsdf_header.request_id) + " of type " +
         std::to_string(request.tsdf_header.request_type);
}

double megabytes(const MapAnswer& answer) {
  return 1e-6 *
         (4.0 * static_cast<double>(answer.cloud.values.size()) + 16.0 * static_cast<double>(answer.triangles.size()));
}

}  // namespace

KinfuRequests::KinfuRequests(ros::NodeHandle node, saccade::ros1::KinfuMap& map, const RequestSettings& settings,
                             std::function<void()> on_reset)
    : node_{node},
      map_{map},
      settings_{settings},
      on_reset_{std::move(on_reset)},
      timer_{node_.createWallTimer(ros::WallDuration{0.2}, [this](const ros::WallTimerEvent&) { drop_kept(); })},
      subscriber_{node_.subscribe<kinfu_msgs::KinfuTsdfRequest>(
          settings.topic, 50, [this](const kinfu_msgs::KinfuTsdfRequest::ConstPtr& r) { on_message(r); })},
      requests_{node_, settings.action_name, [this](Requests::GoalHandle goal) { on_goal(goal); },
                [this](Requests::GoalHandle goal) { workers_.cancel(goal.getGoalID().id); }, false},
      uploads_{node_, settings.upload_name, [this](Uploads::GoalHandle goal) { on_upload(goal); },
               [this](Uploads::GoalHandle goal) { workers_.cancel(goal.getGoalID().id); }, false} {
  requests_.start();
  uploads_.start();
}

KinfuRequests::~KinfuRequests() = default;

KinfuRequests::Outcome KinfuRequests::answer(const kinfu_msgs::KinfuTsdfRequest& request,
                                             const std::atomic<bool>& cancelled) {
  Outcome outcome;
  MapAnswer answer = map_.answer(to_plain(request), cancelled);
  outcome.error = answer.error;
  outcome.cancelled = answer.cancelled;
  if (outcome.error.empty() && megabytes(answer) > settings_.largest_message_mb) {
    const std::string path = settings_.temporary_folder + "/kinfu-" + std::to_string(getpid()) + "-" +
                             std::to_string(files_++) + (answer.triangles.empty() ? ".pcd" : ".ply");
    outcome.error = saccade::ros1::write_answer(path, answer);
    outcome.result.file_name = path;
    answer = {};
  }
  const std::string file_name = outcome.result.file_name;
  outcome.result = to_message(answer, request, {settings_.frame_id, ros::Time::now()});
  outcome.result.file_name = file_name;
  if (outcome.error.empty() && request.request_reset) {
    map_.reset({});
    on_reset_();
  }
  return outcome;
}

void KinfuRequests::on_goal(Requests::GoalHandle goal) {
  const kinfu_msgs::KinfuTsdfRequest request = goal.getGoal()->request;
  if (request.tsdf_header.request_type > static_cast<std::uint32_t>(Question::view_score)) {
    goal.setRejected({}, "there is no request of type " + std::to_string(request.tsdf_header.request_type));
    return;
  }
  const auto work = [this, goal, request](const std::atomic<bool>& cancelled) mutable {
    const Outcome outcome = answer(request, cancelled);
    if (outcome.cancelled) {
      goal.setCanceled(outcome.result, outcome.error);
    } else if (!outcome.error.empty()) {
      goal.setAborted(outcome.result, outcome.error);
    } else {
      goal.setSucceeded(outcome.result);
    }
  };
  goal.setAccepted();
  if (!workers_.start(work, goal.getGoalID().id)) goal.setAborted({}, kBusy);
}

void KinfuRequests::on_upload(Uploads::GoalHandle goal) {
  goal.setAccepted();
  const auto work = [this, goal](const std::atomic<bool>& cancelled) mutable {
    MapUpload upload;
    std::string error = to_plain(*goal.getGoal(), upload);
    if (error.empty() && !cancelled) error = map_.upload(upload);
    kinfu_msgs::WorldUploadResult result;
    result.ok = error.empty() && !cancelled;
    if (cancelled) {
      goal.setCanceled(result, "the upload was cancelled");
    } else if (!error.empty()) {
      goal.setAborted(result, error);
    } else {
      goal.setSucceeded(result);
    }
  };
  if (!workers_.start(work, goal.getGoalID().id)) goal.setAborted({}, kBusy);
}

void KinfuRequests::on_message(const kinfu_msgs::KinfuTsdfRequest::ConstPtr& request) {
  const std::string name = request_name(*request);
  if (request->tsdf_header.request_source_name.empty()) {
    ROS_ERROR("%s names no topic for its answer (request_source_name)", name.c_str());
    return;
  }
  const auto work = [this, request, name](const std::atomic<bool>& cancelled) {
    const Outcome outcome = answer(*request, cancelled);
    if (!outcome.error.empty()) {
      ROS_ERROR("%s cannot be answered: %s", name.c_str(), outcome.error.c_str());
      return;
    }
    publish(*request, outcome.result);
  };
  if (!workers_.start(work, name)) ROS_ERROR("%s is not answered: %s", name.c_str(), kBusy);
}

void KinfuRequests::publish(const kinfu_msgs::KinfuTsdfRequest& request, const kinfu_msgs::RequestResult& result) {
  const std::string& topic = request.tsdf_header.request_source_name;
  if (!result.file_name.empty()) {
    std_msgs::String name;
    name.data = result.file_name;
    return keep(topic, name);
  }
  switch (static_cast<Question>(request.tsdf_header.request_type)) {
    case Question::ping: return keep(topic, result.header);
    case Question::mesh: return keep(topic, result.mesh);
    case Question::view: return keep(topic, result.image);
    case Question::voxel_count: return keep(topic, result.uint_values);
    case Question::voxelgrid:
    case Question::view_score: return keep(topic, result.float_values);
    default: return keep(topic, result.pointcloud);
  }
}

template <class Message>
void KinfuRequests::keep(const std::string& topic, const Message& message) {
  try {
    Kept kept{node_.advertise<Message>(topic, 1, true), ros::WallTime::now() + ros::WallDuration{kKeep_s}};
    if (!kept.publisher) throw ros::Exception{"another type is published there"};
    kept.publisher.publish(message);
    const std::scoped_lock lock{kept_mutex_};
    kept_.push_back(std::move(kept));
  } catch (const ros::Exception& error) {
    ROS_ERROR("an answer cannot be published as '%s': %s", topic.c_str(), error.what());
  }
}

void KinfuRequests::drop_kept() {
  const std::scoped_lock lock{kept_mutex_};
  const ros::WallTime now = ros::WallTime::now();
  for (Kept& kept : kept_) {
    if (kept.seen || kept.publisher.getNumSubscribers() == 0) continue;
    kept.seen = true;
    kept.until = std::min(kept.until, now + ros::WallDuration{kGrace_s});
  }
  kept_.remove_if([&](const Kept& kept) { return kept.until < now; });
}
