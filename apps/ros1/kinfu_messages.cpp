// SPDX-License-Identifier: Apache-2.0
#include "kinfu_messages.hpp"

#include <cmath>
#include <cstring>

using namespace saccade::ros1;

namespace {

template <class Array>
PlainPose to_pose(const Array& linear, const boost::array<float, 3>& translation) {
  PlainPose pose;
  for (std::size_t i = 0; i < 9; ++i) pose.linear[i] = linear[i];
  for (std::size_t i = 0; i < 3; ++i) pose.translation[i] = translation[i];
  return pose;
}

std::array<double, 3> to_array(const kinfu_msgs::KinfuCloudPoint& p) { return {p.x, p.y, p.z}; }
std::array<double, 3> to_array(const geometry_msgs::Point& p) { return {p.x, p.y, p.z}; }

template <class Layout>
void set_dimensions(const std::vector<Dimension>& dimensions, Layout& layout) {
  for (const Dimension& from : dimensions) {
    std_msgs::MultiArrayDimension dimension;
    dimension.label = from.label;
    dimension.size = from.size;
    dimension.stride = from.stride;
    layout.dim.push_back(dimension);
  }
}

}  // namespace

MapRequest to_plain(const kinfu_msgs::KinfuTsdfRequest& request) {
  MapRequest plain;
  plain.question = static_cast<Question>(request.tsdf_header.request_type);
  if (request.request_transformation)
    plain.transformation = to_pose(request.transformation.linear, request.transformation.translation);
  if (request.request_bounding_box)
    plain.box = PlainBox{to_array(request.bounding_box_min), to_array(request.bounding_box_max)};
  if (request.request_sphere) plain.sphere = PlainSphere{to_array(request.sphere_center), request.sphere_radius};
  if (request.request_bounding_box_view) {
    plain.view_box = PlainBox{to_array(request.bounding_box_view_min), to_array(request.bounding_box_view_max)};
  }
  plain.skip_unknown_outside_filter = request.skip_unknown_outside_filter;
  plain.accurate_surface = request.use_accurate_ray_cast_interpolation;
  if (request.request_subsample && request.subsample_voxel_size > 0.0F)
    plain.subsample_m = request.subsample_voxel_size;
  if (request.request_camera_intrinsics) {
    const auto& from = request.camera_intrinsics;
    plain.camera = PlainCamera{from.size_x, from.size_y, from.focal_x, from.focal_y, from.center_x, from.center_y};
    plain.min_range = from.min_range;
  }
  if (request.request_emitter_shadow_removal) plain.emitter_x = request.distance_x_camera_emitter;
  if (request.request_view_poses) {
    plain.views.emplace();
    for (const auto& pose : request.view_poses) plain.views->push_back(to_pose(pose.linear, pose.translation));
  }
  plain.occupied_weight = request.occupied_weight;
  plain.occupied_distance_weight = request.occupied_distance_weight;
  plain.unknown_weight = request.unknown_weight;
  plain.unknown_distance_weight = request.unknown_distance_weight;
  return plain;
}

std::string to_plain(const kinfu_msgs::WorldUploadGoal& goal, MapUpload& upload) {
  upload.box = {to_array(goal.bbox_min), to_array(goal.bbox_max)};
  upload.reset = goal.reset;
  const auto& known = goal.known_voxelgrid;
  if (!known.data.empty() || !known.layout.dim.empty()) {
    if (known.layout.dim.size() != 3)
      return "the layout of known_voxelgrid has " + std::to_string(known.layout.dim.size()) +
             " dimensions, not x, y, z";
    if (known.layout.data_offset > known.data.size()) return "data_offset of known_voxelgrid lies behind its data";
    for (std::size_t i = 0; i < 3; ++i) upload.known_size[i] = known.layout.dim[i].size;
    upload.known.assign(known.data.begin() + known.layout.data_offset, known.data.end());
    if (upload.known.empty()) return "known_voxelgrid has no data";
  }
  if (goal.tsdf_volume.data.empty()) return {};
  return read_points(goal.tsdf_volume, {"x", "y", "z", "intensity"}, [&](const float* v) {
    upload.points.push_back({v[0], v[1], v[2], v[3]});
  });
}

PlainPose hint_of(const kinfu_msgs::KinfuCommand& command) {
  return to_pose(command.pose_hint_rotation, command.pose_hint_translation);
}

PlainPose to_plain(const geometry_msgs::Pose& pose) {
  const auto& q = pose.orientation;
  const double n = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);  // NaN where anything is
  const double x = q.x / n, y = q.y / n, z = q.z / n, w = q.w / n;
  PlainPose plain;
  plain.linear = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
                  2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                  2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
  plain.translation = {pose.position.x, pose.position.y, pose.position.z};
  return plain;
}

geometry_msgs::Pose to_message(const PlainPose& pose) {
  const auto& r = pose.linear;
  geometry_msgs::Pose message;
  message.position.x = pose.translation[0];
  message.position.y = pose.translation[1];
  message.position.z = pose.translation[2];
  // The largest of the four is found from the diagonal, the others from it.
  const double four[4] = {1 + r[0] - r[4] - r[8], 1 - r[0] + r[4] - r[8], 1 - r[0] - r[4] + r[8],
                          1 + r[0] + r[4] + r[8]};
  int largest = 0;
  for (int i = 1; i < 4; ++i) largest = four[i] > four[largest] ? i : largest;
  const double half = 0.5 * std::sqrt(four[largest]);
  const double part = 0.25 / half;
  auto& q = message.orientation;
  switch (largest) {
    case 0: q.x = half, q.y = (r[1] + r[3]) * part, q.z = (r[2] + r[6]) * part, q.w = (r[7] - r[5]) * part; break;
    case 1: q.y = half, q.x = (r[1] + r[3]) * part, q.z = (r[5] + r[7]) * part, q.w = (r[2] - r[6]) * part; break;
    case 2: q.z = half, q.x = (r[2] + r[6]) * part, q.y = (r[5] + r[7]) * part, q.w = (r[3] - r[1]) * part; break;
    default: q.w = half, q.x = (r[7] - r[5]) * part, q.y = (r[2] - r[6]) * part, q.z = (r[3] - r[1]) * part; break;
  }
  return message;
}

sensor_msgs::PointCloud2 to_message(const PlainCloud& cloud, const AnswerHeader& header) {
  sensor_msgs::PointCloud2 message;
  message.header.frame_id = header.frame_id;
  message.header.stamp = header.stamp;
  message.width = cloud.width;
  message.height = cloud.height;
  for (std::size_t i = 0; i < cloud.fields.size(); ++i) {
    sensor_msgs::PointField field;
    field.name = cloud.fields[i];
    field.offset = static_cast<std::uint32_t>(4 * i);
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    message.fields.push_back(field);
  }
  message.point_step = static_cast<std::uint32_t>(4 * cloud.fields.size());
  message.row_step = message.point_step * message.width;
  message.is_dense = cloud.height == 1;
  message.data.resize(4 * cloud.values.size());
  if (!cloud.values.empty()) std::memcpy(message.data.data(), cloud.values.data(), message.data.size());
  return message;
}

sensor_msgs::Image to_image(const MapAnswer& answer, const AnswerHeader& header) {
  sensor_msgs::Image image;
  image.header.frame_id = header.frame_id;
  image.header.stamp = header.stamp;
  image.width = answer.width;
  image.height = answer.height;
  image.encoding = "rgb8";
  image.step = 3 * answer.width;
  image.data = answer.rgb;
  return image;
}

kinfu_msgs::RequestResult to_message(const MapAnswer& answer, const kinfu_msgs::KinfuTsdfRequest& request,
                                     const AnswerHeader& header) {
  kinfu_msgs::RequestResult result;
  result.tsdf_header = request.tsdf_header;
  result.header.frame_id = header.frame_id;
  result.header.stamp = header.stamp;
  switch (static_cast<Question>(request.tsdf_header.request_type)) {
    case Question::ping: break;
    case Question::mesh:
      result.mesh.header = result.header;
      result.mesh.cloud = to_message(answer.cloud, header);
      result.mesh.polygons.reserve(answer.triangles.size());
      for (const auto& triangle : answer.triangles) {
        pcl_msgs::Vertices corners;
        corners.vertices.assign(triangle.begin(), triangle.end());
        result.mesh.polygons.push_back(corners);
      }
      break;
    case Question::view: result.image = to_image(answer, header); break;
    case Question::voxel_count:
      set_dimensions(answer.dimensions, result.uint_values.layout);
      result.uint_values.data = answer.counts;
      break;
    case Question::voxelgrid:
    case Question::view_score:
      set_dimensions(answer.dimensions, result.float_values.layout);
      result.float_values.data = answer.floats;
      break;
    default: result.pointcloud = to_message(answer.cloud, header); break;
  }
  return result;
}

std::string read_points(const sensor_msgs::PointCloud2& cloud, const std::vector<std::string>& fields,
                        const std::function<void(const float*)>& visit) {
  std::vector<std::size_t> offsets;
  for (const std::string& name : fields) {
    const sensor_msgs::PointField* found = nullptr;
    for (const auto& field : cloud.fields) {
      if (field.name == name) found = &field;
    }
    if (found == nullptr) return "the cloud has no field '" + name + "'";
    if (found->datatype != sensor_msgs::PointField::FLOAT32 || std::size_t{found->offset} + 4 > cloud.point_step) {
      return "the field '" + name + "' is no float32 within a point";
    }
    offsets.push_back(found->offset);
  }
  if (cloud.is_bigendian) return "the cloud is big-endian";
  const std::size_t row = std::size_t{cloud.width} * cloud.point_step;
  const std::size_t needed = cloud.height == 0 ? 0 : std::size_t{cloud.row_step} * (cloud.height - 1) + row;
  if ((cloud.height > 1 && cloud.row_step < row) || cloud.data.size() < needed)
    return "the cloud has fewer bytes than its size needs";
  std::vector<float> values(fields.size());
  for (std::size_t v = 0; v < cloud.height; ++v) {
    for (std::size_t u = 0; u < cloud.width; ++u) {
      const std::uint8_t* point = cloud.data.data() + v * cloud.row_step + u * cloud.point_step;
      for (std::size_t i = 0; i < offsets.size(); ++i) std::memcpy(&values[i], point + offsets[i], 4);
      visit(values.data());
    }
  }
  return {};
}
