// SPDX-License-Identifier: Apache-2.0
// The node surfel_next_best_view: rates camera poses by the known and unknown surfels that they would show.

#include <actionlib/server/action_server.h>
#include <ros/ros.h>
#include <surfel_next_best_view_msgs/EvaluatePosesAction.h>
#include <surfel_next_best_view_msgs/SetPointCloudAction.h>

#include <cstring>

#include "kinfu_messages.hpp"
#include "subcommands.hpp"
#include "surfel_scores.hpp"
#include "workers.hpp"

using namespace saccade::ros1;
using surfel_next_best_view_msgs::EvaluatePosesAction;
using surfel_next_best_view_msgs::EvaluatePosesGoal;
using surfel_next_best_view_msgs::EvaluatePosesResult;
using surfel_next_best_view_msgs::SetPointCloudAction;

namespace {

/// Returns the offset of a point's colour, which may be a float or an integer of four bytes.
int color_offset(const sensor_msgs::PointCloud2& cloud) {
  for (const auto& field : cloud.fields) {
    if ((field.name == "rgba" || field.name == "rgb") && field.offset + 4 <= cloud.point_step)
      return static_cast<int>(field.offset);
  }
  return -1;
}

std::string read_surfels(const sensor_msgs::PointCloud2& cloud, std::vector<PlainSurfel>& surfels) {
  const std::string wrong = read_points(
      cloud, {"x", "y", "z", "normal_x", "normal_y", "normal_z", "radius", "confidence"}, [&](const float* v) {
        PlainSurfel surfel;
        surfel.position = {v[0], v[1], v[2]};
        surfel.normal = {v[3], v[4], v[5]};
        surfel.radius = v[6];
        surfel.unknown = v[7] == 1.0F;
        surfel.rgba = {200, 200, 200, 255};
        surfels.push_back(surfel);
      });
  const int offset = color_offset(cloud);
  if (!wrong.empty() || offset < 0) return wrong;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const std::uint8_t* bgra = &cloud.data[i / cloud.width * cloud.row_step + i % cloud.width * cloud.point_step +
                                           static_cast<std::size_t>(offset)];
    surfels[i].rgba = {bgra[2], bgra[1], bgra[0], bgra[3]};
  }
  return {};
}

SurfelQuestion to_plain(const EvaluatePosesGoal& goal) {
  SurfelQuestion question;
  question.camera = {goal.width, goal.height, goal.focal_x, goal.focal_y, goal.center_x, goal.center_y};
  question.min_range = goal.range_min;
  question.max_range = goal.range_max;
  question.occupied_score = goal.occupied_score;
  question.unknown_score = goal.unknown_score;
  question.distance_weight = goal.distance_weight;
  question.absolute_weight = goal.absolute_weight;
  question.counted = {goal.filter_type, {goal.filter_data.begin(), goal.filter_data.end()}};
  question.present = {goal.input_filter_type, {goal.input_filter_data.begin(), goal.input_filter_data.end()}};
  question.with_images = goal.with_images;
  question.with_color = goal.with_color;
  question.with_clouds = goal.with_clouds;
  question.lighting = goal.enable_lighting;
  return question;
}

EvaluatePosesResult to_result(const std::vector<SurfelScore>& scores, const SurfelQuestion& question) {
  EvaluatePosesResult result;
  for (const SurfelScore& score : scores) {
    result.scores.push_back(score.score);
    result.occupied.push_back(score.occupied);
    result.unknown.push_back(score.unknown);
    result.out_of_range.push_back(score.out_of_range);
    if (question.with_images) {
      sensor_msgs::Image image;
      image.width = question.camera.width;
      image.height = question.camera.height;
      image.encoding = question.with_color ? "rgba8" : "mono8";
      image.step = image.width * (question.with_color ? 4 : 1);
      image.data = score.image;
      result.images.push_back(image);
    }
    if (question.with_clouds) result.clouds.push_back(to_message(score.cloud, {}));
  }
  return result;
}

class SurfelNode {
 public:
  explicit SurfelNode(ros::NodeHandle node)
      : subscriber_{node.subscribe<sensor_msgs::PointCloud2>("point_cloud", 2,
                                                             [this](const sensor_msgs::PointCloud2::ConstPtr& cloud) {
                                                               const std::string wrong = take(*cloud);
                                                               if (!wrong.empty())
                                                                 ROS_ERROR("a cloud of surfels is not used: %s",
                                                                           wrong.c_str());
                                                             })},
        set_cloud_{node, "set_point_cloud", [this](SetCloud::GoalHandle goal) { on_cloud(goal); }, false},
        evaluate_{node, "evaluate_poses", [this](Evaluate::GoalHandle goal) { on_evaluate(goal); },
                  [this](Evaluate::GoalHandle goal) { workers_.cancel(goal.getGoalID().id); }, false} {
    set_cloud_.start();
    evaluate_.start();
  }

 private:
  using SetCloud = actionlib::ActionServer<SetPointCloudAction>;
  using Evaluate = actionlib::ActionServer<EvaluatePosesAction>;

  std::string take(const sensor_msgs::PointCloud2& cloud) {
    std::vector<PlainSurfel> surfels;
    std::string wrong = read_surfels(cloud, surfels);
    if (wrong.empty()) scene_.set(std::move(surfels));
    return wrong;
  }

  void on_cloud(SetCloud::GoalHandle goal) {
    goal.setAccepted();
    const std::string wrong = take(goal.getGoal()->cloud);
    if (wrong.empty()) {
      goal.setSucceeded();
    } else {
      goal.setAborted({}, wrong);
    }
  }

  void on_evaluate(Evaluate::GoalHandle goal) {
    goal.setAccepted();
    const auto work = [this, goal](const std::atomic<bool>& cancelled) mutable {
      const SurfelQuestion question = to_plain(*goal.getGoal());
      std::vector<PlainPose> poses;
      for (const auto& pose : goal.getGoal()->poses) poses.push_back(::to_plain(pose));
      std::vector<SurfelScore> scores;
      const std::string wrong = scene_.evaluate(question, poses, cancelled, scores);
      if (cancelled) {
        goal.setCanceled({}, wrong);
      } else if (!wrong.empty()) {
        goal.setAborted({}, wrong);
      } else {
        goal.setSucceeded(to_result(scores, question));
      }
    };
    if (!workers_.start(work, goal.getGoalID().id)) goal.setAborted({}, "16 evaluations are at work already");
  }

  SurfelScene scene_;
  ros::Subscriber subscriber_;
  SetCloud set_cloud_;
  Evaluate evaluate_;
  Workers workers_;
};

}  // namespace

int run_surfel_next_best_view(int argc, char** argv) {
  ros::init(argc, argv, "surfel_next_best_view");
  const SurfelNode surfels{ros::NodeHandle{"~"}};
  ros::spin();
  return 0;
}
