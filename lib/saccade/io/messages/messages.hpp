// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages of ROS 1 and ROS 2 as plain structs, with the fields of their definitions. read_message, write_message:
// conversion from and to bytes, as serialised by ROS 1 and by DDS (CDR).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade::messages {

struct Time {
  std::int64_t sec{0};  ///< serialised as 32 bits
  std::uint32_t nanosec{0};

  [[nodiscard]] double seconds() const { return static_cast<double>(sec) + 1e-9 * nanosec; }
  [[nodiscard]] static Time from_seconds(double seconds);
  [[nodiscard]] bool operator==(const Time&) const = default;
};

struct Duration {
  std::int32_t sec{0};
  std::uint32_t nanosec{0};  ///< signed in ROS 1; here never negative
};

struct Header {
  Time stamp;
  std::string frame_id;
};

struct Point {
  double x{0.0}, y{0.0}, z{0.0};
};
struct Quaternion {
  double x{0.0}, y{0.0}, z{0.0}, w{1.0};
};
struct Pose {
  Point position;
  Quaternion orientation;
};
struct PoseStamped {
  Header header;
  Pose pose;
};
struct PointStamped {
  Header header;
  Point point;
};
struct TransformStamped {
  Header header;
  std::string child_frame_id;
  Pose transform;  ///< geometry_msgs/Transform, which has the layout of a pose
};
struct TFMessage {
  std::vector<TransformStamped> transforms;
};
struct Path {
  Header header;
  std::vector<PoseStamped> poses;
};

struct Image {
  Header header;
  std::uint32_t height{0}, width{0};
  std::string encoding;
  std::uint8_t is_bigendian{0};
  std::uint32_t step{0};  ///< bytes of a row
  std::vector<std::byte> data;
};
struct CompressedImage {
  Header header;
  std::string format;
  std::vector<std::byte> data;
};
struct RegionOfInterest {
  std::uint32_t x_offset{0}, y_offset{0}, height{0}, width{0};
  bool do_rectify{false};
};
struct CameraInfo {
  Header header;
  std::uint32_t height{0}, width{0};
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{};
  std::array<double, 9> r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x{0}, binning_y{0};
  RegionOfInterest roi;
};
struct PointField {
  std::string name;
  std::uint32_t offset{0};
  std::uint8_t datatype{7};  ///< 1 to 8: int8, uint8, int16, uint16, int32, uint32, float32, float64
  std::uint32_t count{1};
};
struct PointCloud2 {
  Header header;
  std::uint32_t height{1}, width{0};
  std::vector<PointField> fields;
  bool is_bigendian{false};
  std::uint32_t point_step{0}, row_step{0};
  std::vector<std::byte> data;
  bool is_dense{true};
};

struct JointState {
  Header header;
  std::vector<std::string> name;
  std::vector<double> position, velocity, effort;
};
struct JointTrajectoryPoint {
  std::vector<double> positions, velocities, accelerations, effort;
  Duration time_from_start;
};
struct JointTrajectory {
  Header header;
  std::vector<std::string> joint_names;
  std::vector<JointTrajectoryPoint> points;
};

struct ColorRGBA {
  float r{0.0F}, g{0.0F}, b{0.0F}, a{1.0F};
};
/// Marker. The additional fields of ROS 2, for textures and meshes in the message, stay empty.
struct Marker {
  enum Type : std::int32_t {
    arrow = 0,
    cube = 1,
    sphere = 2,
    cylinder = 3,
    line_strip = 4,
    line_list = 5,
    cube_list = 6,
    sphere_list = 7,
    points_list = 8,
    text_view_facing = 9
  };
  enum Action : std::int32_t { add = 0, remove = 2, remove_all = 3 };

  Header header;
  std::string ns;
  std::int32_t id{0};
  std::int32_t type{arrow};
  std::int32_t action{add};
  Pose pose;
  Point scale{1.0, 1.0, 1.0};
  ColorRGBA color;
  Duration lifetime;
  bool frame_locked{false};
  std::vector<Point> points;
  std::vector<ColorRGBA> colors;
  std::string text;
  std::string mesh_resource;
  bool mesh_use_embedded_materials{false};
};
struct MarkerArray {
  std::vector<Marker> markers;
};

struct MapMetaData {
  Time map_load_time;
  float resolution{0.0F};
  std::uint32_t width{0}, height{0};
  Pose origin;
};
struct OccupancyGrid {
  Header header;
  MapMetaData info;
  std::vector<std::byte> data;  ///< int8: -1 unknown, 0 free, 100 occupied
};
struct String {
  std::string data;
};

/// Layout of bytes.
enum class Wire {
  ros1,  ///< without padding
  cdr    ///< XCDR1 with its header of four bytes, as in ROS 2; written least significant byte first
};

/// Names of a type.
struct MessageType {
  std::string_view name;  ///< as in ROS 1: sensor_msgs/Image
  std::string_view md5;   ///< checksum of the ROS 1 definition

  [[nodiscard]] std::string ros2_name() const;  ///< sensor_msgs/msg/Image
  [[nodiscard]] std::string dds_name() const;   ///< sensor_msgs::msg::dds_::Image_
  /// Returns the text of the definition and of those that it uses, as in bags and MCAP files.
  [[nodiscard]] std::string definition(Wire wire) const;
};

/// Returns a type below; specialised for each struct that is a message.
template <class Message>
[[nodiscard]] const MessageType& type_of();

/// Reads a message. Answers corrupt_data when the bytes end early or a length in them is impossible; unsupported for
/// CDR other than XCDR1. Bytes after the message are ignored.
template <class Message>
[[nodiscard]] Result<Message> read_message(Wire wire, std::span<const std::byte> bytes);

template <class Message>
[[nodiscard]] std::vector<std::byte> write_message(Wire wire, const Message& message);

}  // namespace saccade::messages
