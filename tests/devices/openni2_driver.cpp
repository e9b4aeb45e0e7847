// SPDX-License-Identifier: Apache-2.0
// A driver for OpenNI2 whose camera shows a known picture: what the test of saccade-openni2-camera opens.
//
// Depth of pixel (u, v) is 1000 + u + 2 v mm, colour (u, v, 7); both are mirrored until that is turned off. Pixel (0,
// 0) of depth is special: 1000 + the milliseconds, modulo 2000, of the moment at which the exposure of the frame began.
// Pixel (1, 0) is 1100 while depth is registered to colour, and 1050 otherwise.
#include <atomic>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>

#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)
#include <Driver/OniDriverAPI.h>

namespace {

constexpr auto kPeriod = std::chrono::milliseconds{10};
constexpr const char* kUri{"saccade-test"};

OniVideoMode mode_of(OniSensorType sensor, int width) {
  return {sensor == ONI_SENSOR_DEPTH ? ONI_PIXEL_FORMAT_DEPTH_1_MM : ONI_PIXEL_FORMAT_RGB888, width, width * 3 / 4, 30};
}

template <class T>
OniStatus give(const T& value, void* data, int* size) {
  if (*size < static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof(T));
  *size = sizeof(T);
  return ONI_STATUS_OK;
}

class PatternStream final : public oni::driver::StreamBase {
 public:
  PatternStream(OniSensorType sensor, const std::atomic<bool>& registered)
      : sensor_{sensor}, registered_{registered}, mode_{mode_of(sensor, 160)} {}
  ~PatternStream() override { stop_now(); }

  OniStatus start() override {
    running_ = true;
    thread_ = std::thread{[this] { send(); }};
    return ONI_STATUS_OK;
  }
  void stop() override { stop_now(); }

  OniBool isPropertySupported(int id) override {
    return id == ONI_STREAM_PROPERTY_MIRRORING || id == ONI_STREAM_PROPERTY_VIDEO_MODE ||
           id == ONI_STREAM_PROPERTY_MAX_VALUE || id == ONI_STREAM_PROPERTY_CROPPING ||
           id == ONI_STREAM_PROPERTY_HORIZONTAL_FOV || id == ONI_STREAM_PROPERTY_VERTICAL_FOV;
  }
  OniStatus getProperty(int id, void* data, int* size) override {
    if (id == ONI_STREAM_PROPERTY_VIDEO_MODE) return give(mode_, data, size);
    if (id == ONI_STREAM_PROPERTY_MIRRORING) return give<OniBool>(mirrored_ ? 1 : 0, data, size);
    if (id == ONI_STREAM_PROPERTY_MAX_VALUE) return give(10000, data, size);
    if (id == ONI_STREAM_PROPERTY_CROPPING) return give(OniCropping{}, data, size);  // recordings need this and that
    if (id == ONI_STREAM_PROPERTY_HORIZONTAL_FOV) return give(sensor_ == ONI_SENSOR_DEPTH ? 1.0F : 1.2F, data, size);
    if (id == ONI_STREAM_PROPERTY_VERTICAL_FOV) return give(0.8F, data, size);
    return ONI_STATUS_NOT_IMPLEMENTED;
  }
  OniStatus setProperty(int id, const void* data, int) override {
    if (id == ONI_STREAM_PROPERTY_VIDEO_MODE) {
      std::memcpy(&mode_, data, sizeof mode_);
      return ONI_STATUS_OK;
    }
    if (id != ONI_STREAM_PROPERTY_MIRRORING) return ONI_STATUS_NOT_IMPLEMENTED;
    mirrored_ = *static_cast<const OniBool*>(data) != 0;
    return ONI_STATUS_OK;
  }

 private:
  using Clock = std::chrono::steady_clock;

  void stop_now() {
    running_ = false;
    if (thread_.joinable()) thread_.join();
  }

  /// A frame is exposed while the one before it is on its way: it comes two periods after its exposure began.
  void send() {
    Clock::time_point came[2]{Clock::now(), Clock::now()};
    for (int index = 1; running_; ++index) {
      std::this_thread::sleep_for(kPeriod);
      OniFrame* const frame = getServices().acquireFrame();
      if (frame == nullptr) continue;
      fill(*frame, index, came[0]);
      raiseNewFrame(frame);
      getServices().releaseFrame(frame);
      came[0] = came[1];
      came[1] = Clock::now();
    }
  }

  void fill(OniFrame& frame, int index, Clock::time_point exposed) const {
    const int width = mode_.resolutionX;
    const int height = mode_.resolutionY;
    const int bytes = sensor_ == ONI_SENSOR_DEPTH ? 2 : 3;
    frame.frameIndex = index;
    frame.timestamp = static_cast<std::uint64_t>(index) * 33333U;
    frame.sensorType = sensor_;
    frame.videoMode = mode_;
    frame.width = width;
    frame.height = height;
    frame.stride = width * bytes;
    frame.dataSize = width * height * bytes;
    frame.cropOriginX = frame.cropOriginY = 0;
    frame.croppingEnabled = 0;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const int seen = mirrored_ ? width - 1 - u : u;
        const int at = v * width + u;
        if (sensor_ == ONI_SENSOR_DEPTH) {
          static_cast<OniDepthPixel*>(frame.data)[at] = static_cast<OniDepthPixel>(1000 + seen + 2 * v);
        } else {
          static_cast<OniRGB888Pixel*>(frame.data)[at] = {static_cast<std::uint8_t>(seen), static_cast<std::uint8_t>(v),
                                                          7};
        }
      }
    }
    if (sensor_ != ONI_SENSOR_DEPTH) return;
    const auto since = std::chrono::duration_cast<std::chrono::milliseconds>(exposed.time_since_epoch());
    static_cast<OniDepthPixel*>(frame.data)[0] = static_cast<OniDepthPixel>(1000 + since.count() % 2000);
    static_cast<OniDepthPixel*>(frame.data)[1] = registered_ ? 1100 : 1050;
  }

  OniSensorType sensor_;
  const std::atomic<bool>& registered_;
  OniVideoMode mode_;
  std::atomic<bool> mirrored_{true};
  std::atomic<bool> running_{false};
  std::thread thread_;
};

class PatternDevice final : public oni::driver::DeviceBase {
 public:
  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    *sensors = sensors_;
    *count = 2;
    return ONI_STATUS_OK;
  }
  oni::driver::StreamBase* createStream(OniSensorType sensor) override {
    return new PatternStream{sensor, registered_};
  }
  void destroyStream(oni::driver::StreamBase* stream) override { delete stream; }
  OniBool isPropertySupported(int id) override { return id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION; }
  OniStatus getProperty(int id, void* data, int* size) override {
    if (id == ONI_DEVICE_PROPERTY_DRIVER_VERSION) return give(OniVersion{1, 0, 0, 0}, data, size);
    if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return ONI_STATUS_NOT_IMPLEMENTED;
    return give(registered_ ? ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR : ONI_IMAGE_REGISTRATION_OFF, data, size);
  }
  OniStatus setProperty(int id, const void* data, int) override {
    if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return ONI_STATUS_NOT_IMPLEMENTED;
    registered_ = *static_cast<const OniImageRegistrationMode*>(data) == ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR;
    return ONI_STATUS_OK;
  }
  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode) override { return 1; }

 private:
  OniVideoMode depth_[2]{mode_of(ONI_SENSOR_DEPTH, 160), mode_of(ONI_SENSOR_DEPTH, 80)};
  OniVideoMode color_[2]{mode_of(ONI_SENSOR_COLOR, 160), mode_of(ONI_SENSOR_COLOR, 80)};
  OniSensorInfo sensors_[2]{{ONI_SENSOR_DEPTH, 2, depth_}, {ONI_SENSOR_COLOR, 2, color_}};
  std::atomic<bool> registered_{false};
};

class PatternDriver final : public oni::driver::DriverBase {
 public:
  explicit PatternDriver(OniDriverServices* services) : DriverBase{services} {
    std::strcpy(info_.uri, kUri);
    std::strcpy(info_.name, "a known picture");
  }
  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    deviceConnected(&info_);
    return ONI_STATUS_OK;
  }
  oni::driver::DeviceBase* deviceOpen(const char* uri, const char*) override {
    return std::string{uri} == kUri ? new PatternDevice{} : nullptr;
  }
  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }
  void shutdown() override {}

 private:
  OniDeviceInfo info_{};
};

}  // namespace

ONI_EXPORT_DRIVER(PatternDriver)
