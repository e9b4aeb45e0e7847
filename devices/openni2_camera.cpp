// SPDX-License-Identifier: Apache-2.0
// A depth camera with an OpenNI2 driver (Asus Xtion, PrimeSense Carmine, Orbbec Astra, Structure) as a camera of
// Saccade.
//
//   saccade-openni2-camera [URI|FILE.oni] [--width PIXELS] [--color 0|1] [--fx PX] [--fy PX] [--cx PX] [--cy PX]
//                          [--min-range M] [--max-range M] [--skip FRAMES]
//
// Without a URI the first camera that is found; a recording is played as if it were one. Depth comes in the colour
// camera's view, with colour, where the camera can do that, and without colour otherwise; of a recording, which does
// not tell whether its depth was brought there, colour is taken with --color 1 alone. Focal lengths come from the
// fields of view that the driver tells, unless they are given. A frame comes after --skip others (2): one was on its
// way when it was asked for, and one was being exposed.
#include <OpenNI.h>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <utility>

#include "camera_program.hpp"

namespace {

using namespace saccade::devices;
using openni::VideoMode;
using openni::VideoStream;

constexpr int kLongest_ms{3000};

void check(openni::Status status, const std::string& what) {
  if (status == openni::STATUS_OK) return;
  std::string why{openni::OpenNI::getExtendedError()};
  for (char& letter : why) letter = std::iscntrl(static_cast<unsigned char>(letter)) != 0 ? ' ' : letter;
  while (why.ends_with(' ')) why.pop_back();
  while (why.starts_with(' ')) why.erase(0, 1);
  throw std::runtime_error{what + (why.empty() ? "" : ": " + why)};
}

/// Sets the mode with the wanted format that is nearest to a width (640 without one) and to 30 frames a second; with
/// exactly this size if rows are given, too. Returns false if there is none.
bool choose_mode(VideoStream& stream, openni::PixelFormat format, int width, int height = 0) {
  const auto& modes = stream.getSensorInfo().getSupportedVideoModes();
  const VideoMode* best = nullptr;
  const auto far = [&](const VideoMode& mode) {
    return std::pair{std::abs(mode.getResolutionX() - (width > 0 ? width : 640)), std::abs(mode.getFps() - 30)};
  };
  for (int i = 0; i < modes.getSize(); ++i) {
    const VideoMode& mode = modes[i];
    if (mode.getPixelFormat() != format) continue;
    if (height > 0 && (mode.getResolutionX() != width || mode.getResolutionY() != height)) continue;
    if (best == nullptr || far(mode) < far(*best)) best = &mode;
  }
  if (best == nullptr) return false;
  const VideoMode now = stream.getVideoMode();
  if (now.getPixelFormat() == format && now.getResolutionX() == best->getResolutionX() &&
      now.getResolutionY() == best->getResolutionY()) {
    return true;  // a recording cannot be set, not even to what it is
  }
  return stream.setVideoMode(*best) == openni::STATUS_OK;
}

/// A frame of depth or colour that is waited for.
struct Wanted {
  VideoStream* stream;
  std::string name;
  std::size_t pixel_bytes;
  int awaited;  ///< it is this many frames from now
  std::string rows;
};

class OpenNi2Camera final : public DeviceCamera {
 public:
  explicit OpenNi2Camera(const Options& options) : skip_{static_cast<int>(options.number("--skip", 2.0))} {
    check(openni::OpenNI::initialize(), "OpenNI2 cannot be started; are its drivers beside it (OpenNI2/Drivers)?");
    open(options.text(""));
    check(depth_.create(device_, openni::SENSOR_DEPTH), "the camera has no depth");
    if (!choose_mode(depth_, openni::PIXEL_FORMAT_DEPTH_1_MM, static_cast<int>(options.number("--width", 0.0)))) {
      throw std::runtime_error{"the camera has no depth in millimetres"};
    }
    if (options.number("--color", device_.isFile() ? 0.0 : 1.0) > 0.0) use_color();
    unmirror(depth_);
    check(depth_.start(), "the camera's depth cannot be started");
    if (has_color_) {
      unmirror(color_);
      check(color_.start(), "the camera's colour cannot be started");
    }
    read_calibration(options);
  }
  OpenNi2Camera(const OpenNi2Camera&) = delete;
  OpenNi2Camera& operator=(const OpenNi2Camera&) = delete;
  ~OpenNi2Camera() override {
    depth_.destroy();
    color_.destroy();
    device_.close();
    openni::OpenNI::shutdown();
  }

  [[nodiscard]] nlohmann::json hello() const override { return hello_; }

  [[nodiscard]] Shot capture(const nlohmann::json&) override {
    Shot shot;
    std::array<Wanted, 2> all{Wanted{&depth_, "depth", 2, skip_ + 1, {}}, Wanted{&color_, "colour", 3, skip_ + 1, {}}};
    const std::span<Wanted> wanted{all.data(), has_color_ ? 2U : 1U};
    for (const Wanted& stream : wanted) {
      while (ready(stream.stream, 0)) next_frame(stream);  // older than the request
    }
    while (std::any_of(wanted.begin(), wanted.end(), [](const Wanted& s) { return s.awaited > 0; })) {
      for (Wanted& stream : wanted) {
        if (stream.awaited == 0) continue;
        if (!ready(stream.stream, kLongest_ms)) {
          throw std::runtime_error{"the camera sends no " + stream.name + " images; is its cable loose?"};
        }
        const openni::VideoFrameRef frame = next_frame(stream);
        if (--stream.awaited == 0) stream.rows = rows_of(frame, stream);
      }
    }
    shot.time_s = now_s();
    for (const Wanted& stream : wanted) shot.bytes += stream.rows;
    return shot;
  }

 private:
  void open(const std::string& uri) {
    if (!uri.empty()) {
      const bool recording = uri.ends_with(".oni");
      if (recording && !std::filesystem::exists(uri)) throw std::runtime_error{"there is no file " + uri};
      check(device_.open(uri.c_str()),
            recording ? "the recording " + uri + " cannot be opened" : "the camera " + uri + " cannot be opened");
      if (device_.isFile()) device_.getPlaybackControl()->setRepeatEnabled(true);
      return;
    }
    openni::Array<openni::DeviceInfo> found;
    openni::OpenNI::enumerateDevices(&found);
    if (found.getSize() == 0) {
      throw std::runtime_error{
          "OpenNI2 finds no camera; is one plugged in, and may you open it? The udev rules of OpenNI2 (package "
          "libopenni2-0) let the group video do so"};
    }
    check(device_.open(found[0].getUri()),
          std::string{"the camera "} + found[0].getUri() + " cannot be opened; does another program use it?");
  }

  /// Takes colour, too, if the camera can bring depth into the view of its colour.
  void use_color() {
    const VideoMode depth = depth_.getVideoMode();
    const bool registered =
        device_.isFile() || device_.isImageRegistrationModeSupported(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR);
    if (!registered || !device_.hasSensor(openni::SENSOR_COLOR)) return;
    if (color_.create(device_, openni::SENSOR_COLOR) != openni::STATUS_OK) return;
    has_color_ = choose_mode(color_, openni::PIXEL_FORMAT_RGB888, depth.getResolutionX(), depth.getResolutionY()) &&
                 (device_.isFile() ||
                  device_.setImageRegistrationMode(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR) == openni::STATUS_OK);
    if (has_color_) device_.setDepthColorSyncEnabled(true);
  }

  /// Drivers show a mirror image unless they are told not to.
  static void unmirror(VideoStream& stream) {
    if (stream.isPropertySupported(openni::STREAM_PROPERTY_MIRRORING) && stream.getMirroringEnabled()) {
      check(stream.setMirroringEnabled(false), "the camera keeps showing a mirror image");
    }
  }

  void read_calibration(const Options& options) {
    const VideoMode mode = depth_.getVideoMode();
    const int width = mode.getResolutionX();
    const int height = mode.getResolutionY();
    const float across_rad = (has_color_ ? color_ : depth_).getHorizontalFieldOfView();
    const bool known = across_rad > 0.1F && across_rad < 3.0F;
    if (!known && !options.has("--fx")) {
      throw std::runtime_error{"the driver does not tell the field of view; give --fx, and --fy, --cx, --cy"};
    }
    // Pixels are square. The vertical field of view belongs to all of the sensor, even where rows are cut off.
    const double fx = options.number("--fx", known ? 0.5 * width / std::tan(0.5 * across_rad) : 0.0);
    hello_ = camera_hello(width, height, fx, options.number("--fy", fx), options.number("--cx", 0.5 * (width - 1)),
                          options.number("--cy", 0.5 * (height - 1)), options.number("--min-range", 0.4),
                          options.number("--max-range", 4.5), "uint16_mm", has_color_ ? "rgb8" : "none");
  }

  static bool ready(VideoStream* stream, int longest_ms) {
    int index{0};
    return openni::OpenNI::waitForAnyStream(&stream, 1, &index, longest_ms) == openni::STATUS_OK;
  }

  static openni::VideoFrameRef next_frame(const Wanted& stream) {
    openni::VideoFrameRef frame;
    check(stream.stream->readFrame(&frame), "the camera's " + stream.name + " cannot be read");
    return frame;
  }

  /// Without what may lie between the rows.
  [[nodiscard]] std::string rows_of(const openni::VideoFrameRef& frame, const Wanted& stream) const {
    const int width = hello_.at("width");
    const int height = hello_.at("height");
    if (frame.getWidth() != width || frame.getHeight() != height) {
      throw std::runtime_error{"an image of " + stream.name + " has " + std::to_string(frame.getWidth()) + " x " +
                               std::to_string(frame.getHeight()) + " pixels"};
    }
    std::string rows;
    for (int v = 0; v < height; ++v) {
      rows.append(static_cast<const char*>(frame.getData()) + static_cast<std::ptrdiff_t>(v) * frame.getStrideInBytes(),
                  static_cast<std::size_t>(width) * stream.pixel_bytes);
    }
    return rows;
  }

  int skip_;
  openni::Device device_;
  VideoStream depth_;
  VideoStream color_;
  bool has_color_{false};
  nlohmann::json hello_;
};

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options{argc, argv};
    options.only({"", "--width", "--color", "--fx", "--fy", "--cx", "--cy", "--min-range", "--max-range", "--skip"});
    return run_camera([&] { return std::make_unique<OpenNi2Camera>(options); });
  } catch (const std::exception& e) {
    std::cerr << "saccade-openni2-camera: " << e.what() << '\n';
    return 1;
  }
}
