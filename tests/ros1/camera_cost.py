# SPDX-License-Identifier: Apache-2.0
"""Cost of a frame's path through `saccade-ros1 camera` costs: from the callback to the last byte at Saccade's end.

camera_cost.py SACCADE_ROS1 PYTHON_MESSAGES [16UC1|32FC1] [K1]: 640 x 480 at 30 Hz, 200 frames; K1 is the lens' distortion."""
import json
import re
import statistics
import subprocess
import sys
import threading
import time

from ros_session import Session

session = Session(*sys.argv[1:3])
encoding = sys.argv[3] if len(sys.argv) > 3 else "16UC1"
k1 = float(sys.argv[4]) if len(sys.argv) > 4 else 0.0

import rospy  # noqa: E402
from sensor_msgs.msg import CameraInfo, Image  # noqa: E402

rospy.init_node("cost", disable_signals=True)
images = rospy.Publisher("/depth/image_raw", Image, queue_size=2)
infos = rospy.Publisher("/depth/camera_info", CameraInfo, queue_size=2)
pixel = 2 if encoding == "16UC1" else 4
image = Image(height=480, width=640, encoding=encoding, step=640 * pixel, data=b"\1\2\0\0"[:pixel] * (640 * 480))
info = CameraInfo(height=480, width=640, distortion_model="plumb_bob", D=[k1, 0, 0, 0, 0])
info.K = [525, 0, 319.5, 0, 525, 239.5, 0, 0, 1]


def publish():
    rate = rospy.Rate(30)
    while not rospy.is_shutdown():
        image.header.stamp = info.header.stamp = rospy.Time.now()
        infos.publish(info)
        images.publish(image)
        rate.sleep()


threading.Thread(target=publish, daemon=True).start()
camera = subprocess.Popen([sys.argv[1], "camera", "/depth", "--times", "yes"], stdin=subprocess.PIPE,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def ask(**request):
    camera.stdin.write(json.dumps(request).encode() + b"\n")
    camera.stdin.flush()
    answer = json.loads(camera.stdout.readline())
    camera.stdout.read(answer.get("bytes", 0))
    return answer


ask(request="hello", role="camera", saccade=1)
ends = []
for number in range(200):
    ask(request="capture", number=number, T_world_camera=[])
    ends.append(time.monotonic())
camera.stdin.close()
told = re.findall(r"([\d.e-]+) ms to convert; came at ([\d.]+)", camera.stderr.read().decode())
ways = [1e3 * (end - float(came)) for end, (_, came) in zip(ends, told)]
converts = [float(ms) for ms, _ in told]
print(f"{len(ways)} frames of 640 x 480 {encoding}: from callback to the last byte {statistics.median(ways):.2f} ms "
      f"(95 %: {sorted(ways)[int(0.95 * len(ways))]:.2f}), of which conversion {statistics.median(converts):.2f} ms")
session.close()
