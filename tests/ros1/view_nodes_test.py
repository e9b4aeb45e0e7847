#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The nodes surfel_next_best_view and basic_next_best_view, asked by the stock clients. view_nodes_test.py PROGRAM PYTHON_FOLDER"""
import os
import sys
import unittest

import ros_session

try:
    import numpy as np
    import rospy
    from actionlib_msgs.msg import GoalStatus
    from geometry_msgs.msg import Point, Pose, PoseArray
    from sensor_msgs import point_cloud2
    from sensor_msgs.msg import PointField
    from std_msgs.msg import Empty, Header
    from patient_client import PatientClient
except ImportError as error:
    ros_session.skip(f"{error.name} is not there (packages.txt, ros)")


def cloud_of(names, points):
    fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate(names)]
    return point_cloud2.create_cloud(Header(frame_id="world"), fields, np.asarray(points, float).tolist())


def pose_at(x, y, z, q=(0, 0, 0, 1)):
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = x, y, z
    pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = q
    return pose


def rotation_of(q):
    x, y, z, w = q.x, q.y, q.z, q.w
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


class ViewNodes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.session.node("surfel_next_best_view")
        cls.session.node("basic_next_best_view", "_voxel_resolution:=0.05", "_occupied_voxel_weight:=0.5", "_sensor_range_max:=1.5")
        rospy.init_node("client", disable_signals=True)
        import basic_next_best_view.msg as basic
        import surfel_next_best_view_msgs.msg as surfel
        cls.basic, cls.surfel = basic, surfel
        cls.set_cloud = PatientClient("/surfel_next_best_view/set_point_cloud", surfel.SetPointCloudAction)
        cls.evaluate = PatientClient("/surfel_next_best_view/evaluate_poses", surfel.EvaluatePosesAction)
        cls.execute = PatientClient("/basic_next_best_view/execute", basic.ExecuteAction)
        for client in (cls.set_cloud, cls.evaluate, cls.execute):
            assert client.wait_for_server(rospy.Duration(10)), client.action_client.ns

    def result_of(self, client, goal, state=GoalStatus.SUCCEEDED):
        client.send_goal(goal)
        self.assertTrue(client.wait_for_result(rospy.Duration(10)))
        self.assertEqual(client.get_state(), state, client.get_goal_status_text())
        return client.get_result()

    def test_sums_of_the_definitions(self):
        self.assertEqual(self.surfel.EvaluatePosesAction._md5sum, "49bc68487a9df490be100f143ca0461d")
        self.assertEqual(self.surfel.SetPointCloudAction._md5sum, "7137c9e1c81f5c122958baebdfdcb5fe")

    def test_surfels(self):
        names = ["x", "y", "z", "normal_x", "normal_y", "normal_z", "radius", "confidence"]
        discs = [(-0.3, 0, 1, 0, 0, -1, 0.1, 0), (0.3, 0, 1, 0, 0, -1, 0.2, 1), (0.3, 0, 2, 0, 0, -1, 0.05, 0)]  # the third is hidden
        self.result_of(self.set_cloud, self.surfel.SetPointCloudGoal(cloud=cloud_of(names, discs)))
        goal = self.surfel.EvaluatePosesGoal(
            poses=[pose_at(0, 0, 0), pose_at(0, 0, 0, (0, 1, 0, 0))], unknown_score=2, occupied_score=1, distance_weight=10, absolute_weight=0.01, width=200,
            height=160, focal_x=150, focal_y=150, center_x=99.5, center_y=79.5, range_min=0.1, range_max=5, with_images=True, with_clouds=True)
        result = self.result_of(self.evaluate, goal)
        u, v = np.meshgrid(np.arange(200), np.arange(160))
        x, y = (u - 99.5) / 150, (v - 79.5) / 150
        known = ((x + 0.3) ** 2 + y ** 2 <= 0.01).sum()
        unknown = ((x - 0.3) ** 2 + y ** 2 <= 0.04).sum()
        area = 1 / 150 ** 2
        expected = [n * 0.01 + n * area * 10 for n in (known, unknown)]
        self.assertAlmostEqual(result.occupied[0], expected[0], delta=0.01 * expected[0])
        self.assertAlmostEqual(result.unknown[0], expected[1], delta=0.01 * expected[1])
        self.assertAlmostEqual(result.scores[0], result.occupied[0] + 2 * result.unknown[0], places=9)
        self.assertAlmostEqual(result.out_of_range[0], 200 * 160 - known - unknown, delta=20)
        self.assertAlmostEqual(unknown * area, np.pi * 0.04, delta=0.002)
        self.assertEqual((result.scores[1], result.out_of_range[1]), (0, 200 * 160))
        image = np.frombuffer(result.images[0].data, np.uint8)
        self.assertEqual((image != 0).sum(), 200 * 160 - result.out_of_range[0])
        points = np.frombuffer(result.clouds[0].data, np.float32).reshape(-1, 4)
        self.assertEqual((points[:, 3] != points[:, 3]).sum(), result.out_of_range[0])
        self.assertAlmostEqual((points[:, 3] < 0).sum(), unknown, delta=20)

        goal.filter_type, goal.filter_data = goal.FILTER_TYPE_SPHERE, [-0.3, 0, 1, 0.1]
        filtered = self.result_of(self.evaluate, goal)
        self.assertEqual((filtered.occupied[0], filtered.unknown[0]), (result.occupied[0], 0))
        goal.input_filter_type, goal.input_filter_data = goal.FILTER_TYPE_BBOX, [0, -1, 1.5, 1, 1, 3]
        goal.filter_type = goal.FILTER_TYPE_NONE
        self.assertGreater(self.result_of(self.evaluate, goal).occupied[0], 0)
        goal.filter_type, goal.filter_data = goal.FILTER_TYPE_BBOX, [1, 2, 3]
        self.result_of(self.evaluate, goal, GoalStatus.ABORTED)
        self.assertIn("6 numbers", self.evaluate.get_goal_status_text())
        goal.filter_type, goal.width = goal.FILTER_TYPE_NONE, 0
        self.result_of(self.evaluate, goal, GoalStatus.ABORTED)
        self.result_of(self.set_cloud, self.surfel.SetPointCloudGoal(cloud=cloud_of(["x", "y", "z"], [(0, 0, 0)])), GoalStatus.ABORTED)

    def ask(self, kind, state=GoalStatus.SUCCEEDED, span=None):
        request = self.basic.BasicRequest(type=kind)
        if span:
            request.has_index_range, request.start_from_index, request.end_before_index = True, *span
        return self.result_of(self.execute, self.basic.ExecuteGoal(request=request), state).response

    def publish(self, topic, kind, message):
        publisher = rospy.Publisher("/basic_next_best_view/" + topic, kind, queue_size=2)
        self.session.until(lambda: publisher.get_num_connections() > 0, 5, topic)
        before = len(self.acks)
        publisher.publish(message)
        self.session.until(lambda: len(self.acks) > before, 5, f"{topic} is not acknowledged")

    @staticmethod
    def seen_from(pose, states, voxel):
        """Distinct voxels, unknown and occupied, that 30 x 30 rays meet first, in small steps."""
        R, t = rotation_of(pose.orientation), np.array([pose.position.x, pose.position.y, pose.position.z])
        a = np.tan(np.pi / 6) * ((2 * np.arange(30) + 1) / 30 - 1)
        d = np.stack([*np.meshgrid(a, a), np.ones((30, 30))], -1).reshape(-1, 3)
        d = d / np.linalg.norm(d, axis=1, keepdims=True) @ R.T
        low = np.min(list(states), axis=0)
        grid = np.full(np.max(list(states), axis=0) - low + 1, -1.0)
        for index, state in states.items():
            grid[tuple(np.array(index) - low)] = state
        steps = np.arange(0, 1.5, 0.02 * voxel)
        index = np.floor((t + steps[:, None, None] * d) / voxel).astype(int) - low
        inside = ((index >= 0) & (index < grid.shape)).all(-1)
        met = np.full(inside.shape, -1.0)
        met[inside] = grid[tuple(index[inside].T)]
        first = (met >= 0).argmax(0)
        rays = np.arange(len(d))
        states_met, voxels = met[first, rays], index[first, rays]
        return tuple(len({tuple(v) for v in voxels[states_met == state]}) for state in (0, 1))

    def test_basic_views(self):
        type(self).acks = []
        rospy.Subscriber("/basic_next_best_view/ack", Empty, self.acks.append)
        self.assertEqual(self.ask(5).pose_count, 0)
        self.assertTrue(self.ask(0).ok)
        self.publish("poi", Point, Point(0.5, 0, 0))
        self.assertEqual(self.ask(5).pose_count, 7 * 12 * 12)
        poses = self.ask(1).pose_list.poses
        for pose in poses[::97]:
            t = np.array([pose.position.x, pose.position.y, pose.position.z])
            self.assertAlmostEqual(np.linalg.norm(t - [0.5, 0, 0]), 1, places=6)
            self.assertTrue(np.allclose(t + rotation_of(pose.orientation)[:, 2], [0.5, 0, 0], atol=1e-6))
        voxel = 0.05
        states = {(x, y, z): (1.0 if z < 0 else 0.0) for x in range(6, 14) for y in range(-4, 4) for z in range(-3, 3)}
        states[(20, 0, 0)] = -1.0
        cloud = [((i + 0.5) * voxel, (j + 0.5) * voxel, (k + 0.5) * voxel, s) for (i, j, k), s in states.items()]
        from sensor_msgs.msg import PointCloud2
        self.publish("occupancy", PointCloud2, cloud_of(["x", "y", "z", "intensity"], cloud))
        candidates = [pose_at(0.5123, 0.0234, -1.0), pose_at(0.5123, 0.0234, 1.0, (1, 0, 0, 0)), poses[7 * 144 - 1], pose_at(5, 5, 5)]
        self.publish("candidates", PoseArray, PoseArray(poses=candidates))
        counts = list(self.ask(6).unknown_count.data)
        weights = self.ask(4).weight_list.data
        for pose, count, weight in zip(candidates, counts, weights):
            unknown, occupied = self.seen_from(pose, states, voxel)
            self.assertAlmostEqual(count, unknown, delta=1)
            self.assertAlmostEqual(weight, unknown + 0.5 * occupied, delta=2)
        self.assertEqual(counts[3], 0)
        order = list(self.ask(2).index_list.data)
        self.assertEqual(order, sorted(range(4), key=lambda i: -weights[i]))
        self.assertEqual(self.ask(3).best_poses.poses[0].position, candidates[order[0]].position)
        self.assertEqual(list(self.ask(6, span=(1, 3)).unknown_count.data), counts[1:3])
        self.assertEqual(sorted(self.ask(2, span=(1, 3)).index_list.data), [1, 2])
        self.ask(6, GoalStatus.ABORTED, span=(3, 9))
        self.ask(17, GoalStatus.REJECTED)
        self.publish("voxel_filter", self.basic.VoxelFilter, self.basic.VoxelFilter(type=2, center=[0.5, 0, 0.15], radius=0.1))
        self.assertTrue(0 < self.ask(6).unknown_count.data[1] < counts[1])


if __name__ == "__main__":
    ViewNodes.session = ros_session.Session(*sys.argv[1:3])
    good = False
    try:
        good = unittest.main(argv=sys.argv[:1] + sys.argv[3:], exit=False, warnings="ignore").result.wasSuccessful()
        if not good:
            print(ViewNodes.session.log("surfel_next_best_view"), ViewNodes.session.log("basic_next_best_view"))
    finally:
        rospy.signal_shutdown("done")
        ViewNodes.session.close()
    os._exit(0 if good else 1)
