// SPDX-License-Identifier: Apache-2.0
// A Kinect v1 (Xbox 360, or for Windows) as a camera of Saccade, by libfreenect.
//
//   saccade-kinect1-camera [--depth registered|mm|raw] [--index N | --serial TEXT] [--fx PX] [--fy PX] [--cx PX]
//                          [--cy PX] [--skip FRAMES]
//
// registered: depth in the colour camera's view, with colour. mm: depth as its own camera sees it, without colour. raw:
// mm, computed here from the 11 bits that the device sends; what recordings of fakenect hold. Without --depth the first
// of these that the library offers. Focal lengths come from the device's own calibration, unless they are given. A
// frame comes after --skip others (2): one was on its way when it was asked for, and one was being exposed.
#include <libfreenect.h>
#include <libfreenect_registration.h>
#include <sys/time.h>

#include <cstring>
#include <iterator>

#include "camera_program.hpp"
#include "kinect1_depth.hpp"

// fakenect has neither; they are null there.
#pragma weak freenect_copy_registration
#pragma weak freenect_destroy_registration

namespace {

using namespace saccade::devices;

constexpr const char* kNoKinect{
    "No Kinect found; is it plugged in (it needs its own power supply), and may you open it? The udev rules of "
    "libfreenect (package libfreenect0.5) let the group plugdev do so"};
constexpr double kLongest_s{3.0};
constexpr double kNominalColorFocal_px{525.0};

/// Depth or colour stream.
struct Stream {
  int awaited{0};  ///< number of frames until the wanted one
  std::string bytes;
  double time_s{0.0};

  void arrived(const void* data, std::size_t size) {
    if (awaited == 0 || --awaited > 0) return;
    bytes.assign(static_cast<const char*>(data), size);
    time_s = now_s();
  }
};

class Kinect1 final : public DeviceCamera {
 public:
  explicit Kinect1(const Options& options) : skip_{static_cast<int>(options.number("--skip", 2.0))} {
    if (freenect_init(&context_, nullptr) < 0) throw std::runtime_error{kNoKinect};
    freenect_set_log_level(context_, FREENECT_LOG_WARNING);
    freenect_select_subdevices(context_, FREENECT_DEVICE_CAMERA);
    try {
      open(options);
      const freenect_frame_mode mode = depth_mode(options.text("--depth"));
      read_calibration(options);
      start(mode);
    } catch (...) {
      close();
      throw;
    }
  }
  Kinect1(const Kinect1&) = delete;
  Kinect1& operator=(const Kinect1&) = delete;
  ~Kinect1() override { close(); }

  [[nodiscard]] nlohmann::json hello() const override {
    return camera_hello(kKinectWidth, kKinectHeight, fx_, fy_, cx_, cy_, 0.4, 4.5, "uint16_mm",
                        has_color() ? "rgb8" : "none");
  }

  [[nodiscard]] Shot capture(const nlohmann::json&) override {
    depth_.awaited = skip_ + 1;
    color_.awaited = has_color() ? skip_ + 1 : 0;
    for (const double began_s = now_s(); depth_.awaited > 0 || color_.awaited > 0;) {
      if (lost_) throw std::runtime_error{"the Kinect is gone; is its cable loose?"};
      if (now_s() - began_s > kLongest_s) {
        throw std::runtime_error{std::string{"the Kinect sends no "} + (depth_.awaited > 0 ? "depth" : "colour") +
                                 " images; does it share its USB port with another device?"};
      }
      handle_events();
    }
    if (format_ == FREENECT_DEPTH_11BIT) to_millimetres(depth_.bytes);
    return {depth_.bytes + (has_color() ? color_.bytes : ""), {}, depth_.time_s};
  }

  /// Takes frames while idle: the device sends all the time, and untaken frames would be delivered later.
  void idle() override {
    if (!lost_) handle_events();
  }
  [[nodiscard]] std::chrono::milliseconds patience() const override {
    return std::chrono::milliseconds{lost_ ? 200 : 0};
  }

 private:
  [[nodiscard]] bool has_color() const { return format_ == FREENECT_DEPTH_REGISTERED; }

  void open(const Options& options) {
    const std::string serial = options.text("--serial");
    const int index = static_cast<int>(options.number("--index", 0.0));
    const int found = freenect_num_devices(context_);
    if (found <= 0) throw std::runtime_error{kNoKinect};
    if (serial.empty() && index >= found) {
      throw std::runtime_error{"there is no Kinect " + std::to_string(index) + ", only " + std::to_string(found) +
                               ", counted from 0"};
    }
    const int status = serial.empty() ? freenect_open_device(context_, &device_, index)
                                      : freenect_open_device_by_camera_serial(context_, &device_, serial.c_str());
    if (status < 0) {
      device_ = nullptr;
      throw std::runtime_error{"the Kinect " + serial + (serial.empty() ? "" : " ") +
                               "cannot be opened; may you open it, and does another program use it?"};
    }
  }

  /// Lists the available modes instead of requesting one: fakenect aborts on a request for a missing mode.
  [[nodiscard]] freenect_frame_mode depth_mode(const std::string& wanted) {
    const std::array<std::pair<const char*, freenect_depth_format>, 3> formats{
        {{"registered", FREENECT_DEPTH_REGISTERED}, {"mm", FREENECT_DEPTH_MM}, {"raw", FREENECT_DEPTH_11BIT}}};
    for (const auto& [name, format] : formats) {
      if (!wanted.empty() && wanted != name) continue;
      for (int i = 0; i < freenect_get_depth_mode_count(); ++i) {
        const freenect_frame_mode mode = freenect_get_depth_mode(i);
        if (mode.is_valid == 0 || mode.resolution != FREENECT_RESOLUTION_MEDIUM || mode.depth_format != format)
          continue;
        format_ = format;
        return mode;
      }
    }
    throw std::runtime_error{wanted.empty() ? "this libfreenect offers no depth of 640 x 480 pixels"
                                            : "--depth must be registered, mm or raw, and one that libfreenect offers, "
                                              "not " +
                                                  wanted};
  }

  void read_calibration(const Options& options) {
    double focal_px = has_color() ? kNominalColorFocal_px : zero_plane_.focal_px();
    if (freenect_copy_registration != nullptr) {
      freenect_registration registration = freenect_copy_registration(device_);
      const freenect_zero_plane_info& plane = registration.zero_plane_info;
      if (plane.reference_distance > 0.0F && plane.reference_pixel_size > 0.0F) {
        zero_plane_ = {plane.dcmos_emitter_dist, plane.reference_distance, plane.reference_pixel_size,
                       registration.const_shift};
        focal_px = zero_plane_.focal_px();
        if (has_color()) focal_px = focal_of_color_px(focal_px, registration.registration_table);
      }
      freenect_destroy_registration(&registration);
    }
    fx_ = options.number("--fx", focal_px);
    fy_ = options.number("--fy", fx_);
    cx_ = options.number("--cx", 0.5 * (kKinectWidth - 1));
    cy_ = options.number("--cy", 0.5 * (kKinectHeight - 1));
  }

  void start(const freenect_frame_mode& mode) {
    freenect_set_user(device_, this);
    freenect_set_depth_callback(device_, [](freenect_device* device, void* data, std::uint32_t) {
      static_cast<Kinect1*>(freenect_get_user(device))->depth_.arrived(data, 2UL * kKinectWidth * kKinectHeight);
    });
    freenect_set_video_callback(device_, [](freenect_device* device, void* data, std::uint32_t) {
      static_cast<Kinect1*>(freenect_get_user(device))->color_.arrived(data, 3UL * kKinectWidth * kKinectHeight);
    });
    bool started = freenect_set_depth_mode(device_, mode) == 0 && freenect_start_depth(device_) == 0;
    if (has_color()) {
      const freenect_frame_mode color = freenect_find_video_mode(FREENECT_RESOLUTION_MEDIUM, FREENECT_VIDEO_RGB);
      started = started && freenect_set_video_mode(device_, color) == 0 && freenect_start_video(device_) == 0;
    }
    if (!started) throw std::runtime_error{"the Kinect cannot be started; does it have its own power supply?"};
  }

  void handle_events() {
    timeval longest{0, 10000};
    lost_ = freenect_process_events_timeout(context_, &longest) < 0;
  }

  void to_millimetres(std::string& bytes) const {
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
      std::uint16_t value{0};
      std::memcpy(&value, &bytes[i], 2);
      value = zero_plane_.millimetres(value);
      std::memcpy(&bytes[i], &value, 2);
    }
  }

  void close() {
    if (device_ != nullptr) {
      freenect_stop_depth(device_);
      if (has_color()) freenect_stop_video(device_);
      freenect_close_device(device_);
    }
    freenect_shutdown(context_);
  }

  int skip_;
  freenect_context* context_{nullptr};
  freenect_device* device_{nullptr};
  freenect_depth_format format_{FREENECT_DEPTH_REGISTERED};
  ZeroPlane zero_plane_;
  double fx_{0.0}, fy_{0.0}, cx_{0.0}, cy_{0.0};
  Stream depth_;
  Stream color_;
  bool lost_{false};
};

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options{argc, argv};
    options.only({"--depth", "--index", "--serial", "--fx", "--fy", "--cx", "--cy", "--skip"});
    return run_camera([&] { return std::make_unique<Kinect1>(options); });
  } catch (const std::exception& e) {
    std::cerr << "saccade-kinect1-camera: " << e.what() << '\n';
    return 1;
  }
}
