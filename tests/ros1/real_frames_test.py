#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Frames of a real Kinect go from a bag through rosbag play into the node kinfu: its answers beside `saccade fuse` of the same bag.

Usage: real_frames_test.py SACCADE-ROS1 PYTHON; saccade lies beside saccade-ros1; the frames are ../shared/data/rgbd_redkitchen."""
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest

import ros_session

sys.path.insert(0, sys.argv[2])
try:
    import numpy as np
    import rosbag
    import rospy
    from actionlib_msgs.msg import GoalStatus
    from geometry_msgs.msg import TransformStamped
    from PIL import Image as Picture
    from sensor_msgs.msg import CameraInfo, Image
    from std_msgs.msg import Empty, Header
    from tf2_msgs.msg import TFMessage

    from kinfu_msgs import msg as msgs
    from patient_client import PatientClient
except ImportError as error:
    ros_session.skip(f"{error.name} is not there (packages.txt, ros)")

ROOT = pathlib.Path(__file__).resolve().parents[2]
FRAMES = ROOT.parent / "shared/data/rgbd_redkitchen"
SACCADE = pathlib.Path(sys.argv[1]).parent / "saccade"
COUNT, EVERY = 16, 5
VOXEL, TRUNCATION, RANGE = 0.02, 0.1, (0.4, 4.0)


def quaternion_of(r):
    """A rotation's quaternion x, y, z, w, by its largest component."""
    k = np.array([[r[0, 0] - r[1, 1] - r[2, 2], 0, 0, 0],
                  [r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], 0, 0],
                  [r[2, 0] + r[0, 2], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1], 0],
                  [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], np.trace(r)]])
    values, vectors = np.linalg.eigh(k)
    return vectors[:, np.argmax(values)]


def write_bag(path):
    with rosbag.Bag(str(path), "w", compression="lz4") as bag:
        for i in range(COUNT):
            name = FRAMES / f"frame-{i * EVERY:06d}"
            stamp = rospy.Time.from_sec(1000.0 + 0.2 * i)
            depth = np.asarray(Picture.open(f"{name}.depth.png")).astype("<u2")
            depth = np.where(depth > 10000, 0, depth).astype("<u2")
            image = Image(height=480, width=640, encoding="16UC1", step=1280, data=depth.tobytes())
            image.header.stamp, image.header.frame_id = stamp, "camera"
            info = CameraInfo(header=image.header, height=480, width=640, distortion_model="plumb_bob", D=[0.0] * 5)
            info.K = [585, 0, 320, 0, 585, 240, 0, 0, 1]
            pose = np.loadtxt(f"{name}.pose.txt")
            link = TransformStamped(child_frame_id="camera")
            link.header.stamp, link.header.frame_id = stamp, "world"
            move, turn = link.transform.translation, link.transform.rotation
            move.x, move.y, move.z = map(float, pose[:3, 3])
            turn.x, turn.y, turn.z, turn.w = map(float, quaternion_of(pose[:3, :3]))
            for topic, message in (("/tf", TFMessage([link])), ("/camera/depth/camera_info", info),
                                   ("/camera/depth/image_raw", image)):
                bag.write(topic, message, stamp)


def vertices_of(ply):
    """Positions of a binary PLY's vertices."""
    head, _, body = ply.read_bytes().partition(b"end_header\n")
    kinds = {"float": "<f4", "double": "<f8", "uchar": "u1", "int": "<i4"}
    lines = head.decode().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("element vertex"))
    fields = []
    for line in lines[start + 1:]:
        if not line.startswith("property"):
            break
        fields.append((line.split()[2], kinds[line.split()[1]]))
    count = int(lines[start].split()[2])
    points = np.frombuffer(body, np.dtype(fields), count)
    return np.stack([points["x"], points["y"], points["z"]], axis=1)


def keys_of(points, shift=(0, 0, 0)):
    """A number for the cell of 4 cm that each point lies in."""
    cells = np.floor(points / 0.04).astype(np.int64) + np.array(shift) + (1 << 19)
    return cells[:, 0] << 40 | cells[:, 1] << 20 | cells[:, 2]


def keys_around(points):
    return np.unique(np.concatenate([keys_of(points, np.array(shift) - 1) for shift in np.ndindex(3, 3, 3)]))


class RealFrames(unittest.TestCase):
    session = None

    def node(self, *parameters):
        process = self.session.node("kinfu", f"_volume_size:={VOXEL * 256}", "_volume_resolution:=256", f"_trunc_dist:={TRUNCATION}",
                                    f"_min_range:={RANGE[0]}", f"_max_range:={RANGE[1]}", "_enable_minimum_motion:=false", *parameters)
        self.client = PatientClient("/kinfu_output/actions/request", msgs.RequestAction)
        self.assertTrue(self.client.wait_for_server(rospy.Duration(10)), "the node offers no action")
        return process

    def end(self, process):
        os.killpg(process.pid, signal.SIGINT)
        self.assertEqual(process.wait(timeout=10), 0, self.session.log("kinfu")[-2000:])

    def play(self):
        """Plays the bag with the stock player; returns the frames that the node has taken."""
        taken = []
        acks = rospy.Subscriber("/kinfu_image_ack", Header, lambda m: taken.append(round(m.stamp.to_sec(), 3)))
        self.session.until(lambda: acks.get_num_connections() > 0, 10, "the node has no image_ack")
        done = subprocess.run(["rosbag", "play", "--quiet", "--wait-for-subscribers", "--rate=0.6", str(self.bag)], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        end = time.time() + 5
        while len(taken) < COUNT and time.time() < end:
            time.sleep(0.02)
        acks.unregister()
        return taken

    def ask(self, kind, state=GoalStatus.SUCCEEDED):
        request = msgs.KinfuTsdfRequest()
        request.tsdf_header.request_type = kind
        self.client.send_goal(msgs.RequestGoal(request=request))
        self.assertTrue(self.client.wait_for_result(rospy.Duration(20)), f"request {kind} is not answered")
        self.assertEqual(self.client.get_state(), state, self.client.get_goal_status_text())
        return self.client.get_result()

    @classmethod
    def setUpClass(cls):
        cls.bag = pathlib.Path(cls.session.folder) / "real.bag"
        write_bag(cls.bag)
        rospy.init_node("client", disable_signals=True)

    def mesh_of_fuse(self, tracking):
        out = pathlib.Path(self.session.folder) / tracking
        done = subprocess.run([SACCADE, "fuse", self.bag, "--out", out, "--voxel-size", str(VOXEL), "--truncation", str(TRUNCATION / VOXEL),
                               "--min-range", str(RANGE[0]), "--max-range", str(RANGE[1]), "--clearing", "100", "--fill-gaps", "0",
                               "--tracking", tracking, "--no-pictures", "--no-color", "--quiet"], capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        return vertices_of(out / "mesh.ply")

    def points(self, cloud):
        return np.frombuffer(cloud.data, np.float32).reshape(-1, cloud.point_step // 4)[:, :3]

    def test_forced_poses_give_the_mesh_of_fuse(self):
        process = self.node("_forced_tf_position:=true", "_forced_tf_reference_frame:=world", "_forced_tf_current_frame:=camera")
        taken = self.play()
        self.assertEqual(taken, [round(1000.0 + 0.2 * i, 3) for i in range(COUNT)])
        mine = self.points(self.ask(2).mesh.cloud)
        self.assertTrue((mine == self.points(self.ask(3).pointcloud)).all())
        theirs = self.mesh_of_fuse("forced")
        self.assertEqual(len(mine), len(theirs))
        difference = np.abs(mine - theirs).max()
        print(f"{len(mine)} vertices; differences up to {1000 * difference:.4f} mm")
        self.assertLess(difference, 1e-4)
        self.end(process)

    def test_icp_follows_the_camera(self):
        lost = []
        watch = rospy.Subscriber("/kinfu_icp_lost_topic", Empty, lost.append)
        process = self.node("_forced_tf_position:=false")  # parameters outlive a node
        taken = self.play()
        self.assertEqual((taken, lost), ([round(1000.0 + 0.2 * i, 3) for i in range(COUNT)], []))
        watch.unregister()
        first = np.loadtxt(FRAMES / "frame-000000.pose.txt")
        mine = self.points(self.ask(3).pointcloud) @ first[:3, :3].T + first[:3, 3]
        share = np.isin(keys_of(mine), keys_around(self.mesh_of_fuse("forced")))
        print(f"{len(mine)} vertices; {100 * share.mean():.1f} % lie within a cell of 4 cm of the mesh by given poses")
        self.assertGreater(share.mean(), 0.95)
        self.end(process)


if __name__ == "__main__":
    if not FRAMES.is_dir():
        ros_session.skip(f"{FRAMES.name} is not there (../shared/data)")
    ros_session.run_tests(RealFrames, "kinfu")
