// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "saccade/io/messages/internal/archive.hpp"

namespace saccade::messages {
namespace {

using internal::kIsScalar;
using internal::Reader;
using internal::Writer;

/// Returns the smallest number of bytes of a sequence's element.
template <class T>
constexpr std::size_t least_bytes() {
  return kIsScalar<T> ? sizeof(T) : 4;
}

/// Applies an archive to values in the order of their definition. `Ref` is const when it writes.
template <class Archive>
class Fields {
 public:
  template <class T>
  using Ref = std::conditional_t<Archive::kReads, T&, const T&>;

  explicit Fields(Archive& archive) : archive_{archive} {}

  template <class... Values>
  void operator()(Values&... values) {
    (field(values), ...);
  }

 private:
  void field(Ref<bool> value) { archive_.flag(value); }
  void field(Ref<std::string> value) { archive_.text(value); }
  void field(Ref<std::uint8_t> value) { archive_.scalar(value); }
  void field(Ref<std::uint32_t> value) { archive_.scalar(value); }
  void field(Ref<std::int32_t> value) { archive_.scalar(value); }
  void field(Ref<float> value) { archive_.scalar(value); }
  void field(Ref<double> value) { archive_.scalar(value); }
  template <class T, std::size_t kCount>
  void field(std::array<T, kCount>& values) {
    archive_.block(values.data(), kCount);
  }
  template <class T, std::size_t kCount>
  void field(const std::array<T, kCount>& values) {
    archive_.block(values.data(), kCount);
  }
  template <class T>
  void field(std::vector<T>& values) {
    values.resize(archive_.length(values.size(), least_bytes<T>()));
    if constexpr (kIsScalar<T>) {
      archive_.block(values.data(), values.size());
    } else {
      for (T& value : values) field(value);
    }
  }
  template <class T>
  void field(const std::vector<T>& values) {
    archive_.length(values.size(), least_bytes<T>());
    if constexpr (kIsScalar<T>) {
      archive_.block(values.data(), values.size());
    } else {
      for (const T& value : values) field(value);
    }
  }

  void field(Ref<Time> t) {
    auto sec = static_cast<std::uint32_t>(t.sec);
    archive_.scalar(sec);
    if constexpr (Archive::kReads) {
      t.sec = archive_.wire() == Wire::cdr ? std::int64_t{static_cast<std::int32_t>(sec)} : std::int64_t{sec};
    }
    archive_.scalar(t.nanosec);
  }
  void field(Ref<Duration> t) { (*this)(t.sec, t.nanosec); }
  void field(Ref<Header> h) {
    std::uint32_t seq = 0;
    if (archive_.wire() == Wire::ros1) archive_.scalar(seq);
    (*this)(h.stamp, h.frame_id);
  }
  void field(Ref<Point> p) { (*this)(p.x, p.y, p.z); }
  void field(Ref<Quaternion> q) { (*this)(q.x, q.y, q.z, q.w); }
  void field(Ref<Pose> p) { (*this)(p.position, p.orientation); }
  void field(Ref<PoseStamped> p) { (*this)(p.header, p.pose); }
  void field(Ref<PointStamped> p) { (*this)(p.header, p.point); }
  void field(Ref<TransformStamped> t) { (*this)(t.header, t.child_frame_id, t.transform); }
  void field(Ref<TFMessage> m) { (*this)(m.transforms); }
  void field(Ref<Path> m) { (*this)(m.header, m.poses); }
  void field(Ref<Image> m) { (*this)(m.header, m.height, m.width, m.encoding, m.is_bigendian, m.step, m.data); }
  void field(Ref<CompressedImage> m) { (*this)(m.header, m.format, m.data); }
  void field(Ref<RegionOfInterest> m) { (*this)(m.x_offset, m.y_offset, m.height, m.width, m.do_rectify); }
  void field(Ref<CameraInfo> m) {
    (*this)(m.header, m.height, m.width, m.distortion_model, m.d, m.k, m.r, m.p, m.binning_x, m.binning_y, m.roi);
  }
  void field(Ref<PointField> m) { (*this)(m.name, m.offset, m.datatype, m.count); }
  void field(Ref<PointCloud2> m) {
    (*this)(m.header, m.height, m.width, m.fields, m.is_bigendian, m.point_step, m.row_step, m.data, m.is_dense);
  }
  void field(Ref<JointState> m) { (*this)(m.header, m.name, m.position, m.velocity, m.effort); }
  void field(Ref<JointTrajectoryPoint> m) {
    (*this)(m.positions, m.velocities, m.accelerations, m.effort, m.time_from_start);
  }
  void field(Ref<JointTrajectory> m) { (*this)(m.header, m.joint_names, m.points); }
  void field(Ref<ColorRGBA> c) { (*this)(c.r, c.g, c.b, c.a); }
  void field(Ref<Marker> m) {
    (*this)(m.header, m.ns, m.id, m.type, m.action, m.pose, m.scale, m.color, m.lifetime, m.frame_locked, m.points,
            m.colors);
    const bool ros2 = archive_.wire() == Wire::cdr;
    std::string texture_resource;
    CompressedImage texture;
    std::vector<float> uv;  // as pairs; none is ever written
    std::string mesh_file;
    std::vector<std::byte> mesh_data;
    if (ros2) (*this)(texture_resource, texture);
    if (ros2) uv_coordinates(uv);
    (*this)(m.text, m.mesh_resource);
    if (ros2) (*this)(mesh_file, mesh_data);
    (*this)(m.mesh_use_embedded_materials);
  }
  void uv_coordinates(std::vector<float>& uv) {
    const std::size_t count = archive_.length(0, 8);
    if constexpr (Archive::kReads) {
      uv.resize(2 * count);
      archive_.block(uv.data(), uv.size());
    }
  }
  void field(Ref<MarkerArray> m) { (*this)(m.markers); }
  void field(Ref<MapMetaData> m) { (*this)(m.map_load_time, m.resolution, m.width, m.height, m.origin); }
  void field(Ref<OccupancyGrid> m) { (*this)(m.header, m.info, m.data); }
  void field(Ref<String> m) { (*this)(m.data); }

  Archive& archive_;
};

}  // namespace

Time Time::from_seconds(double seconds) {
  const double whole = std::floor(seconds);
  const auto nanosec = static_cast<std::int64_t>(std::llround((seconds - whole) * 1e9));
  return {static_cast<std::int64_t>(whole) + nanosec / 1'000'000'000,
          static_cast<std::uint32_t>(nanosec % 1'000'000'000)};
}

template <class Message>
Result<Message> read_message(Wire wire, std::span<const std::byte> bytes) {
  if (wire == Wire::cdr && bytes.size() >= 2 && (bytes[0] != std::byte{0} || bytes[1] > std::byte{1})) {
    return Error{Errc::unsupported, "this is not plain CDR (XCDR1)", std::string{type_of<Message>().name}};
  }
  Reader reader{wire, bytes};
  Message message;
  Fields<Reader>{reader}(message);
  if (reader.failed()) {
    return Error{Errc::corrupt_data,
                 "the message of " + std::to_string(bytes.size()) + " bytes ends before its last field",
                 std::string{type_of<Message>().name}};
  }
  return message;
}

template <class Message>
std::vector<std::byte> write_message(Wire wire, const Message& message) {
  Writer writer{wire};
  Fields<Writer>{writer}(message);
  return std::move(writer).take();
}

#define SACCADE_MESSAGE(Message)                                                               \
  template Result<Message> read_message<Message>(Wire wire, std::span<const std::byte> bytes); \
  template std::vector<std::byte> write_message<Message>(Wire wire, const Message& message);
SACCADE_MESSAGE(PoseStamped)
SACCADE_MESSAGE(PointStamped)
SACCADE_MESSAGE(TransformStamped)
SACCADE_MESSAGE(TFMessage)
SACCADE_MESSAGE(Path)
SACCADE_MESSAGE(Image)
SACCADE_MESSAGE(CompressedImage)
SACCADE_MESSAGE(CameraInfo)
SACCADE_MESSAGE(PointCloud2)
SACCADE_MESSAGE(JointState)
SACCADE_MESSAGE(JointTrajectory)
SACCADE_MESSAGE(MarkerArray)
SACCADE_MESSAGE(OccupancyGrid)
SACCADE_MESSAGE(String)
#undef SACCADE_MESSAGE

}  // namespace saccade::messages
