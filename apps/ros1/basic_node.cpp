// SPDX-License-Identifier: Apache-2.0
// The node basic_next_best_view: ranks view poses around a point by the unknown voxels that they would show.

#include <actionlib/server/action_server.h>
#include <basic_next_best_view/ExecuteAction.h>
#include <basic_next_best_view/VoxelFilter.h>
#include <geometry_msgs/Point.h>
#include <geometry_msgs/PoseArray.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Empty.h>

#include <algorithm>
#include <mutex>
#include <numeric>

#include "basic_views.hpp"
#include "kinfu_messages.hpp"
#include "subcommands.hpp"
#include "workers.hpp"

using namespace saccade::ros1;
using basic_next_best_view::BasicRequest;
using basic_next_best_view::ExecuteAction;
using basic_next_best_view::VoxelFilter;

namespace {

AngleSteps read_angles(const ros::NodeHandle& node, const std::string& name, const AngleSteps& otherwise) {
  AngleSteps steps{node.param(name + "_min", otherwise.first), node.param(name + "_max", otherwise.last),
                   node.param(name + "_step", otherwise.step)};
  if (!(steps.step > 0.0)) throw std::invalid_argument{name + "_step must be positive"};
  return steps;
}

BasicConfig read_config(const ros::NodeHandle& node) {
  BasicConfig c;
  c.voxel_size = node.param("voxel_resolution", c.voxel_size);
  c.max_range = node.param("sensor_range_max", c.max_range);
  c.radius = node.param("sphere_radius", c.radius);
  c.columns = static_cast<std::uint32_t>(std::clamp(node.param("horizontal_resolution", 30), 1, 8192));
  c.rows = static_cast<std::uint32_t>(std::clamp(node.param("vertical_resolution", 30), 1, 8192));
  c.half_width_deg = node.param("half_fov_horizontal", c.half_width_deg);
  c.half_height_deg = node.param("half_fov_vertical", c.half_height_deg);
  c.latitude = read_angles(node, "latitude", c.latitude);
  c.longitude = read_angles(node, "longitude", c.longitude);
  c.roll = read_angles(node, "zrotation", c.roll);
  c.occupied_weight = node.param("occupied_voxel_weight", c.occupied_weight);
  c.unknown_weight = node.param("unknown_voxel_weight", c.unknown_weight);
  if (!(c.voxel_size > 0.0) || !(c.max_range > 0.0))
    throw std::invalid_argument{"voxel_resolution and sensor_range_max must be positive"};
  return c;
}

/// Inputs received by topic.
struct Inputs {
  Occupancy occupancy;
  std::vector<PlainPose> poses;
  BasicFilter filter;
};

class BasicNode {
 public:
  explicit BasicNode(ros::NodeHandle node)
      : config_{read_config(node)},
        world_frame_{node.param<std::string>("world_frame", "/world_frame")},
        acks_{node.advertise<std_msgs::Empty>("ack", 10)},
        execute_{node, "execute", [this](Execute::GoalHandle goal) { on_goal(goal); },
                 [this](Execute::GoalHandle goal) { workers_.cancel(goal.getGoalID().id); }, false} {
    subscribers_.push_back(node.subscribe<sensor_msgs::PointCloud2>(
        "occupancy", 2, [this](const sensor_msgs::PointCloud2::ConstPtr& cloud) { on_occupancy(*cloud); }));
    subscribers_.push_back(
        node.subscribe<geometry_msgs::Point>("poi", 2, [this](const geometry_msgs::Point::ConstPtr& p) {
          change([&](Inputs& inputs) { inputs.poses = poses_around({p->x, p->y, p->z}, config_); });
        }));
    subscribers_.push_back(node.subscribe<geometry_msgs::PoseArray>(
        "candidates", 2, [this](const geometry_msgs::PoseArray::ConstPtr& poses) {
          change([&](Inputs& inputs) {
            inputs.poses.clear();
            for (const auto& pose : poses->poses) inputs.poses.push_back(to_plain(pose));
          });
        }));
    subscribers_.push_back(node.subscribe<VoxelFilter>(
        "voxel_filter", 2, [this](const VoxelFilter::ConstPtr& filter) { on_filter(*filter); }));
    execute_.start();
  }

 private:
  using Execute = actionlib::ActionServer<ExecuteAction>;

  template <class Change>
  void change(const Change& apply) {
    {
      const std::scoped_lock lock{mutex_};
      apply(inputs_);
    }
    acks_.publish(std_msgs::Empty{});
  }

  void on_occupancy(const sensor_msgs::PointCloud2& cloud) {
    Occupancy occupancy;
    const std::string wrong = read_points(cloud, {"x", "y", "z", "intensity"}, [&](const float* v) {
      occupancy.push_back({v[0], v[1], v[2], v[3]});
    });
    if (!wrong.empty()) {
      ROS_ERROR("the occupancy is not used: %s", wrong.c_str());
      return;
    }
    change([&](Inputs& inputs) { inputs.occupancy = std::move(occupancy); });
  }

  void on_filter(const VoxelFilter& from) {
    BasicFilter filter;
    const auto three = [](const auto& a) { return std::array<double, 3>{a[0], a[1], a[2]}; };
    if (from.type == VoxelFilter::FILTER_BOUNDING_BOX)
      filter.box = PlainBox{three(from.bbox_min), three(from.bbox_max)};
    if (from.type == VoxelFilter::FILTER_SPHERE) filter.sphere = PlainSphere{three(from.center), from.radius};
    if (from.type > VoxelFilter::FILTER_SPHERE) {
      ROS_ERROR("there is no voxel filter of type %u", from.type);
      return;
    }
    change([&](Inputs& inputs) { inputs.filter = filter; });
  }

  void on_goal(Execute::GoalHandle goal) {
    if (goal.getGoal()->request.type > BasicRequest::REQUEST_GET_UNK_COUNT) {
      goal.setRejected({}, "there is no request of type " + std::to_string(goal.getGoal()->request.type));
      return;
    }
    goal.setAccepted();
    const auto work = [this, goal](const std::atomic<bool>& cancelled) mutable {
      basic_next_best_view::ExecuteResult result;
      const std::string wrong = answer(goal, cancelled, result.response);
      result.response.ok = wrong.empty();
      if (cancelled) {
        goal.setCanceled(result, "cancelled");
      } else if (!wrong.empty()) {
        goal.setAborted(result, wrong);
      } else {
        goal.setSucceeded(result);
      }
    };
    if (!workers_.start(work, goal.getGoalID().id)) goal.setAborted({}, "16 requests are being answered already");
  }

  std::string answer(Execute::GoalHandle& goal, const std::atomic<bool>& cancelled,
                     basic_next_best_view::BasicResponse& response) {
    const BasicRequest& request = goal.getGoal()->request;
    if (request.type == BasicRequest::REQUEST_NOOP) return {};
    Inputs inputs;
    {
      const std::scoped_lock lock{mutex_};
      inputs = inputs_;
    }
    if (request.type == BasicRequest::REQUEST_GET_POSE_COUNT) {
      response.pose_count = static_cast<std::uint32_t>(inputs.poses.size());
      return {};
    }
    std::uint32_t begin = 0;
    auto end = static_cast<std::uint32_t>(inputs.poses.size());
    if (request.has_index_range) {
      if (request.start_from_index > request.end_before_index || request.end_before_index > end) {
        return "the range [" + std::to_string(request.start_from_index) + ", " +
               std::to_string(request.end_before_index) + ") is not within the " + std::to_string(end) + " poses";
      }
      begin = request.start_from_index;
      end = request.end_before_index;
    }
    const std::vector<PlainPose> poses{inputs.poses.begin() + begin, inputs.poses.begin() + end};
    if (request.type == BasicRequest::REQUEST_GET_POSE_LIST) {
      response.pose_list = to_array(poses);
      return {};
    }
    BasicCounts counts;
    const auto progress = [&](std::size_t done) {
      basic_next_best_view::ExecuteFeedback feedback;
      feedback.progress = static_cast<std::uint32_t>(done);
      feedback.progress_max = static_cast<std::uint32_t>(poses.size());
      goal.publishFeedback(feedback);
    };
    const std::string wrong =
        count_voxels(inputs.occupancy, poses, inputs.filter, config_, cancelled, progress, counts);
    if (!wrong.empty()) return wrong;
    fill(request.type, begin, poses, counts, response);
    return {};
  }

  void fill(std::uint32_t type, std::uint32_t begin, const std::vector<PlainPose>& poses, const BasicCounts& counts,
            basic_next_best_view::BasicResponse& response) const {
    std::vector<double> weights(poses.size());
    for (std::size_t i = 0; i < weights.size(); ++i)
      weights[i] = counts.unknown[i] * config_.unknown_weight + counts.occupied[i] * config_.occupied_weight;
    if (type == BasicRequest::REQUEST_GET_POSE_WEIGHTS) response.weight_list.data = weights;
    if (type == BasicRequest::REQUEST_GET_UNK_COUNT) response.unknown_count.data = counts.unknown;
    if (type != BasicRequest::REQUEST_GET_BEST_INDICES && type != BasicRequest::REQUEST_GET_BEST_POSES) return;
    std::vector<std::uint32_t> order(poses.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return weights[a] > weights[b]; });
    std::vector<PlainPose> best;
    for (const std::uint32_t i : order) best.push_back(poses[i]);
    if (type == BasicRequest::REQUEST_GET_BEST_POSES) response.best_poses = to_array(best);
    for (std::uint32_t& i : order) i += begin;
    if (type == BasicRequest::REQUEST_GET_BEST_INDICES) response.index_list.data = order;
  }

  geometry_msgs::PoseArray to_array(const std::vector<PlainPose>& poses) const {
    geometry_msgs::PoseArray array;
    array.header.frame_id = world_frame_;
    array.header.stamp = ros::Time::now();
    for (const PlainPose& pose : poses) array.poses.push_back(to_message(pose));
    return array;
  }

  BasicConfig config_;
  std::string world_frame_;
  ros::Publisher acks_;
  std::mutex mutex_;
  Inputs inputs_;
  std::vector<ros::Subscriber> subscribers_;
  Execute execute_;
  Workers workers_;
};

}  // namespace

int run_basic_next_best_view(int argc, char** argv) {
  ros::init(argc, argv, "basic_next_best_view");
  const BasicNode basic{ros::NodeHandle{"~"}};
  ros::spin();
  return 0;
}
