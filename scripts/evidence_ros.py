#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the node kinfu for minutes at 30 Hz: memory of the process, and what a frame costs beside tracking and fusion.

evidence_ros.py [BUILD] [MINUTES]   (build/release, 10)"""
import os
import re
import sys
import time

build = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "build/release")
minutes = float(sys.argv[2]) if len(sys.argv) > 2 else 10.0
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests", "ros1"))
import ros_session


def resident_mb(pid):
    with open(f"/proc/{pid}/status") as status:
        return next(int(line.split()[1]) / 1024 for line in status if line.startswith("VmRSS"))


def main():
    session = ros_session.Session(build + "/saccade-ros1", build + "/ros1/python")
    levels = os.path.join(session.folder, "levels")
    with open(levels, "w") as file:
        file.write("log4j.logger.ros=DEBUG\n")
    os.environ["ROSCONSOLE_CONFIG_FILE"] = levels
    try:
        import numpy as np
        import rospy
        import numpy_scene as scene
        from sensor_msgs.msg import CameraInfo, Image
        from std_msgs.msg import Header
        scene.WIDTH, scene.HEIGHT, scene.FOCAL = 640, 480, 525.0
        scene.rays.__defaults__ = (640, 480, 525.0, np.array([319.5, 239.5]))
        angles = np.linspace(0, 2 * np.pi, 60, endpoint=False)
        frames = [(1000 * scene.depth_from(translation=(0.03 * (np.cos(a) - 1), 0.03 * np.sin(a), 0))).astype("<u2").tobytes() for a in angles]
        process = session.node("kinfu", "_volume_size:=2.56", "_volume_resolution:=256")
        rospy.init_node("camera", disable_signals=True)
        acks = []
        rospy.Subscriber("/kinfu_image_ack", Header, lambda m: acks.append(m.stamp))
        images = rospy.Publisher("/camera/depth/image_raw", Image, queue_size=5)
        infos = rospy.Publisher("/camera/depth/camera_info", CameraInfo, queue_size=5)
        session.until(lambda: images.get_num_connections() and infos.get_num_connections(), 10, "the node listens to nothing")
        info = CameraInfo(width=640, height=480, K=[525, 0, 319.5, 0, 525, 239.5, 0, 0, 1])
        begin, sent, memory = time.time(), 0, []
        while time.time() < begin + 60 * minutes:
            image = Image(width=640, height=480, step=1280, encoding="16UC1", data=frames[sent % 60])
            image.header.stamp = rospy.Time.now()
            infos.publish(info)
            images.publish(image)
            sent += 1
            if sent % 300 == 0:
                memory.append(resident_mb(process.pid))
                print(f"{sent / 30:6.0f} s: {memory[-1]:.1f} MB, {len(acks)} of {sent} frames", flush=True)
            time.sleep(max(0.0, begin + sent / 30 - time.time()))
        costs = [[float(x) for x in m] for m in re.findall(r"conversion ([\d.]+) ms, tracking ([\d.]+) ms, fusion ([\d.]+) ms", session.log("kinfu"))]
        conversion, tracking, fusion = np.median(costs, axis=0)
        lost = session.log("kinfu").count("tracking is lost")
        late = memory[len(memory) // 2:]
        print(f"{len(acks)} of {sent} frames; conversion {conversion:.2f} ms (95 %: {np.quantile([c[0] for c in costs], 0.95):.2f}), "
              f"tracking {tracking:.1f} ms, fusion {fusion:.1f} ms; said to be lost {lost} times; "
              f"memory in the second half {min(late):.1f} to {max(late):.1f} MB")
        good = max(late) - min(late) < 10 and conversion <= 3 and process.poll() is None
    finally:
        session.close()
    os._exit(0 if good else 1)


if __name__ == "__main__":
    main()
