# SPDX-License-Identifier: Apache-2.0
"""A robot of ROS 1 as a cell: it explores as through pipes alone, and its faults are said.

seams_test.py SACCADE_ROS1 PYTHON_MESSAGES"""
import json
import os
import signal
import subprocess
import sys
import time
import unittest

from ros_session import Session, skip

try:
    import actionlib  # noqa: F401
    import rospy  # noqa: F401
    import tf2_msgs  # noqa: F401
except ImportError as error:
    skip(f"{error} (packages.txt, ros)")

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
PROGRAM, MESSAGES = sys.argv[1:3]
BUILD = os.path.dirname(os.path.abspath(PROGRAM))
SCENE = "tabletop-1"
CAMERA = f"{BUILD}/saccade-simulated-camera --scene {SCENE} --state state --width 160 --noise 0"
ACTION = "/arm_controller/follow_joint_trajectory"
OPTIONS = ["--voxel-size", "0.01", "--no-pictures", "--quiet", "--radius", "0.6", "--truth", "--json", "-"]


def write_cell(folder, name, camera, joints, more=""):
    with open(f"{ROOT}/scenes/{SCENE}.yaml") as scene:
        text = scene.read()
    path = os.path.join(folder, name)
    with open(path, "w") as file:
        file.write(f"{text}arm: {{robot: comau_smart_six}}\ncamera: {camera}\njoints: {joints}\n{more}")
    return path


def saccade(*command):
    return subprocess.Popen([f"{BUILD}/saccade", *command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def ended(process):
    out, err = process.communicate(timeout=60)
    return process.returncode, (json.loads(out)["result"] if out else None), err


class Device:
    """A program of saccade-ros1, spoken to as Saccade does."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen([PROGRAM, *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE)

    def tell(self, **request):
        self.process.stdin.write(json.dumps(request).encode() + b"\n")
        self.process.stdin.flush()

    def hear(self):
        return json.loads(self.process.stdout.readline())

    def ask(self, **request):
        self.tell(**request)
        return self.hear()

    def close(self):
        self.process.stdin.close()
        status = self.process.wait(timeout=3)
        error = self.process.stderr.read().decode()
        self.process.stdout.close()
        self.process.stderr.close()
        return status, error


class Seams(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.session = Session(PROGRAM, MESSAGES)
        cls.folder = cls.session.folder
        cls.start_robot()
        cls.cell = write_cell(cls.folder, "cell.yaml", "ros:/camera/depth",
                              f"{{ros: {ACTION}, states: /joint_states, watchdog: 0.4}}")

    @classmethod
    def start_robot(cls):
        cls.robot = cls.session.start(["/usr/bin/python3", f"{HERE}/simulated_robot.py", cls.folder, CAMERA], "robot")

    @classmethod
    def tearDownClass(cls):
        cls.session.close()

    def setUp(self):
        self.fault("")

    def fault(self, what):
        with open(os.path.join(self.folder, "fault"), "w") as file:
            file.write(what)

    def explore(self, cell, out, *more):
        return saccade("explore", cell, "--out", os.path.join(self.folder, out), *OPTIONS, *more)

    def test_1_a_cell_explores_as_through_pipes_alone(self):
        pipes = write_cell(self.folder, "pipes.yaml", json.dumps({"command": CAMERA.replace("state state", "state pipe")}),
                           json.dumps({"command": f"{BUILD}/saccade-simulated-arm --state pipe --rate 4"}))
        alone = ended(self.explore(pipes, "pipes", "--max-views", "2"))
        ros = ended(self.explore(self.cell, "ros", "--max-views", "2"))
        self.assertEqual(alone[0], 0, alone[2])
        self.assertEqual(ros[0], 0, ros[2])
        covered = [run[1]["final"]["coverage"] for run in (alone, ros)]
        print("coverage through pipes and over ROS:", covered)
        self.assertAlmostEqual(*covered, delta=0.01)

    def test_2_a_topic_that_stops_ends_the_run_which_goes_on_with_a_new_node(self):
        run = self.explore(self.cell, "faulty", "--max-views", "1", "--process-timeout", "10")
        Session.until(lambda: os.path.exists(os.path.join(self.folder, "faulty/journal.json")) or run.poll() is not None, 20, "no journal")
        self.fault("no images")
        status, _, error = ended(run)
        self.assertEqual(status, 3, error)
        self.assertRegex(error, r"no image came on /camera/depth/image_raw for .* s; the last one came .* s ago")
        self.fault("")
        os.killpg(self.robot.pid, signal.SIGKILL)
        self.start_robot()
        status, result, error = ended(self.explore(self.cell, "faulty", "--max-views", "1", "--resume"))
        self.assertEqual(status, 0, error)
        self.assertEqual(len(result["views"]), 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
