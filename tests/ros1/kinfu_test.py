#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The node kinfu, asked by the stock clients of ROS 1. kinfu_test.py PROGRAM PYTHON_FOLDER"""
import signal
import sys
import time
import unittest

import ros_session

sys.path.insert(0, sys.argv[2])
try:
    import numpy as np
    import rospy
    from actionlib_msgs.msg import GoalStatus
    from geometry_msgs.msg import TransformStamped
    from sensor_msgs.msg import Image, PointCloud2
    from std_msgs.msg import Empty, Header, MultiArrayDimension, UInt8MultiArray

    import numpy_scene as scene
    from kinfu_client import BOX, SIZE, VOXEL, KinfuClient, msgs, srvs
    from patient_client import PatientClient
except ImportError as error:
    ros_session.skip(f"{error.name} is not there (packages.txt, ros)")


class Kinfu(KinfuClient):
    def test_01_sums_of_the_definitions(self):
        expected = {"KinfuCommand": "f80d3cfb1a7fb64d466eccab4ac10808", "KinfuTsdfRequest": "2787b5cca6578c1bfeff449ff2eb5970",
                    "RequestAction": "05d2e23a739cea2f8dd0d00a5e00788c", "WorldUploadAction": "e4b5e8129906a822615e2fad10627e24"}
        for name, md5 in expected.items():
            self.assertEqual(getattr(msgs, name)._md5sum, md5, name)
        self.assertEqual(srvs.CheckForShift._md5sum, "59a88a5f68f4c8291d5f3a96776318fc")

    def test_02_commands(self):
        self.command(0)
        self.command(1)
        self.command(8, "NO")  # running
        self.command(2)
        self.command(3)
        self.command(4, "NO")
        self.command(4, boolean_data=[False])
        self.command(5, "NO")
        self.command(5, boolean_data=[False])
        self.command(6, "NO", float_data=[0, 0, 0])
        self.command(7, "NO", float_data=[0] * 5)
        self.command(9, "NO", float_data=[0] * 6)
        self.command(6, "NO", float_data=[float("nan"), 0, 0, 1])
        self.command(99, "NO")

    def test_03_trigger(self):
        self.command(3)
        self.command(2)
        self.send(self.image(scene.depth_from()), wait=False)
        time.sleep(0.1)
        self.assertEqual(len(self.points(self.ask(4).pointcloud)), 0)
        name = self.command(8, wait=False)
        time.sleep(0.1)
        self.assertFalse(any(a.startswith(name) for a in self.acks))
        self.command(8, "NO")
        self.send(self.image(scene.depth_from()))
        self.acknowledged(name)
        self.assertGreater(len(self.points(self.ask(4).pointcloud)), 10000)
        self.command(1)

    def test_04_voxels_against_the_depth_image(self):
        self.one_frame()
        grid = self.grid()
        self.assertEqual(grid.shape, (SIZE,) * 3)
        z, y, x = np.meshgrid(*[np.arange(SIZE)] * 3, indexing="ij")
        p = np.stack([x, y, z], -1) * VOXEL + BOX[0] + VOXEL / 2
        u = np.round(p[..., 0] / p[..., 2] * scene.FOCAL + scene.CENTER[0]).astype(int)
        v = np.round(p[..., 1] / p[..., 2] * scene.FOCAL + scene.CENTER[1]).astype(int)
        seen = (u >= 0) & (u < scene.WIDTH) & (v >= 0) & (v < scene.HEIGHT)
        depth = np.zeros(seen.shape)
        depth[seen] = scene.depth_from()[v[seen], u[seen]]
        behind = (p[..., 2] - depth) * np.linalg.norm(p, axis=-1) / p[..., 2]  # along the ray
        self.assertTrue((grid[~seen] == 0).all())
        for where, state in ((behind > 0.035, 0), (behind < -0.002, -1), ((behind > 0.002) & (behind < 0.028), 1)):
            there = grid[seen & where]  # a voxel whose centre is seen between two pixels may be rounded to the other
            self.assertGreater((there == state).mean(), 0.999, f"{(there != state).sum()} of {there.size} are not {state}")
        self.assertGreater((grid == 1).sum(), 5000)

        coarse = self.ask(8, BOX, request_subsample=True, subsample_voxel_size=0.02).float_values
        blocks = grid.reshape(40, 2, 40, 2, 40, 2).transpose(0, 2, 4, 1, 3, 5).reshape(40, 40, 40, 8)
        expected = np.where((blocks == 1).any(-1), 1, np.where((blocks == 0).any(-1), 0, -1))
        self.assertEqual([(d.label, d.size, d.stride) for d in coarse.layout.dim], [("x", 40, 1), ("y", 40, 40), ("z", 40, 1600)])
        self.assertGreater((np.array(coarse.data).reshape(40, 40, 40) == expected).mean(), 0.999)

    def test_05_clouds_and_mesh(self):
        self.one_frame()
        grid = self.grid()
        tsdf = self.points(self.ask(1, BOX).pointcloud)
        self.assertEqual((tsdf[:, 3] <= 0).sum(), (grid == 1).sum())
        known = self.points(self.ask(4, BOX).pointcloud)
        self.assertEqual(len(known), (grid != 0).sum())
        few = self.points(self.ask(4, BOX, request_subsample=True, subsample_voxel_size=0.1).pointcloud)
        self.assertEqual(len(few), len(np.unique(np.floor(known.astype(float) / 0.1 + 1e-9), axis=0)))

        mesh = self.ask(2).mesh
        vertices = self.points(mesh.cloud)
        self.assertEqual([f.name for f in mesh.cloud.fields][:6], ["x", "y", "z", "normal_x", "normal_y", "normal_z"])
        self.assertLess(np.quantile(scene.distance_to_surface(vertices[:, :3]), 0.95), VOXEL)
        cloud = self.points(self.ask(3).pointcloud)
        self.assertTrue((cloud == vertices).all())
        moved = self.points(self.ask(3, request_transformation=True, transformation=self.pose(1, 2, 3)).pointcloud)
        self.assertTrue(np.allclose(moved[:, :3], cloud[:, :3] + [1, 2, 3], atol=1e-5))
        polygons = np.array([p.vertices for p in mesh.polygons])
        edges = np.sort(np.concatenate([polygons[:, [0, 1]], polygons[:, [1, 2]], polygons[:, [2, 0]]]), axis=1)
        unique, count = np.unique(edges, axis=0, return_counts=True)
        border = self.points(self.ask(10).pointcloud)
        self.assertEqual(len(border), len(np.unique(unique[count == 1])))
        self.assertGreater(len(border), 50)

    def test_06_frontier_and_surface(self):
        self.one_frame()
        low = np.array(BOX[0])
        grid = self.grid((low - VOXEL, np.array(BOX[1]) + VOXEL))
        inner = (slice(1, -1),) * 3
        beside = lambda state: np.any([np.roll(grid == state, s, axis=a)[inner] for a in range(3) for s in (1, -1)], axis=0)
        for kind, mask in ((9, (grid[inner] == -1) & beside(0)), (11, (grid[inner] == 1) & beside(-1))):
            points = self.points(self.ask(kind, BOX).pointcloud)
            index = np.floor((points[:, :3] - low) / VOXEL).astype(int)
            got = np.zeros(mask.shape, bool)
            got[index[:, 2], index[:, 1], index[:, 0]] = True
            self.assertEqual(len(points), mask.sum())
            self.assertTrue((got == mask).all())
            shifted = self.points(self.ask(kind, BOX, request_transformation=True, transformation=self.pose(0, 0, 1)).pointcloud)
            self.assertTrue(np.allclose(shifted[:, 2], points[:, 2] - 1, atol=1e-5))

    def test_07_views(self):
        self.one_frame()
        grid = self.grid()
        low = np.array(BOX[0])
        directions = scene.rays(64, 48, 52.0, np.array([31.5, 23.5]))
        places = [(0.0, 0.0, 0.0), (0.2, -0.1, 0.1)]
        fields = dict(request_camera_intrinsics=True, camera_intrinsics=self.view_camera(), request_view_poses=True,
                      view_poses=[self.pose(*p) for p in places], request_bounding_box_view=True,
                      bounding_box_view_min=msgs.KinfuCloudPoint(*BOX[0]), bounding_box_view_max=msgs.KinfuCloudPoint(*BOX[1]),
                      occupied_weight=1, occupied_distance_weight=2, unknown_weight=3, unknown_distance_weight=0.5)
        counts = self.ask(7, **fields).uint_values
        self.assertEqual([(d.label, d.size, d.stride) for d in counts.layout.dim], [("Voxel type", 2, 2), ("View count", 2, 4)])
        scores = np.array(self.ask(12, **fields).float_values.data).reshape(2, 3)
        for i, place in enumerate(places):
            state, depth = scene.first_states(grid, low, VOXEL, directions, np.array(place))
            expected = [(state == 1).sum(), (state == 0).sum()]
            self.assertTrue(np.allclose(counts.data[2 * i:2 * i + 2], expected, atol=0.01 * state.size), (counts.data, expected))
            self.assertEqual(list(scores[i, 1:]), list(counts.data[2 * i:2 * i + 2]))
            d = depth * np.linalg.norm(directions.reshape(-1, 3), axis=1)
            score = (1 + (2 * d[state == 1]) ** 2).sum() + (3 + (0.5 * d[state == 0]) ** 2).sum()
            self.assertAlmostEqual(scores[i, 0] / score, 1, delta=0.01)

        half = dict(fields, request_sphere=True, sphere_center=msgs.KinfuCloudPoint(*scene.SPHERES[0][0]), sphere_radius=0.13)
        filtered = self.ask(7, **half).uint_values.data
        self.assertTrue(0 < filtered[0] < counts.data[0])
        dark = self.ask(7, **dict(fields, request_emitter_shadow_removal=True, distance_x_camera_emitter=0.3)).uint_values.data
        self.assertTrue(0 < dark[0] < counts.data[0])

        plain = self.ask(7, BOX).uint_values.data
        self.assertEqual(list(plain), [(grid == 1).sum(), (grid == 0).sum()])

        fields.update(request_view_poses=False, request_transformation=True, transformation=self.pose(*places[1]))
        cloud = self.ask(6, **fields).pointcloud
        points = self.points(cloud)
        self.assertEqual((cloud.width, cloud.height), (64, 48))
        self.assertEqual([(points[:, 3] > 0).sum(), (points[:, 3] < 0).sum()], list(counts.data[2:]))
        self.assertTrue((np.isnan(points[:, 0]) == (points[:, 3] == 0)).all())
        hit = points[:, 3] != 0
        self.assertTrue(np.allclose(np.linalg.norm(points[hit, :3] - places[1], axis=1), np.abs(points[hit, 3]), atol=1e-4))
        image = self.ask(5).image
        self.assertEqual((image.width, image.height, image.encoding), (scene.WIDTH, scene.HEIGHT, "rgb8"))
        self.assertGreater(np.frombuffer(image.data, np.uint8).mean(), 30)

    def test_08_clearing(self):
        self.one_frame()
        before = self.grid()
        center = np.array(scene.SPHERES[0][0])
        z, y, x = np.meshgrid(*[np.arange(SIZE)] * 3, indexing="ij")
        p = np.stack([x, y, z], -1) * VOXEL + BOX[0] + VOXEL / 2
        ball = np.linalg.norm(p - center, axis=-1) < 0.1234
        self.command(6, float_data=[*center, 0.1234])
        self.assertTrue((self.grid() == np.where(ball, 0, before)).all())
        self.command(7, float_data=[-0.4, -0.4, 0.4, 0, 0, 0.8], boolean_data=[True])
        cut = (p < [0, 0, 0.8]).all(-1)
        self.assertTrue((self.grid() == np.where(cut, -1, np.where(ball, 0, before))).all())
        self.command(9, float_data=[0.2, 0.2, 0.4, 0.2, 0.2, 1.2, 0.1])
        rod = np.linalg.norm(p[..., :2] - [0.2, 0.2], axis=-1) < 0.1
        self.assertTrue((self.grid()[rod] == 0).all())

    def test_09_upload(self):
        self.one_frame()
        grid = self.grid()
        goal = msgs.WorldUploadGoal(tsdf_volume=self.ask(1, BOX).pointcloud, reset=True)
        (goal.bbox_min.x, goal.bbox_min.y, goal.bbox_min.z), (goal.bbox_max.x, goal.bbox_max.y, goal.bbox_max.z) = BOX
        goal.known_voxelgrid = UInt8MultiArray(data=bytes((grid != 0).astype(np.uint8).ravel()))
        goal.known_voxelgrid.layout.dim = [MultiArrayDimension(n, SIZE, SIZE ** i) for i, n in enumerate("xyz")]
        self.upload.send_goal_and_wait(goal, rospy.Duration(10))
        self.assertTrue(self.upload.get_result().ok)
        self.assertTrue((self.grid() == grid).all())
        goal.known_voxelgrid.layout.dim[0].size = 7
        self.upload.send_goal_and_wait(goal, rospy.Duration(10))
        self.assertEqual(self.upload.get_state(), GoalStatus.ABORTED)
        self.assertFalse(self.upload.get_result().ok)

    def test_10_encodings(self):
        depth = np.round(scene.depth_from(), 3)
        grids = []
        for encoding, big, padding in (("16UC1", False, 0), ("mono16", True, 6), ("32FC1", True, 12), ("32FC1", False, 0)):
            self.command(3)
            self.send(self.image(depth, encoding, big, padding))
            grids.append(self.grid())
        for grid in grids[:3]:
            self.assertGreater((grid == grids[3]).mean(), 0.9999)
        self.command(3)
        self.send(self.image(-np.full_like(depth, 0.8)))
        grid = self.grid()
        self.assertTrue((grid != 1).all() and (grid == -1).sum() > 10000)

    def test_11_images_that_cannot_be(self):
        self.one_frame()
        known = (self.grid() != 0).sum()
        bad = self.image(scene.depth_from())
        bad.data = bad.data[:100]
        self.send(bad, wait=False)
        strange = self.image(scene.depth_from())
        strange.encoding = "rgb8"
        self.send(strange, wait=False)
        self.send(self.image(scene.depth_from()[:60]), wait=False)
        self.send(Image(header=Header(stamp=rospy.Time.now())), wait=False)
        nan = np.full_like(scene.depth_from(), np.nan)
        self.send(self.image(nan), wait=False)
        time.sleep(0.2)
        self.assertIsNone(self.process.poll())
        self.assertEqual((self.grid() != 0).sum(), known)
        self.session.until(lambda: "pixels, camera_info says" in self.session.log("kinfu") or "has 100 bytes" in self.session.log("kinfu"), 5, "nothing is said")
        half = self.image(scene.depth_from()[:60])
        self.command(3)
        self.send(half, info_size=(scene.WIDTH, 60))  # a camera that changes its size is followed
        self.assertGreater((self.grid() != 0).sum(), 1000)

    def test_12_tracking_and_hints(self):
        self.one_frame()
        self.command(4, boolean_data=[True])
        for x in (0.004, 0.008, 0.012):
            stamp = self.send(self.image(scene.depth_from(translation=(x, 0, 0)))).header.stamp
        T = self.buffer.lookup_transform("kinfu_first_frame", "kinfu_current_frame", stamp, rospy.Duration(2)).transform
        self.assertAlmostEqual(T.translation.x, 0.012, delta=0.003)
        lost = len(self.lost)
        self.send(self.image(np.full((scene.HEIGHT, scene.WIDTH), 0.5, np.float32)))
        self.session.until(lambda: len(self.lost) > lost, 5, "nothing says that tracking is lost")
        self.command(0, hint=(np.eye(3), (0.1, 0, 0)), forced=True)
        stamp = self.send(self.image(scene.depth_from(translation=(0.1, 0, 0)))).header.stamp
        T = self.buffer.lookup_transform("kinfu_first_frame", "kinfu_current_frame", stamp, rospy.Duration(2)).transform
        self.assertAlmostEqual(T.translation.x, 0.1, delta=1e-6)
        self.command(3, hint=(np.eye(3), (1, 2, 3)))
        stamp = self.send(self.image(scene.depth_from())).header.stamp
        T = self.buffer.lookup_transform("kinfu_first_frame", "kinfu_current_frame", stamp, rospy.Duration(2)).transform
        self.assertAlmostEqual(T.translation.z, 3, delta=1e-6)
        self.command(4, boolean_data=[False])

    def test_13_forced_transforms(self):
        self.command(3)
        self.command(5, boolean_data=[True])
        image = self.image(scene.depth_from())
        self.send(image, wait=False)
        time.sleep(0.3)
        self.assertNotIn(image.header.stamp, self.image_acks)
        T = TransformStamped(child_frame_id="tool")
        T.header.frame_id = "base"
        T.transform.rotation.w = 1
        for x, wanted in ((float("nan"), False), (0.5, True)):
            image = self.image(scene.depth_from(translation=(0, 0, 0)))
            T.header.stamp = image.header.stamp
            T.transform.translation.x = x
            self.broadcaster.sendTransform(T)
            time.sleep(0.05)
            self.send(image, wait=wanted)
        out = self.buffer.lookup_transform("kinfu_first_frame", "kinfu_current_frame", image.header.stamp, rospy.Duration(2)).transform
        self.assertAlmostEqual(out.translation.x, 0.5, delta=1e-9)
        self.assertEqual(self.session.log("kinfu").count("no pose for an image"), 1)
        self.command(5, boolean_data=[False])

    def test_14_invalid_requests(self):
        self.ask(99, state=GoalStatus.REJECTED)
        self.ask(8, state=GoalStatus.ABORTED)
        self.assertIn("bounding box", self.client.get_goal_status_text())
        self.ask(8, ((0, 0, 0), (float("nan"), 1, 1)), state=GoalStatus.ABORTED)
        self.ask(7, state=GoalStatus.ABORTED)
        self.ask(7, state=GoalStatus.ABORTED, request_view_poses=True, view_poses=[msgs.KinfuPose(linear=[2] * 9)])
        huge = msgs.KinfuCameraIntrinsics(focal_x=1, focal_y=1, size_x=1 << 31, size_y=1 << 31)
        self.ask(6, state=GoalStatus.ABORTED, request_camera_intrinsics=True, camera_intrinsics=huge)
        self.ask(0)

    def test_15_cancel_while_frames_go_on(self):
        self.one_frame()
        camera = msgs.KinfuCameraIntrinsics(center_x=320, center_y=240, focal_x=500, focal_y=500, size_x=640, size_y=480)
        goal = msgs.RequestGoal(request=self.request(12, request_camera_intrinsics=True, camera_intrinsics=camera,
                                                     request_view_poses=True, view_poses=[self.pose()] * 20000))
        self.client.send_goal(goal)
        other = PatientClient("/kinfu_output/actions/request", msgs.RequestAction)
        self.assertTrue(other.wait_for_server(rospy.Duration(5)))
        other.send_goal(msgs.RequestGoal(request=self.request(0)))
        self.assertTrue(other.wait_for_result(rospy.Duration(5)))
        self.send(self.image(scene.depth_from()))
        self.assertEqual(self.client.get_state(), GoalStatus.ACTIVE)
        begin = time.time()
        self.client.cancel_goal()
        self.assertTrue(self.client.wait_for_result(rospy.Duration(5)))
        self.assertEqual(self.client.get_state(), GoalStatus.PREEMPTED)
        self.assertLess(time.time() - begin, 1.0)

    def test_16_requests_by_topic(self):
        self.one_frame()
        request = self.request(3)
        request.tsdf_header.request_source_name = "/answers/cloud"
        self.requests.publish(request)
        time.sleep(0.3)  # latched: it is there for later subscribers, too
        cloud = rospy.wait_for_message("/answers/cloud", PointCloud2, 5)
        self.assertEqual(len(self.points(cloud)), len(self.points(self.ask(3).pointcloud)))
        request = self.request(0)
        request.tsdf_header.request_source_name = "/answers/ping"
        self.requests.publish(request)
        self.assertIn("frame_id: \"kinfu_first_frame\"", self.session.run("rostopic", "echo", "-n", "1", "/answers/ping"))
        request.tsdf_header.request_type = 8
        self.requests.publish(request)
        self.session.until(lambda: "cannot be answered" in self.session.log("kinfu"), 5, "nothing is said")

    def test_17_reset_by_request_and_topic(self):
        for reset in (lambda: self.ask(0, request_reset=True), lambda: self.resets.publish(Empty())):
            self.one_frame()
            self.assertGreater(len(self.points(self.ask(4).pointcloud)), 0)
            reset()
            self.session.until(lambda: len(self.points(self.ask(4).pointcloud)) == 0, 5, "the map is not emptied")

    def test_18_shift_checker(self):
        self.one_frame()
        self.session.until(lambda: self.shifts and abs(self.shifts[-1].current_center.x - 0.25) < 1e-9, 5, "the answered centre is not taken")
        self.assertIn("do_shift: True", self.session.run("rosservice", "call", "/check_for_shift", "{}"))

    def test_19_current_view(self):
        views = []
        subscriber = rospy.Subscriber("/kinfu_current_view", Image, views.append)
        self.session.until(lambda: subscriber.get_num_connections() > 0, 5, "no view is published")
        time.sleep(0.1)
        self.one_frame()
        self.session.until(lambda: views, 5, "no view came")
        self.assertEqual(views[0].width, scene.WIDTH)

    def test_20_restart(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        type(self).start_node()
        time.sleep(0.5)
        self.session.until(lambda: self.images.get_num_connections() > 0 and self.commands.get_num_connections() > 0, 10, "not back")
        time.sleep(0.5)
        self.command(0)
        self.send(self.image(scene.depth_from()))
        self.assertGreater((self.grid() != 0).sum(), 10000)


if __name__ == "__main__":
    ros_session.run_tests(Kinfu, "kinfu")
