# SPDX-License-Identifier: Apache-2.0
"""A robot of ROS 1: FollowJointTrajectory, joint_states at 50 Hz, and a depth camera in its hand.

simulated_robot.py FOLDER CAMERA_COMMAND: FOLDER/state is where saccade-simulated-camera reads the joints; a line in
FOLDER/fault says what is wrong at the moment: "no images", "abort", "size", "stamps", "no states"."""
import json
import mmap
import os
import struct
import subprocess
import sys
import threading

import actionlib
import rospy
from control_msgs.msg import FollowJointTrajectoryAction, FollowJointTrajectoryResult
from sensor_msgs.msg import CameraInfo, Image, JointState

JOINTS = [f"joint_{i}" for i in range(1, 7)]
START = [0.5 * (low + high) for low, high in ((-2.094, 0.959), (-1.484, 1.705), (-2.792526803, 0.0), (-3.665, 3.665),
                                              (-1.57, 1.57), (-3.14159, 3.14159))]


class State:
    """Positions in the file that the simulated programs share."""

    def __init__(self, path):
        size = 8 * 18
        with open(path, "a+b") as file:
            file.truncate(size)
            self.memory = mmap.mmap(file.fileno(), size)
        writes, count = struct.unpack_from("QQ", self.memory)
        self.writes = writes + writes % 2
        self.write(list(struct.unpack_from("6d", self.memory, 16)) if count == 6 else START)

    def write(self, q):
        struct.pack_into("Q", self.memory, 0, self.writes + 1)
        struct.pack_into("Q6d", self.memory, 8, 6, *q)
        self.writes += 2
        struct.pack_into("Q", self.memory, 0, self.writes)
        self.q = q


class Robot:
    def __init__(self, folder, camera_command):
        self.fault_file = os.path.join(folder, "fault")
        self.state = State(os.path.join(folder, "state"))
        self.states = rospy.Publisher("/joint_states", JointState, queue_size=8)
        self.images = rospy.Publisher("/camera/depth/image_raw", Image, queue_size=2)
        self.infos = rospy.Publisher("/camera/depth/camera_info", CameraInfo, queue_size=2)
        self.camera = subprocess.Popen(camera_command, shell=True, cwd=folder, stdin=subprocess.PIPE,
                                       stdout=subprocess.PIPE)
        self.about = self.ask({"request": "hello", "role": "camera", "saccade": 1})
        self.server = actionlib.SimpleActionServer("/arm_controller/follow_joint_trajectory",
                                                   FollowJointTrajectoryAction, self.follow, auto_start=False)
        self.server.start()
        for work in (self.tell_states, self.tell_images):
            threading.Thread(target=work, daemon=True).start()

    def fault(self):
        try:
            with open(self.fault_file) as file:
                return file.read().strip()
        except OSError:
            return ""

    def ask(self, request):
        self.camera.stdin.write(json.dumps(request).encode() + b"\n")
        self.camera.stdin.flush()
        return json.loads(self.camera.stdout.readline())

    def follow(self, goal):
        order = [goal.trajectory.joint_names.index(name) for name in JOINTS]
        points = goal.trajectory.points
        began = rospy.get_time()
        i = 1
        while not rospy.is_shutdown():
            if self.server.is_preempt_requested():
                return self.server.set_preempted()
            if self.fault() == "abort":
                result = FollowJointTrajectoryResult(error_code=-4, error_string="elbow blocked")
                return self.server.set_aborted(result)
            t = rospy.get_time() - began
            while i + 1 < len(points) and points[i].time_from_start.to_sec() < t:
                i += 1
            a, b = points[i - 1], points[min(i, len(points) - 1)]
            step = (b.time_from_start - a.time_from_start).to_sec()
            share = min(max((t - a.time_from_start.to_sec()) / step, 0.0), 1.0) if step > 0.0 else 1.0
            self.state.write([a.positions[k] + share * (b.positions[k] - a.positions[k]) for k in order])
            if t >= points[-1].time_from_start.to_sec():
                return self.server.set_succeeded(FollowJointTrajectoryResult())
            rospy.sleep(0.005)

    def tell_states(self):
        rate = rospy.Rate(50)
        while not rospy.is_shutdown():
            if self.fault() != "no states":
                # In an order of its own, and with a joint that is not the arm's.
                message = JointState(name=["gripper"] + JOINTS[::-1], position=[0.01] + self.state.q[::-1])
                message.header.stamp = rospy.Time.now()
                self.states.publish(message)
            rate.sleep()

    def tell_images(self):
        rate = rospy.Rate(15)
        width, height = self.about["width"], self.about["height"]
        pose = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
        number = 0
        while not rospy.is_shutdown():
            rate.sleep()
            fault = self.fault()
            if fault == "no images":
                continue
            stamp = rospy.Time.now()
            answer = self.ask({"request": "capture", "number": number, "T_world_camera": pose})
            number += 1
            data = self.camera.stdout.read(answer["bytes"])
            image = Image(height=height, width=width, encoding="32FC1", step=4 * width, data=data)
            image.header.stamp = stamp + rospy.Duration(-100 if fault == "stamps" else 0)
            info = CameraInfo(height=height, width=width if fault != "size" else width // 2)
            info.header.stamp = image.header.stamp
            info.K = [self.about["fx"], 0, self.about["cx"], 0, self.about["fy"], self.about["cy"], 0, 0, 1]
            self.infos.publish(info)
            self.images.publish(image)


if __name__ == "__main__":
    rospy.init_node("simulated_robot", disable_signals=False)
    Robot(sys.argv[1], sys.argv[2])
    rospy.spin()
