// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>

#include "saccade/io/messages/messages.hpp"

namespace saccade::messages {
namespace {

struct Definition {
  std::string_view name;
  std::string_view fields;  ///< lines that begin with 1: or 2: belong only to ROS 1 or ROS 2
};

constexpr Definition kDefinitions[]{
    {"std_msgs/Header", "1:uint32 seq\ntime stamp\nstring frame_id\n"},
    {"std_msgs/String", "string data\n"},
    {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    {"geometry_msgs/PointStamped", "std_msgs/Header header\ngeometry_msgs/Point point\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
    {"nav_msgs/MapMetaData",
     "time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\ngeometry_msgs/Pose origin\n"},
    {"nav_msgs/OccupancyGrid", "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"},
    {"sensor_msgs/Image",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\n"
     "uint8[] data\n"},
    {"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    {"sensor_msgs/RegionOfInterest",
     "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"},
    {"sensor_msgs/CameraInfo",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
     "1:float64[] D\n1:float64[9] K\n1:float64[9] R\n1:float64[12] P\n"
     "2:float64[] d\n2:float64[9] k\n2:float64[9] r\n2:float64[12] p\n"
     "uint32 binning_x\nuint32 binning_y\nsensor_msgs/RegionOfInterest roi\n"},
    {"sensor_msgs/PointField",
     "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\n"
     "uint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n"
     "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    {"sensor_msgs/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"},
    {"trajectory_msgs/JointTrajectoryPoint",
     "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\nduration "
     "time_from_start\n"},
    {"trajectory_msgs/JointTrajectory",
     "std_msgs/Header header\nstring[] joint_names\ntrajectory_msgs/JointTrajectoryPoint[] points\n"},
    {"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
    {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
    {"visualization_msgs/Marker",
     "1:uint8 ARROW=0\n1:uint8 CUBE=1\n1:uint8 SPHERE=2\n1:uint8 CYLINDER=3\n1:uint8 LINE_STRIP=4\n1:uint8 "
     "LINE_LIST=5\n"
     "1:uint8 CUBE_LIST=6\n1:uint8 SPHERE_LIST=7\n1:uint8 POINTS=8\n1:uint8 TEXT_VIEW_FACING=9\n1:uint8 "
     "MESH_RESOURCE=10\n"
     "1:uint8 TRIANGLE_LIST=11\n1:uint8 ADD=0\n1:uint8 MODIFY=0\n1:uint8 DELETE=2\n1:uint8 DELETEALL=3\n"
     "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n"
     "geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nduration lifetime\nbool frame_locked\n"
     "geometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\n"
     "2:string texture_resource\n2:sensor_msgs/CompressedImage texture\n"
     "2:visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\n"
     "2:visualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n"},
    {"visualization_msgs/MarkerArray", "visualization_msgs/Marker[] markers\n"},
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
};

std::string_view fields_of(std::string_view name) {
  const auto* found = std::ranges::find(kDefinitions, name, &Definition::name);
  return found == std::end(kDefinitions) ? std::string_view{} : found->fields;
}

/// Returns one definition in the notation of one ROS version; adds the types that it uses to `used`.
std::string definition_text(std::string_view name, Wire wire, std::vector<std::string>& used) {
  std::string text;
  std::istringstream lines{std::string{fields_of(name)}};
  for (std::string line; std::getline(lines, line);) {
    if (line[1] == ':') {
      if ((line[0] == '1') != (wire == Wire::ros1)) continue;
      line.erase(0, 2);
    }
    if (wire == Wire::cdr && line.starts_with("time ")) line = "builtin_interfaces/Time" + line.substr(4);
    if (wire == Wire::cdr && line.starts_with("duration ")) line = "builtin_interfaces/Duration" + line.substr(8);
    text += line + '\n';
    const std::string type = line.substr(0, line.find_first_of(" ["));
    if (type.find('/') != std::string::npos && std::ranges::find(used, type) == used.end()) used.push_back(type);
  }
  return text;
}

}  // namespace

std::string MessageType::ros2_name() const {
  const std::size_t slash = name.find('/');
  return std::string{name.substr(0, slash)} + "/msg/" + std::string{name.substr(slash + 1)};
}

std::string MessageType::dds_name() const {
  const std::size_t slash = name.find('/');
  return std::string{name.substr(0, slash)} + "::msg::dds_::" + std::string{name.substr(slash + 1)} + "_";
}

std::string MessageType::definition(Wire wire) const {
  std::vector<std::string> used;
  std::string text = definition_text(name, wire, used);
  for (std::size_t i = 0; i < used.size(); ++i) {
    const std::string type = used[i];  // a copy: used grows
    text += std::string(80, '=') + "\nMSG: " + type + '\n' + definition_text(type, wire, used);
  }
  return text;
}

#define SACCADE_MESSAGE(Message, name, md5)        \
  template <>                                      \
  const MessageType& type_of<Message>() {          \
    static constexpr MessageType kType{name, md5}; \
    return kType;                                  \
  }
SACCADE_MESSAGE(PoseStamped, "geometry_msgs/PoseStamped", "d3812c3cbc69362b77dc0b19b345f8f5")
SACCADE_MESSAGE(PointStamped, "geometry_msgs/PointStamped", "c63aecb41bfdfd6b7e1fac37c7cbe7bf")
SACCADE_MESSAGE(TransformStamped, "geometry_msgs/TransformStamped", "b5764a33bfeb3588febc2682852579b0")
SACCADE_MESSAGE(TFMessage, "tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec")
SACCADE_MESSAGE(Path, "nav_msgs/Path", "6227e2b7e9cce15051f669a5e197bbf7")
SACCADE_MESSAGE(Image, "sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743")
SACCADE_MESSAGE(CompressedImage, "sensor_msgs/CompressedImage", "8f7a12909da2c9d3332d540a0977563f")
SACCADE_MESSAGE(CameraInfo, "sensor_msgs/CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214")
SACCADE_MESSAGE(PointCloud2, "sensor_msgs/PointCloud2", "1158d486dd51d683ce2f1be655c3c181")
SACCADE_MESSAGE(JointState, "sensor_msgs/JointState", "3066dcd76a6cfaef579bd0f34173e9fd")
SACCADE_MESSAGE(JointTrajectory, "trajectory_msgs/JointTrajectory", "65b4f94a94d1ed67169da35a02f33d3f")
SACCADE_MESSAGE(MarkerArray, "visualization_msgs/MarkerArray", "d155b9ce5188fbaf89745847fd5882d7")
SACCADE_MESSAGE(OccupancyGrid, "nav_msgs/OccupancyGrid", "3381f2d731d4076ec5c71b0759edbe4e")
SACCADE_MESSAGE(String, "std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1")
#undef SACCADE_MESSAGE

}  // namespace saccade::messages
