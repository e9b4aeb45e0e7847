// SPDX-License-Identifier: Apache-2.0
// Records the first camera of OpenNI2 for half a second: openni2_recorder FILE.oni [registered]
#include <OpenNI.h>

#include <chrono>
#include <thread>

int main(int argc, char** argv) {
  using namespace openni;
  if (argc < 2 || OpenNI::initialize() != STATUS_OK) return 1;
  Device device;
  VideoStream depth;
  VideoStream color;
  Recorder recorder;
  if (device.open(ANY_DEVICE) != STATUS_OK) return 2;
  if (argc > 2 && device.setImageRegistrationMode(IMAGE_REGISTRATION_DEPTH_TO_COLOR) != STATUS_OK) return 3;
  if (depth.create(device, SENSOR_DEPTH) != STATUS_OK || color.create(device, SENSOR_COLOR) != STATUS_OK) return 4;
  depth.setMirroringEnabled(false);
  color.setMirroringEnabled(false);
  if (recorder.create(argv[1]) != STATUS_OK || recorder.attach(depth) != STATUS_OK ||
      recorder.attach(color) != STATUS_OK || depth.start() != STATUS_OK || color.start() != STATUS_OK ||
      recorder.start() != STATUS_OK) {
    return 5;
  }
  std::this_thread::sleep_for(std::chrono::milliseconds{500});
  recorder.stop();
  recorder.destroy();
  depth.destroy();
  color.destroy();
  device.close();
  OpenNI::shutdown();
}
