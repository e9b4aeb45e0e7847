#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The node kinfu at its limits: answers too large for a message, a map larger than its memory, a camera of 4 Hz whose clock is behind, two clients.

kinfu_limits_test.py SACCADE_ROS1 PYTHON_MESSAGES"""
import os
import sys
import threading
import time
import unittest

import ros_session

sys.path.insert(0, sys.argv[2])
try:
    import numpy as np
    import rospy
    from std_msgs.msg import String

    import numpy_scene as scene
    from kinfu_client import BOX, KinfuClient, msgs
    from patient_client import PatientClient
except ImportError as error:
    ros_session.skip(f"{error.name} is not there (packages.txt, ros)")


class Limits(KinfuClient):
    @classmethod
    def start_node(cls):
        cls.process = cls.session.node("kinfu", "_volume_size:=1.28", "_volume_resolution:=128", "_trunc_dist:=0.03", "_largest_message_mb:=0.05",
                                       "_shift_checker:=FIXED 5 5 5", "_memory_limit_mb:=0.5", f"_temporary_file_dir:={cls.session.folder}",
                                       "_enable_minimum_motion:=false")

    def test_large_answers_go_to_files(self):
        self.one_frame()
        mesh, cloud = self.ask(2), self.ask(3)
        self.assertEqual((len(mesh.mesh.polygons), len(cloud.pointcloud.data)), (0, 0))
        self.assertTrue(mesh.file_name.startswith(self.session.folder) and mesh.file_name.endswith(".ply"), mesh.file_name)
        self.assertTrue(cloud.file_name.endswith(".pcd"), cloud.file_name)
        with open(mesh.file_name, "rb") as file:
            vertices = int(next(line for line in file if line.startswith(b"element vertex")).split()[2])
        with open(cloud.file_name, "rb") as file:
            points = int(next(line for line in file if line.startswith(b"POINTS")).split()[1])
        self.assertEqual(points, vertices)
        self.assertGreater(points, 1000)
        names = []
        rospy.Subscriber("/answers/large", String, lambda said: names.append(said.data))
        request = self.request(3)
        request.tsdf_header.request_source_name = "/answers/large"
        self.requests.publish(request)
        self.session.until(lambda: names, 5, "no file is named")
        self.assertTrue(os.path.exists(names[0]))

    def test_a_map_beyond_its_memory_forgets_what_lies_outside_the_volume(self):
        self.one_frame()
        few = ((-0.05, -0.05, 0.5), (0.05, 0.05, 0.6))
        seen = lambda: (self.grid(few) != 0).sum()
        self.assertGreater(seen(), 500)
        for _ in range(31):  # it is looked at every 30 frames
            self.send(self.image(scene.depth_from()))
            if seen() == 0:
                break
        self.assertEqual(seen(), 0, "nothing is forgotten")
        self.assertIn("outside the volume are forgotten", self.session.log("kinfu"))
        self.assertIsNone(self.process.poll())

    def test_a_slow_camera_with_a_clock_of_its_own(self):
        self.command(3)
        self.command(1)
        begin = time.time()
        for _ in range(4):  # 4 Hz, 100 s behind
            self.send(self.image(scene.depth_from(), stamp=rospy.Time.now() - rospy.Duration(100)))
            time.sleep(0.2)
        self.assertLess(time.time() - begin, 5)
        self.assertEqual(len(self.lost), 0)
        self.assertGreater((self.grid(((-0.05, -0.05, 0.5), (0.05, 0.05, 0.6))) != 0).sum(), 500)

    def test_two_clients_ask_at_once(self):
        self.one_frame()
        few = ((-0.05, -0.05, 0.5), (0.05, 0.05, 0.6))
        expected = self.grid(few)
        other = PatientClient("/kinfu_output/actions/request", msgs.RequestAction)
        self.assertTrue(other.wait_for_server(rospy.Duration(5)))
        answers = []

        def ask_often():
            for _ in range(20):
                other.send_goal(msgs.RequestGoal(request=self.request(8, few)))
                if other.wait_for_result(rospy.Duration(5)):
                    answers.append(np.array(other.get_result().float_values.data))

        thread = threading.Thread(target=ask_often)
        thread.start()
        for _ in range(20):
            self.assertTrue((self.grid(few) == expected).all())
        thread.join()
        self.assertEqual(len(answers), 20)
        for answer in answers:
            self.assertTrue((answer == expected.ravel()).all())


if __name__ == "__main__":
    ros_session.run_tests(Limits, "kinfu")
