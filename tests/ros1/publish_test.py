#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""explore --publish ros: stock subscribers read every topic, and what they read is the run's own result.

publish_test.py SACCADE_ROS1 PYTHON_MESSAGES; saccade lies beside saccade-ros1."""
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import unittest

import numpy as np
import yaml

from ros_session import Session, free_port, skip

try:
    import rosgraph
    import rospy
    from geometry_msgs.msg import PoseStamped
    from nav_msgs.msg import OccupancyGrid, Path
    from sensor_msgs.msg import CameraInfo, Image, PointCloud2
    from tf2_msgs.msg import TFMessage
    from visualization_msgs.msg import MarkerArray
except ImportError as error:
    skip(f"{error} (packages.txt, ros)")

PROGRAM, MESSAGES = sys.argv[1:3]
ROOT = pathlib.Path(__file__).resolve().parents[2]
SACCADE = pathlib.Path(PROGRAM).resolve().parent / "saccade"
TOPICS = {"/saccade/occupied": PointCloud2, "/saccade/frontier": PointCloud2, "/saccade/map_2d": OccupancyGrid,
          "/saccade/candidates": MarkerArray, "/saccade/next_view": PoseStamped, "/saccade/plan": Path, "/tf": TFMessage,
          "/saccade/depth/image_raw": Image, "/saccade/depth/camera_info": CameraInfo}
SCAN_POSES = 2  # in the file of the scene
OF_A_SCAN = ["/saccade/occupied", "/saccade/frontier", "/saccade/map_2d"]


def floats_of(cloud):
    data = np.frombuffer(cloud.data, "<f4").reshape(-1, cloud.point_step // 4)
    assert len(data) == cloud.width * cloud.height
    return data[:, :3].astype(float)


def rotation_of(q):
    x, y, z, w = q.x, q.y, q.z, q.w
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


class Heard:
    """The last message of each topic."""

    def __init__(self, topics):
        self.last, self.counts, self.lock = {}, {}, threading.Lock()
        self.subscribers = [rospy.Subscriber(topic, TOPICS[topic], self.take, topic) for topic in topics]

    def take(self, message, topic):
        with self.lock:
            self.last[topic] = message
            self.counts[topic] = self.counts.get(topic, 0) + 1

    def has(self, topics, count=1):
        with self.lock:
            return all(self.counts.get(topic, 0) >= count for topic in topics)

    def close(self):
        for subscriber in self.subscribers:
            subscriber.unregister()


class Run:
    """An exploration that asks before each view, so that a test says when it goes on."""

    def __init__(self, folder, name, views, program=SACCADE, **environment):
        self.out = pathlib.Path(folder) / name
        self.process = subprocess.Popen(
            [program, "explore", "--publish", "ros", "tabletop-1", "--robot", "free", "--max-views", str(views),
             "--voxel-size", "0.02", "--image-size", "160,120", "--no-pictures", "--quiet", "--step", "--out", self.out], stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env={**os.environ, **environment})
        self.go(SCAN_POSES)

    def go(self, times=1):
        self.process.stdin.write(times * "y\n")
        self.process.stdin.flush()

    def publisher(self):
        """The number of the process that publishes, once it does; None before."""
        for entry in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                command = (entry / "cmdline").read_bytes().split(b"\0")
                parent = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
            except OSError:
                continue
            if parent == self.process.pid and command[1:2] == [b"publish"]:
                return int(entry.name)
        return None

    def end(self):
        """Exit status, result, standard error."""
        _, error = self.process.communicate(timeout=30)
        result = self.out / "run.json"
        return self.process.returncode, json.loads(result.read_text())["result"] if result.exists() else None, error


class Publish(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.session = Session(PROGRAM, MESSAGES)
        rospy.init_node("listener", anonymous=True, disable_signals=True)

    @classmethod
    def tearDownClass(cls):
        cls.session.close()

    def wait_for_topics(self, topics):
        master = rosgraph.Master("/test")
        Session.until(lambda: set(topics) <= {name for name, _ in master.getPublishedTopics("")}, 10, "no topics")

    def wait_to_hear(self, heard, topics, count=1):
        Session.until(lambda: heard.has(topics, count), 10, f"heard only {heard.counts}")

    def test_0_rviz_shows_each_topic_of_the_table(self):
        table = (ROOT / "docs/guides/looking-at-runs.md").read_text()
        topics = set(re.findall(r"^\| `(/[a-z_/0-9]+)`", table, re.MULTILINE))
        self.assertEqual(topics | {"/saccade/depth/camera_info"}, set(TOPICS))
        for file in ("apps/ros1/package/rviz/saccade.rviz", "apps/ros2/rviz/saccade_ros2.rviz"):
            manager = yaml.safe_load((ROOT / file).read_text())["Visualization Manager"]
            self.assertEqual(manager["Global Options"]["Fixed Frame"], "world")
            shown = set()
            for display in manager["Displays"]:
                kind = display["Class"].split("/")[1]
                name = next((display[key] for key in ("Topic", "Image Topic", "Marker Topic") if key in display), None)
                if isinstance(name, dict):
                    self.assertEqual(name["Durability Policy"], "Transient Local")
                    name = name["Value"]
                shown |= {name, "/tf" if kind == "TF" else None}
                if kind == "Camera":  # subscribes to the camera_info beside its image, too
                    shown.add("/saccade/depth/camera_info")
            self.assertEqual(shown - {None}, set(TOPICS), file)

    def test_1_every_topic_has_what_the_run_has(self):
        began = time.time()
        run = Run(self.session.folder, "run", 2)
        self.wait_for_topics(OF_A_SCAN)
        time.sleep(0.3)  # the messages of the scan are out before any client subscribes
        heard = Heard(TOPICS)
        self.wait_to_hear(heard, OF_A_SCAN)  # since they are latched
        self.assertFalse(heard.has(["/saccade/next_view"]))
        scanned = heard.last["/saccade/occupied"].width
        self.assertGreater(scanned, 100)
        run.go()
        self.wait_to_hear(heard, TOPICS)
        run.go()
        status, result, error = run.end()
        self.assertEqual(status, 0, error)
        self.assertNotIn("goes on without", error)
        self.assertTrue(heard.has(OF_A_SCAN, 3), heard.counts)
        last = heard.last
        heard.close()

        ternary = np.load(run.out / "ternary.npy")
        layout = json.loads((run.out / "ternary.json").read_text())
        occupied = floats_of(last["/saccade/occupied"])
        self.assertGreater(len(occupied), scanned)
        index = np.rint((occupied - layout["origin_m"]) / layout["voxel_size_m"]).astype(int)
        of_the_run = np.argwhere(ternary == 2)[:, ::-1]
        self.assertEqual({tuple(i) for i in index}, {tuple(i) for i in of_the_run})
        frontier = np.rint((floats_of(last["/saccade/frontier"]) - layout["origin_m"]) / layout["voxel_size_m"]).astype(int)
        self.assertGreater(len(frontier), 10)
        self.assertTrue((ternary[frontier[:, 2], frontier[:, 1], frontier[:, 0]] == 0).all())
        self.assertEqual([field.name for field in last["/saccade/occupied"].fields], ["x", "y", "z", "rgb"])

        plan = last["/saccade/map_2d"]
        grid = np.array(plan.data).reshape(plan.info.height, plan.info.width)
        np.testing.assert_array_equal(grid == 100, (ternary == 2).any(0))
        np.testing.assert_array_equal(grid == -1, (ternary == 0).any(0) & ~(ternary == 2).any(0))

        view = result["views"][-1]
        taken = np.array(view["T_world_camera"])
        pose = last["/saccade/next_view"].pose
        np.testing.assert_allclose([pose.position.x, pose.position.y, pose.position.z], taken[:3, 3], atol=1e-9)
        np.testing.assert_allclose(rotation_of(pose.orientation), taken[:3, :3], atol=1e-9)
        markers = {marker.ns: marker for marker in last["/saccade/candidates"].markers}
        self.assertEqual(set(markers), {"candidates", "chosen"})
        shown = len(markers["candidates"].points) // 2
        self.assertTrue(0 < shown <= min(200, view["evaluated"]), shown)
        self.assertEqual(len(markers["candidates"].colors), 2 * shown)
        ends = np.array([[p.x, p.y, p.z] for marker in markers.values() for p in marker.points])
        self.assertTrue(np.isfinite(ends).all())
        best = markers["candidates"].points[0]  # the flying camera takes the best
        np.testing.assert_allclose([best.x, best.y, best.z], taken[:3, 3], atol=1e-9)
        self.assertEqual(last["/saccade/plan"].header.frame_id, "world")

        transform = last["/tf"].transforms[0]
        self.assertEqual((transform.header.frame_id, transform.child_frame_id), ("world", "saccade_camera"))
        turn = rotation_of(transform.transform.rotation)
        np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-9)
        tilt = np.arccos(np.clip(turn[:, 2] @ taken[:3, 2], -1, 1))  # frames of a view are tilted against it
        self.assertLess(tilt, max(map(abs, view["tilt_rad"])) + 1e-6)
        image, info = last["/saccade/depth/image_raw"], last["/saccade/depth/camera_info"]
        self.assertEqual((image.width, image.height, image.encoding), (info.width, info.height, "32FC1"))
        depth = np.frombuffer(image.data, "<f4")
        self.assertEqual(len(depth), info.width * info.height)
        self.assertGreater((depth > 0.2).mean(), 0.1)
        self.assertGreater(info.K[0], 10)
        self.assertTrue(began < image.header.stamp.to_sec() < time.time())

    def test_2_a_publisher_that_is_killed_is_said_once_and_the_run_ends_as_ever(self):
        run = Run(self.session.folder, "killed", 2)
        self.wait_for_topics(OF_A_SCAN)
        os.kill(run.publisher(), signal.SIGKILL)
        run.go()
        run.go()
        status, result, error = run.end()
        self.assertEqual(status, 0, error)
        self.assertEqual(len(result["views"]), 2)
        self.assertEqual(error.count("the run goes on without it"), 1, error)
        self.assertIn("signal 9", error)
        self.assertIsNone(run.publisher())

    def test_3_a_master_that_is_started_anew_hears_what_is_latched(self):
        run = Run(self.session.folder, "anew", 1)
        self.wait_for_topics(OF_A_SCAN)
        os.killpg(self.session.core.pid, signal.SIGKILL)
        self.session.core.wait()
        self.session.start_master()
        self.wait_for_topics(OF_A_SCAN)
        came = self.session.run("rostopic", "echo", "-n", "1", "--noarr", "/saccade/occupied")
        self.assertIn('frame_id: "world"', came)
        run.go()
        status, _, error = run.end()
        self.assertEqual(status, 0, error)
        self.assertNotIn("goes on without", error)

    def test_4_what_is_missing_is_said(self):
        run = Run(self.session.folder, "alone", 1, ROS_MASTER_URI=f"http://127.0.0.1:{free_port()}")
        run.go()
        status, result, error = run.end()
        self.assertEqual(status, 0, error)
        self.assertEqual(len(result["views"]), 1)
        self.assertIn("no ROS master answers", error)
        elsewhere = pathlib.Path(self.session.folder) / "saccade"
        shutil.copy(SACCADE, elsewhere)
        status, result, error = Run(self.session.folder, "without", 1, elsewhere, PATH="/nowhere").end()
        self.assertEqual(status, 4, error)
        self.assertIsNone(result)
        self.assertIn("there is no saccade-ros1 beside it or in PATH; install ros-core-dev", error)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
