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

    def capture(self):
        answer = self.ask(request="capture", number=1, T_world_camera=[])
        self.process.stdout.read(answer.get("bytes", 0))
        return answer

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
        cls.cell = write_cell(cls.folder, "cell.yaml", "{ros: /camera/depth, timeout: 2}",
                              f"{{ros: {ACTION}, states: /joint_states, watchdog: 0.4}}")

    @classmethod
    def start_robot(cls):
        cls.robot = cls.session.start(["/usr/bin/python3", f"{HERE}/simulated_robot.py", cls.folder, CAMERA], "robot")
        master = rosgraph.Master("/test")
        wanted = {"/camera/depth/image_raw", ACTION + "/feedback"}
        Session.until(lambda: wanted <= {name for name, _ in master.getPublishedTopics("")}, 20, "no robot")

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
        both = [self.explore(pipes, "pipes", "--max-views", "2"), self.explore(self.cell, "ros", "--max-views", "2")]
        alone, ros = [ended(run) for run in both]
        self.assertEqual(alone[0], 0, alone[2])
        self.assertEqual(ros[0], 0, ros[2])
        covered = [run[1]["final"]["coverage"] for run in (alone, ros)]
        print("coverage through pipes and over ROS:", covered)
        self.assertAlmostEqual(*covered, delta=0.01)

    def test_2_a_topic_that_stops_ends_the_run_which_goes_on_with_a_new_node(self):
        run = self.explore(self.cell, "faulty", "--max-views", "1")
        journal = os.path.join(self.folder, "faulty/journal.json")
        Session.until(lambda: os.path.exists(journal) or run.poll() is not None, 20, "no journal")
        self.fault("no images")
        status, _, error = ended(run)
        self.assertEqual(status, 4, error)
        self.assertRegex(error, r"no image came on /camera/depth/image_raw for .* s; the last one came .* s ago")
        self.fault("")
        os.killpg(self.robot.pid, signal.SIGKILL)
        self.start_robot()
        status, result, error = ended(self.explore(self.cell, "faulty", "--max-views", "1", "--resume"))
        self.assertEqual(status, 0, error)
        self.assertEqual(len(result["views"]), 1)

    def device(self, *arguments, role, **hello):
        device = Device(role, *arguments)
        self.addCleanup(lambda: device.process.poll() is None and device.close())
        self.assertEqual(device.ask(request="hello", role=role, saccade=1, **hello).get("saccade"), 1)
        return device

    def refused(self, *arguments, role, **hello):
        device = Device(role, *arguments, "--timeout", "0.5")
        error = device.ask(request="hello", role=role, saccade=1, **hello)["error"]
        device.close()
        return error

    def test_3_a_camera_says_what_is_wrong_with_its_topic(self):
        self.assertRegex(self.refused("/nothing", role="camera"),
                         "no node publishes images on /nothing.*: /camera/depth/image_raw$")
        self.assertIn("topics with camera_info: /camera/depth/camera_info",
                      self.refused("/camera/depth", "--info", "/nothing", role="camera"))
        camera = self.device("/camera/depth/image_raw", "--timeout", "1", "--times", "yes", role="camera")

        before = time.time()
        self.assertGreater(camera.capture()["time_s"], before)  # the image was taken after it was asked for
        self.fault("stamps")
        time.sleep(0.2)
        self.assertLess(camera.capture()["time_s"], before - 90)
        self.fault("no images")
        time.sleep(0.2)
        self.assertIn("no image came on /camera/depth/image_raw for 1.0 s", camera.capture()["error"])
        self.fault("size")
        time.sleep(0.2)
        self.assertIn("160 x 120 pixels, and /camera/depth/camera_info says 80 x 120",
                      self.device("/camera/depth", role="camera").capture()["error"])
        status, error = camera.close()
        self.assertEqual(status, 0)
        self.assertIn("100.0 s behind ROS's clock", error)

    def test_4_joints_follow_stop_and_fail_in_words(self):
        names = [f"joint_{i}" for i in range(1, 7)]
        self.assertIn("actions that are there: " + ACTION, self.refused("/nothing", role="joints", joints=names))
        self.assertIn("/joint_states has no joint 'elbow'; it has gripper, joint_1",
                      self.refused(ACTION, role="joints", joints=names[:-1] + ["elbow"]))
        joints = self.device(ACTION, role="joints", joints=names)
        start = joints.ask(request="joints", number=0)["q"]
        here = start[:-1] + [start[-1] + 0.5]
        points = [{"t_s": 0.0, "q": start, "dq": [0.0] * 6}, {"t_s": 2.0, "q": here, "dq": [0.0] * 6}]

        def follow(number):
            joints.tell(request="follow", number=number, points=points)
            return joints.hear()

        self.assertFalse(follow(1)["done"])
        joints.tell(request="stop", number=2)
        answer = joints.hear()
        while answer["number"] == 1:
            answer = joints.hear()
        self.assertLess(abs(answer["q"][-1] - joints.ask(request="joints", number=3)["q"][-1]), 1e-3)
        self.assertLess(answer["q"][-1], start[-1] + 0.4)

        follow(4)
        self.fault("abort")
        while "error" not in answer:
            answer = joints.hear()
        self.assertRegex(answer["error"], "ABORTED, error_code -4: elbow blocked")
        self.fault("")

        follow(5)
        self.fault("no states")
        answer = joints.hear()
        while "error" not in answer:
            answer = joints.hear()
        self.assertRegex(answer["error"], "no positions come on /joint_states any more; the last ones came 0.2 s ago")
        self.fault("")
        time.sleep(0.1)

        follow(6)
        os.killpg(self.robot.pid, signal.SIGKILL)
        answer = joints.hear()
        while "error" not in answer:
            answer = joints.hear()
        self.assertRegex(answer["error"], "has gone|no positions come")
        Seams.start_robot()
        answer = joints.ask(request="joints", number=7)  # waits for the node, which is new
        self.assertEqual(len(answer["q"]), 6)
        points[-1]["t_s"] = 0.1
        answer = follow(8)
        while not answer.get("done"):
            self.assertNotIn("error", answer)
            answer = joints.hear()
        self.assertAlmostEqual(answer["q"][-1], here[-1], delta=1e-6)

        points[0]["q"] = here
        points[-1]["q"], points[-1]["t_s"] = start, 2.0
        follow(9)
        joints.process.send_signal(signal.SIGTERM)  # cancels the goal, too
        self.assertEqual(joints.process.wait(timeout=2), 0)
        joints.close()
        joints = self.device(ACTION, role="joints", joints=names)
        stood = joints.ask(request="joints", number=0)["q"]
        self.assertEqual(stood, joints.ask(request="joints", number=1)["q"])
        self.assertGreater(stood[-1], start[-1] + 0.1)
        self.assertEqual(joints.close()[0], 0)

    def test_5_a_hand_in_tf(self):
        rospy.init_node("hand", anonymous=True, disable_signals=True)
        publisher = rospy.Publisher("/tf", TFMessage, queue_size=4)
        hand = self.device("/hand_frame", "--lost", "0.2", role="hand")
        self.assertIsNone(hand.ask(request="sample", number=0)["position"])
        Session.until(lambda: publisher.get_num_connections() > 0, 5, "the hand does not listen to /tf")

        def tell(x):
            transform = TransformStamped(child_frame_id="hand_frame")
            transform.header.frame_id = "world"
            transform.header.stamp = rospy.Time.now()
            transform.transform.translation.x = x
            transform.transform.rotation.w = 1.0
            publisher.publish(TFMessage([transform]))
            return transform.header.stamp.to_sec()

        hand.tell(request="sample", number=1)
        stamp = tell(0.25)
        answer = hand.hear()
        self.assertEqual(answer["position"], [0.25, 0.0, 0.0])
        self.assertAlmostEqual(answer["time_s"], stamp, delta=1e-6)
        hand.tell(request="sample", number=2)
        tell(float("nan"))
        answer = hand.hear()
        self.assertIsNone(answer["position"])
        self.assertGreater(answer["time_s"], stamp)
        hand.tell(request="sample", number=3)
        tell(0.5)
        self.assertEqual(hand.hear()["position"][0], 0.5)
        status, error = hand.close()
        self.assertEqual(status, 0)
        self.assertIn("nan", error.lower())

    def test_6_a_roscore_that_is_restarted_is_joined_again(self):
        camera = self.device("/camera/depth", "--timeout", "8", role="camera")
        for process in (self.session.core, self.robot):
            os.killpg(process.pid, signal.SIGKILL)
        self.assertIn("no ROS master answers", self.refused("/camera/depth", role="camera"))
        self.session.start_master()
        Seams.start_robot()
        answer = camera.capture()
        self.assertEqual(answer.get("bytes"), 4 * 160 * 120, answer)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
