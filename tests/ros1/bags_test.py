#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Bags that rosbag's Python wrote, in each compression, fuse to the map of the folder of PNGs that has their frames.

Usage: bags_test.py SACCADE-ROS1 PYTHON; saccade lies beside saccade-ros1."""
import io
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import numpy as np

import numpy_scene
from ros_session import skip

try:
    import rosbag
    import rospy
    from geometry_msgs.msg import PoseStamped, TransformStamped
    from PIL import Image as Picture
    from sensor_msgs.msg import CameraInfo, CompressedImage, Image
    from tf2_msgs.msg import TFMessage
except ImportError as missing:
    skip(f"{missing.name} is not there (packages.txt, ros)")

SACCADE = pathlib.Path(sys.argv[1]).parent / "saccade"
WIDTH, HEIGHT, FOCAL = numpy_scene.WIDTH, numpy_scene.HEIGHT, numpy_scene.FOCAL
COUNT = 8


def pose(i):
    """A camera that goes to the right and turns about its y axis: rotation, translation, quaternion."""
    angle = 0.03 * i
    rotation = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    return rotation, np.array([0.02 * i, 0.0, 0.0]), (0.0, float(np.sin(angle / 2)), 0.0, float(np.cos(angle / 2)))


def frames():
    for i in range(COUNT):
        rotation, translation, turn = pose(i)
        depth = numpy_scene.depth_from(rotation, translation)
        yield 1000.0 + 0.1 * i, np.where(np.isfinite(depth), np.round(depth * 1000), 0).astype(np.uint16), translation, turn


def png_of(image):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in image)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 16, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def write_folder(folder):
    (folder / "depth").mkdir(parents=True)
    images, poses = [], []
    for time, depth, translation, turn in frames():
        (folder / f"depth/{time:.6f}.png").write_bytes(png_of(depth))
        images.append(f"{time:.6f} depth/{time:.6f}.png\n")
        poses.append(" ".join([f"{time:.6f}"] + [repr(float(v)) for v in (*translation, *turn)]) + "\n")
    (folder / "depth.txt").write_text("".join(images))
    (folder / "groundtruth.txt").write_text("".join(poses))


def write_bag(path, compression="none", change=None, colors=None):
    """change(info, depth): what of the depth image is recorded; colors(i, stamp): topic and message of a colour image."""
    with rosbag.Bag(str(path), "w", compression=compression) as bag:
        for i, (time, depth, translation, turn) in enumerate(frames()):
            stamp = rospy.Time.from_sec(time)
            image = Image(height=HEIGHT, width=WIDTH, encoding="16UC1", step=2 * WIDTH, data=depth.tobytes())
            image.header.stamp, image.header.frame_id = stamp, "camera"
            info = CameraInfo(header=image.header, height=HEIGHT, width=WIDTH, distortion_model="plumb_bob", D=[0.0] * 5)
            info.K = [FOCAL, 0, 79.5, 0, FOCAL, 59.5, 0, 0, 1]
            info.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
            info.P = [FOCAL, 0, 79.5, 0, 0, FOCAL, 59.5, 0, 0, 0, 1, 0]
            if change is not None:
                depth = np.ascontiguousarray(change(info, depth))
                image.height, image.width, image.step, image.data = *depth.shape, 2 * depth.shape[1], depth.tobytes()
            if colors is not None:
                for topic, message in colors(i):
                    message.header = image.header
                    bag.write(topic, message, stamp)
            link = TransformStamped(child_frame_id="camera")
            link.header.stamp, link.header.frame_id = stamp, "world"
            (link.transform.translation.x, link.transform.translation.y, link.transform.translation.z) = map(float, translation)
            (link.transform.rotation.x, link.transform.rotation.y, link.transform.rotation.z,
             link.transform.rotation.w) = turn
            hand = PoseStamped(header=link.header)
            hand.pose.position.x = float(translation[0])
            for topic, message in (("/tf", TFMessage([link])), ("/camera/depth/camera_info", info),
                                   ("/camera/depth/image_raw", image), ("/hand", hand)):
                bag.write(topic, message, stamp)


def saccade(*arguments):
    return subprocess.run([str(SACCADE), *map(str, arguments)], capture_output=True, text=True, timeout=60, check=False)


class Bags(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)

    def fuse(self, frames_path, out, *more):
        ran = saccade("fuse", frames_path, "--out", self.path / out, "--voxel-size", "0.02", "--min-range", "0.2",
                      "--max-range", "3", "--no-pictures", "--no-mesh", "--quiet", *more)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        return (self.path / out / "map.sacmap").read_bytes()

    def test_each_compression_gives_the_map_of_the_folder(self):
        write_folder(self.path / "folder")
        expected = self.fuse(self.path / "folder", "out", "--layout", "tum", "--depth-encoding", "mm", "--intrinsics",
                             f"{FOCAL},{FOCAL},79.5,59.5")
        for compression in ("none", "bz2", "lz4"):
            write_bag(self.path / f"{compression}.bag", compression)
            self.assertEqual(self.fuse(self.path / f"{compression}.bag", compression), expected, compression)

    def test_regions_of_interest_and_binning_are_part_of_the_camera(self):
        def part(info, depth):
            info.roi.x_offset, info.roi.y_offset, info.roi.width, info.roi.height = 20, 10, 100, 80
            info.binning_x = info.binning_y = 2
            return depth[10:90:2, 20:120:2]

        write_bag(self.path / "part.bag", change=part)
        mine = self.fuse(self.path / "part.bag", "part")
        # Pixel u of the picture is the mean of the sensor's 2u + 20 and 2u + 21.
        center = ((79.5 - 20 - 0.5) / 2, (59.5 - 10 - 0.5) / 2)
        write_bag(self.path / "plain.bag", change=lambda info, depth: depth[10:90:2, 20:120:2])
        plain = self.fuse(self.path / "plain.bag", "plain", "--intrinsics", f"{FOCAL / 2},{FOCAL / 2},{center[0]},{center[1]}")
        self.assertEqual(mine, plain)

    def test_distortion_is_undone_as_that_of_a_folder(self):
        lens = [0.1, -0.05, 0.001, -0.002, 0.01]

        def distorted(info, depth):
            info.D = lens
            return depth

        write_bag(self.path / "lens.bag", change=distorted)
        mine = self.fuse(self.path / "lens.bag", "lens")
        write_bag(self.path / "plain.bag")
        said = self.fuse(self.path / "plain.bag", "said", "--distortion", ",".join(map(str, lens)))
        self.assertEqual(mine, said)
        self.assertNotEqual(mine, self.fuse(self.path / "plain.bag", "plain"))

    def test_colours_plain_and_compressed(self):
        def pixels(i):
            v, u = np.mgrid[0:HEIGHT, 0:WIDTH]
            return np.stack([(u + 10 * i) % 256, (2 * v) % 256, (u + v) % 256], axis=2).astype(np.uint8)

        def packed(i, kind):
            buffer = io.BytesIO()
            Picture.fromarray(pixels(i)).save(buffer, kind, quality=95)
            return CompressedImage(format=f"rgb8; {kind} compressed bgr8", data=buffer.getvalue())

        def colors(i):
            rgb = pixels(i)
            yield "/rgb", Image(height=HEIGHT, width=WIDTH, encoding="rgb8", step=3 * WIDTH, data=rgb.tobytes())
            yield "/bgr", Image(height=HEIGHT, width=WIDTH, encoding="bgr8", step=3 * WIDTH, data=rgb[:, :, ::-1].tobytes())
            yield "/png", packed(i, "png")
            yield "/jpeg", packed(i, "jpeg")

        write_bag(self.path / "color.bag", "lz4", colors=colors)
        depth = ("--depth", "/camera/depth/image_raw", "--color")
        rgb = self.fuse(self.path / "color.bag", "rgb", *depth, "/rgb")
        self.assertEqual(self.fuse(self.path / "color.bag", "bgr", *depth, "/bgr"), rgb)
        self.assertEqual(self.fuse(self.path / "color.bag", "png", *depth, "/png"), rgb)
        jpeg = self.fuse(self.path / "color.bag", "jpeg", *depth, "/jpeg")
        self.assertNotIn(jpeg, (rgb, self.fuse(self.path / "color.bag", "grey", *depth[:2])))

    def test_wrong_topics_and_cut_bags_are_said(self):
        write_bag(self.path / "a.bag", "lz4")
        wrong = saccade("fuse", self.path / "a.bag", "--depth", "/nothing", "--out", self.path / "out")
        self.assertNotEqual(wrong.returncode, 0)
        self.assertIn("/camera/depth/image_raw (sensor_msgs/Image, 8 messages)", wrong.stderr)
        whole = (self.path / "a.bag").read_bytes()
        (self.path / "cut.bag").write_bytes(whole[:len(whole) // 2])
        cut = saccade("fuse", self.path / "cut.bag", "--out", self.path / "cut")
        self.assertTrue(cut.stderr, "a bag that was cut is said")
        self.assertNotIn("terminate", cut.stderr)

    def test_what_is_no_bag_is_said(self):
        for name, content in (("empty.bag", b""), ("noise.mcap", bytes(range(256)) * 8), ("noise.zip", bytes(range(256)))):
            (self.path / name).write_bytes(content)
            ran = saccade("fuse", self.path / name, "--out", self.path / "none")
            self.assertEqual(ran.returncode, 3, ran.stderr)
            self.assertIn("neither a bag of ROS 1 nor an MCAP file", ran.stderr)

    def test_a_hand_comes_from_a_topic(self):
        write_bag(self.path / "a.bag", "none")
        ran = saccade("attend", self.path / "a.bag", "--hand", "/hand", "--json", "-")
        self.assertIn(ran.returncode, (0, 5), ran.stderr)  # 5: no action was found in so short a way
        wrong = saccade("attend", self.path / "a.bag", "--hand", "/none")
        self.assertIn("/hand", wrong.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
