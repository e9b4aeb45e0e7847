// SPDX-License-Identifier: Apache-2.0
// A Kinect that is not there: put before libfreenect (LD_PRELOAD), it answers in its place.
//
// Registered depth of pixel (u, v) is 1000 + u + 2 v mm, colour (u / 4, v / 2, 9). Pixels (0, 0) and (1, 0) of depth
// are special: 1000 + the milliseconds, modulo 2000, of the moment at which the exposure of the frame began, and 1000 +
// the longest time so far for which events were not asked for, milliseconds, at most 1000. After KINECT_DIES frames,
// the device is gone.
#include <libfreenect.h>
#include <libfreenect_registration.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <vector>

namespace {

constexpr int kWidth{640};
constexpr int kHeight{480};
using Clock = std::chrono::steady_clock;

freenect_depth_cb on_depth{nullptr};
freenect_video_cb on_video{nullptr};
void* user{nullptr};
bool depth_runs{false};
bool video_runs{false};
int frames{0};
Clock::time_point came[2]{Clock::now(), Clock::now()};
Clock::time_point asked = Clock::now();
long longest_ms{0};

long ms(Clock::duration time) { return std::chrono::duration_cast<std::chrono::milliseconds>(time).count(); }

freenect_frame_mode mode_of(int format, int bytes) {
  freenect_frame_mode mode{};
  mode.resolution = FREENECT_RESOLUTION_MEDIUM;
  mode.dummy = format;
  mode.bytes = kWidth * kHeight * bytes;
  mode.width = kWidth;
  mode.height = kHeight;
  mode.is_valid = 1;
  return mode;
}

freenect_device* device() {
  static int something{0};
  return reinterpret_cast<freenect_device*>(&something);
}

void send(long exposed_ms) {
  std::vector<std::uint16_t> depth(kWidth * kHeight);
  std::vector<std::uint8_t> color(3 * kWidth * kHeight);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const auto at = static_cast<std::size_t>(v * kWidth + u);
      depth[at] = static_cast<std::uint16_t>(1000 + u + 2 * v);
      color[3 * at] = static_cast<std::uint8_t>(u / 4);
      color[3 * at + 1] = static_cast<std::uint8_t>(v / 2);
      color[3 * at + 2] = 9;
    }
  }
  depth[0] = static_cast<std::uint16_t>(1000 + exposed_ms % 2000);
  depth[1] = static_cast<std::uint16_t>(1000 + longest_ms);
  if (depth_runs) on_depth(device(), depth.data(), 0);
  if (video_runs) on_video(device(), color.data(), 0);
}

}  // namespace

extern "C" {
int freenect_init(freenect_context** context, freenect_usb_context*) {
  *context = reinterpret_cast<freenect_context*>(device());
  return 0;
}
int freenect_shutdown(freenect_context*) { return 0; }
void freenect_set_log_level(freenect_context*, freenect_loglevel) {}
void freenect_select_subdevices(freenect_context*, freenect_device_flags) {}
int freenect_num_devices(freenect_context*) { return 1; }
int freenect_open_device(freenect_context*, freenect_device** opened, int) {
  *opened = device();
  return 0;
}
int freenect_close_device(freenect_device*) { return 0; }
void freenect_set_user(freenect_device*, void* data) { user = data; }
void* freenect_get_user(freenect_device*) { return user; }
int freenect_get_depth_mode_count() { return 2; }
freenect_frame_mode freenect_get_depth_mode(int i) {
  return mode_of(i == 0 ? FREENECT_DEPTH_11BIT : FREENECT_DEPTH_REGISTERED, 2);
}
freenect_frame_mode freenect_find_video_mode(freenect_resolution, freenect_video_format format) {
  return mode_of(format, 3);
}
int freenect_set_depth_mode(freenect_device*, freenect_frame_mode mode) {
  return mode.depth_format == FREENECT_DEPTH_REGISTERED ? 0 : -1;
}
int freenect_set_video_mode(freenect_device*, freenect_frame_mode mode) {
  return mode.video_format == FREENECT_VIDEO_RGB ? 0 : -1;
}
void freenect_set_depth_callback(freenect_device*, freenect_depth_cb callback) { on_depth = callback; }
void freenect_set_video_callback(freenect_device*, freenect_video_cb callback) { on_video = callback; }
int freenect_start_depth(freenect_device*) {
  depth_runs = true;
  asked = Clock::now();
  return 0;
}
int freenect_start_video(freenect_device*) {
  video_runs = true;
  return 0;
}
int freenect_stop_depth(freenect_device*) { return 0; }
int freenect_stop_video(freenect_device*) { return 0; }

/// Every 10 ms there is a frame. It is exposed while the one before it is on its way: it comes two frames after its
/// exposure began.
int freenect_process_events_timeout(freenect_context*, timeval*) {
  longest_ms = std::clamp(ms(Clock::now() - asked), longest_ms, 1000L);
  std::this_thread::sleep_for(std::chrono::milliseconds{1});
  asked = Clock::now();
  if (asked - came[1] < std::chrono::milliseconds{10}) return 0;
  const char* dies = std::getenv("KINECT_DIES");
  if (dies != nullptr && frames >= std::atoi(dies)) return -1;
  send(ms(came[0].time_since_epoch()));
  ++frames;
  came[0] = came[1];
  asked = came[1] = Clock::now();
  return 0;
}

/// Rows of colour are 0.9 as far apart as those of depth.
freenect_registration freenect_copy_registration(freenect_device*) {
  freenect_registration registration{};
  registration.zero_plane_info = {7.0F, 2.3F, 120.0F, 0.1F};
  registration.const_shift = 200.0;
  registration.registration_table = new std::int32_t[kWidth * kHeight][2];
  for (int i = 0; i < kWidth * kHeight; ++i) registration.registration_table[i][1] = (i / kWidth * 9 + 200) / 10;
  return registration;
}
int freenect_destroy_registration(freenect_registration* registration) {
  delete[] registration->registration_table;
  return 0;
}
}
