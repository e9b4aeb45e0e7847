#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A cell on a robot of ROS 1: it is checked, and looks again where a hand that TF follows has put a bottle down.

cell_test.py SACCADE_ROS1 PYTHON_MESSAGES"""
import csv
import json
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

from ros_session import Session, skip

try:
    import rosgraph
    import rospy
    from geometry_msgs.msg import TransformStamped
    from tf2_msgs.msg import TFMessage
except ImportError as error:
    skip(f"{error} (packages.txt, ros)")

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
PROGRAM, MESSAGES = sys.argv[1:3]
BUILD = os.path.dirname(os.path.abspath(PROGRAM))
ACTION = "/arm_controller/follow_joint_trajectory"
CAMERA = f"{BUILD}/saccade-simulated-camera --scene bottle-before --then bottle --when put-down --state state --width 120"


class Hand(threading.Thread):
    """Says in TF where the hand is: far away, then along the samples, then nothing more."""

    def __init__(self, samples, put_down):
        super().__init__(daemon=True)
        self.samples, self.put_down = samples, put_down
        self.publisher = rospy.Publisher("/tf", TFMessage, queue_size=50)

    def run(self):
        begin = rospy.get_time()
        for sample in self.samples:
            time.sleep(max(0.0, begin + sample[0] - rospy.get_time()))
            transform = TransformStamped(child_frame_id="hand")
            transform.header.frame_id = "world"
            transform.header.stamp = rospy.Time.from_sec(begin + sample[0])
            (transform.transform.translation.x, transform.transform.translation.y, transform.transform.translation.z) = sample[1:]
            transform.transform.rotation.w = 1.0
            self.publisher.publish(TFMessage([transform]))
        open(self.put_down, "w").close()


class Cell(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.session = Session(PROGRAM, MESSAGES)
        cls.folder = cls.session.folder
        cls.session.start(["/usr/bin/python3", f"{HERE}/simulated_robot.py", cls.folder, CAMERA], "robot")
        master = rosgraph.Master("/test")
        wanted = {"/camera/depth/image_raw", ACTION + "/feedback"}
        Session.until(lambda: wanted <= {name for name, _ in master.getPublishedTopics("")}, 20, "no robot")
        rospy.init_node("hand", disable_signals=True)
        cls.cell = os.path.join(cls.folder, "cell.yaml")
        with open(f"{ROOT}/scenes/bottle-before.yaml") as scene, open(cls.cell, "w") as cell:
            cell.write(f"{scene.read()}arm: {{robot: comau_smart_six}}\ncamera: ros:/camera/depth\n"
                       f"joints: {{ros: {ACTION}, states: /joint_states, watchdog: 2}}\nhand: ros:hand\n")

    @classmethod
    def tearDownClass(cls):
        cls.session.close()

    def saccade(self, *command):
        return subprocess.Popen([f"{BUILD}/saccade", *command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=self.folder)

    def test_1_the_check_starts_each_device(self):
        hand = Hand([(0.02 * i, 0.1, 0.2, 0.9) for i in range(150)], os.devnull)
        hand.start()
        out, err = self.saccade("cell", "check", self.cell, "--out", "check", "--json", "-").communicate(timeout=60)
        result = json.loads(out)["result"]
        self.assertEqual(result["problems"], [], err)
        self.assertEqual((result["camera"]["intrinsics"]["width"], result["hand"]["seen"]), (120, True))
        self.assertEqual(result["scan"]["reached"], result["scan"]["poses"])
        hand.join()

    def test_2_the_robot_looks_again_where_the_hand_acted(self):
        simulated = self.saccade("update", "--scene", "bottle", "--out", "simulated", "--robot", "free", "--max-views", "0", "--image-size",
                                 "80,60", "--voxel-size", "0.02", "--no-pictures", "--quiet")
        simulated.communicate(timeout=60)
        with open(os.path.join(self.folder, "simulated/hand.csv")) as file:
            samples = [tuple(map(float, row[:4])) for row in list(csv.reader(file))[1:]]
        said = os.path.join(self.folder, "said")
        with open(said, "w") as errors:
            run = subprocess.Popen([f"{BUILD}/saccade", "update", self.cell, "--out", "run", "--voxel-size", "0.02", "--max-views", "2"],
                                   stdout=subprocess.DEVNULL, stderr=errors, cwd=self.folder)

        def text():
            with open(said) as file:
                return file.read()

        def tasks():
            try:
                with open(os.path.join(self.folder, "run/update.json")) as file:
                    return json.load(file)["result"]["tasks"]
            except (OSError, ValueError):
                return []

        Session.until(lambda: "waiting for the hand" in text() or run.poll() is not None, 60, "the scan does not end")
        Hand(samples, os.path.join(self.folder, "put-down")).start()
        Session.until(lambda: any(task["back"]["at_stand_by"] for task in tasks()) or run.poll() is not None, 60, "no task was looked at")
        run.send_signal(signal.SIGINT)
        self.assertEqual(run.wait(timeout=30), 130, text())
        self.assertEqual(len(tasks()), 1)
        task = tasks()[0]
        self.assertGreater(task["samples"]["total"], 50)
        self.assertGreaterEqual(len(task["views"]), 1, f"{task}\n{text()}")
        self.assertTrue(task["back"]["at_stand_by"])
        for region in task["regions"]:
            self.assertLess(region["unknown"][-1], 0.5 * region["unknown"][0])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
