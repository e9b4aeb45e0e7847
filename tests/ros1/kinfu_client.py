# SPDX-License-Identifier: Apache-2.0
"""Messages of the tests to the node kinfu, and waiting for its answers."""
import time
import unittest

import numpy as np
import rospy
import tf2_ros
from actionlib_msgs.msg import GoalStatus
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Empty, Header, String
from kinfu_msgs import msg as msgs
from kinfu_msgs import srv as srvs

import numpy_scene as scene
from patient_client import PatientClient

VOXEL = 0.01
BOX = ((-0.4, -0.4, 0.4), (0.4, 0.4, 1.2))
SIZE = 80


class KinfuClient(unittest.TestCase):
    session = None

    @classmethod
    def setUpClass(cls):
        cls.start_node()
        rospy.init_node("client", disable_signals=True)
        cls.shifts = []
        cls.service = rospy.Service("/check_for_shift", srvs.CheckForShift, cls.check_for_shift)
        cls.acks, cls.image_acks, cls.lost, cls.poses = [], [], [], []
        rospy.Subscriber("/kinfu_command_ack_topic", String, lambda m: cls.acks.append(m.data))
        rospy.Subscriber("/kinfu_image_ack", Header, lambda m: cls.image_acks.append(m.stamp))
        rospy.Subscriber("/kinfu_icp_lost_topic", Empty, cls.lost.append)
        cls.images = rospy.Publisher("/camera/depth/image_raw", Image, queue_size=5)
        cls.infos = rospy.Publisher("/camera/depth/camera_info", CameraInfo, queue_size=5)
        cls.commands = rospy.Publisher("/kinfu_command_topic", msgs.KinfuCommand, queue_size=50)
        cls.requests = rospy.Publisher("/kinfu_request_topic", msgs.KinfuTsdfRequest, queue_size=50)
        cls.resets = rospy.Publisher("/kinfu_require_reset_topic", Empty, queue_size=5)
        cls.client = PatientClient("/kinfu_output/actions/request", msgs.RequestAction)
        cls.upload = PatientClient("/kinfu/world_upload", msgs.WorldUploadAction)
        cls.buffer = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.buffer)
        cls.broadcaster = tf2_ros.TransformBroadcaster()
        assert cls.client.wait_for_server(rospy.Duration(10)), "the node offers no action"
        assert cls.upload.wait_for_server(rospy.Duration(10))
        cls.wait_for_links()
        cls.last_id = 0

    @classmethod
    def start_node(cls):
        cls.process = cls.session.node("kinfu", "_volume_size:=1.28", "_volume_resolution:=128", "_trunc_dist:=0.03",
                                       "_shift_checker:=ROSSERVICE 0.1 /check_for_shift",
                                       f"_temporary_file_dir:={cls.session.folder}", "_enable_minimum_motion:=false",
                                       "_forced_tf_reference_frame:=base", "_forced_tf_current_frame:=tool")

    @classmethod
    def wait_for_links(cls):
        for topic in (cls.images, cls.infos, cls.commands, cls.requests, cls.resets):
            cls.session.until(lambda: topic.get_num_connections() > 0, 10, f"nothing listens to {topic.name}")

    @classmethod
    def check_for_shift(cls, request):
        cls.shifts.append(request)
        answer = srvs.CheckForShiftResponse(do_shift=True)
        answer.new_center.x = 0.25
        return answer

    # ---- sending

    def command(self, kind, expect="OK", wait=True, hint=None, forced=False, **data):
        type(self).last_id += 1
        command = msgs.KinfuCommand(command_type=kind, command_id=f"c{self.last_id}", **data)
        if hint is not None:
            rotation, translation = hint
            command.hint_expiration_time = rospy.Time.now() + rospy.Duration(10)
            command.hint_forced = forced
            command.pose_hint_rotation = list(np.asarray(rotation).ravel())
            command.pose_hint_translation = list(translation)
        self.commands.publish(command)
        if wait:
            self.acknowledged(command.command_id, expect)
        return command.command_id

    def acknowledged(self, name, expect="OK"):
        self.session.until(lambda: any(a.startswith(name + ":") for a in self.acks), 5, f"{name} is not acknowledged")
        self.assertIn(f"{name}:{expect}", self.acks)

    def image(self, depth, encoding="32FC1", big=False, padding=0, size=None, stamp=None):
        height, width = depth.shape
        kind = {"32FC1": "f4", "16UC1": "u2", "mono16": "u2"}[encoding]
        values = depth if kind == "f4" else np.round(depth * 1000)
        bytes_ = values.astype((">" if big else "<") + kind).view(np.uint8).reshape(height, -1)
        image = Image(width=width, height=height, encoding=encoding, is_bigendian=int(big))
        image.header.stamp = stamp or rospy.Time.now()
        image.header.frame_id = "camera"
        image.step = bytes_.shape[1] + padding
        image.data = np.pad(bytes_, ((0, 0), (0, padding))).tobytes()
        return image

    def send(self, image, info_size=(scene.WIDTH, scene.HEIGHT), wait=True):
        info = CameraInfo(width=info_size[0], height=info_size[1])
        info.K = [scene.FOCAL, 0, scene.CENTER[0], 0, scene.FOCAL, scene.CENTER[1], 0, 0, 1]
        acknowledged = lambda: image.header.stamp in self.image_acks
        for _ in range(5 if wait else 1):  # again, where the image overtook the camera's description
            self.infos.publish(info)
            time.sleep(0.02)
            self.images.publish(image)
            end = time.time() + 1.5
            while wait and not acknowledged() and time.time() < end:
                time.sleep(0.005)
            if not wait or acknowledged():
                break
        self.assertTrue(not wait or acknowledged(), "the image is not acknowledged")
        return image

    def one_frame(self):
        self.command(3)
        self.command(1)
        self.send(self.image(scene.depth_from()))

    @staticmethod
    def request(kind, box=None, **fields):
        request = msgs.KinfuTsdfRequest(**fields)
        request.tsdf_header.request_type = kind
        request.tsdf_header.request_id = 7
        if box is not None:
            request.request_bounding_box = True
            request.bounding_box_min = msgs.KinfuCloudPoint(*box[0])
            request.bounding_box_max = msgs.KinfuCloudPoint(*box[1])
        request.sphere_center = fields.get("sphere_center", msgs.KinfuCloudPoint())
        return request

    def ask(self, kind, box=None, state=GoalStatus.SUCCEEDED, **fields):
        self.client.send_goal(msgs.RequestGoal(request=self.request(kind, box, **fields)))
        self.assertTrue(self.client.wait_for_result(rospy.Duration(10)), f"request {kind} is not answered")
        self.assertEqual(self.client.get_state(), state, self.client.get_goal_status_text())
        return self.client.get_result()

    @staticmethod
    def points(cloud):
        return np.frombuffer(cloud.data, np.float32).reshape(-1, cloud.point_step // 4)

    def grid(self, box=BOX):
        values = self.ask(8, box).float_values
        x, y, z = (d.size for d in values.layout.dim)
        return np.array(values.data).reshape(z, y, x)

    @staticmethod
    def view_camera():
        return msgs.KinfuCameraIntrinsics(center_x=31.5, center_y=23.5, focal_x=52, focal_y=52, size_x=64, size_y=48)

    @staticmethod
    def pose(x=0.0, y=0.0, z=0.0):
        return msgs.KinfuPose(linear=[1, 0, 0, 0, 1, 0, 0, 0, 1], translation=[x, y, z])
