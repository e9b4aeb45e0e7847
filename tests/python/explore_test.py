#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The loop from Python: each of its seams as an object of Python, strategies, comparisons, and what goes wrong in them."""
import threading
import unittest

import numpy as np

import saccade

SMALL = {"width": 96, "gain_width": 64, "voxel_size_m": 0.02, "threads": 1}


def scene_and_map():
    camera = saccade.trial.SimulatedCamera("tabletop-1", width=96, threads=1)
    return camera, saccade.TsdfMap(voxel_size_m=0.02, truncation_vox=2, workspace=camera.workspace, threads=1)


class Ring:
    """Views from all around, at one height."""

    def views(self, context):
        low, high = context.region.min, context.region.max
        center = 0.5 * (low + high)
        angles = np.arange(0.0, 2 * np.pi, np.pi / 6)
        return np.stack([saccade.look_at(center + (0.7 * np.cos(a), 0.7 * np.sin(a), 0.5), center) for a in angles])


class Explorers(unittest.TestCase):
    def explore(self, **parts):
        camera, m = scene_and_map()
        explorer = saccade.Explorer(m, camera, gain_width=64, **parts)
        explorer.scan(camera.scan)
        return camera, m, explorer

    def test_an_explorer_takes_the_views_of_the_trial(self):
        camera, m, explorer = self.explore(oscillation_frames=5)
        run = explorer.explore(max_views=2)
        trial = saccade.trial.run("tabletop-1", "surface", max_views=2, **SMALL)
        for own, other in zip(run["views"], trial["views"], strict=True):
            np.testing.assert_array_equal(own["T_world_camera"], other["T_world_camera"])
        self.assertAlmostEqual(camera.measure(m)["coverage"], trial["final"]["coverage"], places=9)
        self.assertEqual(explorer.explore(max_views=3)["views"][1]["frames"], run["views"][1]["frames"])
        self.assertEqual(len(explorer.run["views"]), 3)

    def test_every_seam_is_an_object_of_python(self):
        seen = []

        class Robot:
            def reachable(self, poses):
                return poses[:, 2, 3] > 0.2

            def move_to(self, T_world_camera):
                seen.append("moved")
                moved = T_world_camera.copy()
                moved[0, 3] += 0.001
                return moved

        class Recorder:
            def viewed(self, view, m, depth_images):
                seen.append((view["frames"], m.voxel_size_m, depth_images[0].shape, depth_images[0].dtype))

        class Attention:
            def regions(self, context):
                assert context.region is None
                return [(saccade.Box((-0.3, -0.3, 0.0), (0.3, 0.3, 0.3)), 2.0)]

        strategy = saccade.Strategy(attention=Attention(), views=Ring(), gain=lambda context, poses: np.arange(len(poses)) + 1.0, name="ring")
        camera, m, explorer = self.explore(robot=Robot(), recorder=Recorder(), strategy=strategy, stopping=lambda run: len(run["views"]) == 2,
                                           approve=lambda pose, gain: gain != 12.0)
        run = explorer.explore(max_views=9)
        self.assertEqual((len(run["views"]), run["stopped_because"]), (2, "cancelled"))
        self.assertEqual([view["gain_predicted"] for view in run["views"]], [11.0, 10.0])
        self.assertIn((1, 0.02, (72, 96), np.float32), seen)
        expected = Ring().views(type("Context", (), {"region": saccade.Box((-0.3, -0.3, 0.0), (0.3, 0.3, 0.3))}))[10]
        self.assertAlmostEqual(run["views"][0]["T_world_camera"][0, 3], expected[0, 3])

    def test_a_robot_that_declines_is_told_of_other_views(self):
        refused = []

        def move_to(pose):
            refused.append(pose)
            return len(refused) > 20  # the scan's poses and some views

        camera, m, explorer = self.explore(robot=move_to, strategy="sphere")
        run = explorer.explore(max_views=1)
        self.assertEqual(run["scan"]["views"], 0)
        self.assertGreater(run["scan"]["refused"]["declined"], 0)
        self.assertEqual(len(run["views"]), 1)
        self.assertGreater(run["views"][0]["refused"]["declined"], 0)

    def test_what_a_seam_raises_comes_back(self):
        def broken(*_):
            raise KeyError("own words")

        class Broken:
            viewed = broken

        camera, m = scene_and_map()
        for parts in ({"robot": broken, "strategy": "sphere"}, {"stopping": broken}, {"approve": broken, "strategy": "sphere"}, {"recorder": Broken(), "strategy": "sphere"},
                      {"strategy": saccade.Strategy(views=broken)}, {"strategy": saccade.Strategy(attention=broken)},
                      {"strategy": saccade.Strategy(gain=broken)}):
            with self.assertRaisesRegex(KeyError, "own words", msg=str(parts)):
                saccade.Explorer(m, camera, gain_width=64, **parts).explore(max_views=1)

        class Camera:
            intrinsics = camera.intrinsics

            def __init__(self, said):
                self.said = said

            def capture(self, T_world_camera):
                return self.said

        for said, error, words in ((None, (TypeError, ValueError), "depth"), ("x", (TypeError, ValueError), "depth"), (np.zeros((3, 4), np.float32), ValueError, "3 x 4"),
                                   (np.zeros((72, 96), np.int64), TypeError, "int64"), ((1, 2, 3, 4), ValueError, "capture")):
            with self.assertRaisesRegex(error, words):
                saccade.Explorer(m, Camera(said)).explore(max_views=1)

    def test_wrong_parts_are_named(self):
        camera, m = scene_and_map()
        for words, call in (("intrinsics", lambda: saccade.Explorer(m, object())),
                            ("move_to", lambda: saccade.Explorer(m, camera, robot=3)),
                            ("scanned, viewed or ended", lambda: saccade.Explorer(m, camera, recorder=object())),
                            ("evaluate", lambda: saccade.Strategy(gain=5)),
                            ("name or a saccade.Strategy", lambda: saccade.Explorer(m, camera, strategy=5))):
            with self.assertRaisesRegex(TypeError, words):
                call()
        with self.assertRaisesRegex(ValueError, "surface"):
            saccade.Strategy("nothing")
        with self.assertRaisesRegex(ValueError, "workspace"):
            saccade.Explorer(saccade.TsdfMap(voxel_size_m=0.02), camera)
        with self.assertRaisesRegex(ValueError, "closed"):
            m.close()
            saccade.Explorer(m, camera)

    def test_a_planner_names_views_without_moving(self):
        camera, m = scene_and_map()
        for pose in camera.scan:
            m.integrate(camera.intrinsics, camera.capture(pose), pose)
        planner = saccade.ViewPlanner(camera.intrinsics, "surface", gain_width=64)
        views = planner.next_views(m, count=3)
        gains = [view["gain"] for view in views]
        self.assertEqual(gains, sorted(gains, reverse=True))
        other = planner.next_views(m, count=1, taken=[views[0]["T_world_camera"]])[0]
        self.assertFalse(np.array_equal(other["T_world_camera"], views[0]["T_world_camera"]))
        self.assertLessEqual(other["gain"], gains[0])
        found = []
        threads = [threading.Thread(target=lambda: found.append(planner.next_views(m, count=1)[0]["gain"])) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, [gains[0]] * 3)


class Arms(unittest.TestCase):
    def test_an_arm_plans_and_its_joints_are_moved_from_python(self):
        moves = []

        class Joints:
            q = None

            def position(self):
                return self.q

            def execute(self, t_s, q, dq, report):
                moves.append((t_s, q, dq))
                assert np.all(np.diff(t_s) > 0) and q.shape == dq.shape == (len(t_s), 6)
                np.testing.assert_array_equal(q[0], self.q)
                for t, position in zip(t_s, q):
                    if not report(t, position):
                        break
                    self.q = position

        joints = Joints()
        arm = saccade.Arm("comau", joints=joints)
        joints.q = arm.middle
        self.assertEqual(len(arm.joint_names), 6)
        camera, m = scene_and_map()
        explorer = saccade.Explorer(m, camera, robot=arm, gain_width=64, radii_m=[0.6])
        explorer.scan(camera.scan)
        run = explorer.explore(max_views=1)
        self.assertEqual(len(run["views"]), 1)
        np.testing.assert_allclose(arm.camera_pose(explorer.q), run["views"][0]["T_world_camera"], atol=2e-3)
        np.testing.assert_array_equal(explorer.q, joints.q)
        t_s, q, dq = max(moves, key=lambda move: len(move[0]))
        self.assertLess(np.abs(np.gradient(q, t_s, axis=0) - dq)[1:-1].max(), 0.05)
        simulated = saccade.Explorer(scene_and_map()[1], camera, robot=saccade.Arm("comau", start=arm.middle), gain_width=64)
        self.assertEqual(simulated.scan(camera.scan)["views"], run["scan"]["views"])

    def test_joints_that_fail_end_the_run(self):
        class Joints:
            def position(self):
                return saccade.Arm("comau").middle

            def execute(self, t_s, q, dq, report):
                raise OSError("the cable is loose")

        camera, m = scene_and_map()
        explorer = saccade.Explorer(m, camera, robot=saccade.Arm("comau", joints=Joints()), gain_width=64)
        with self.assertRaisesRegex(OSError, "cable"):
            explorer.scan(camera.scan)
        for words, error, call in (("6 numbers", ValueError, lambda: saccade.Arm("comau", start=[1.0])),
                                   ("position", TypeError, lambda: saccade.Arm("comau", joints=object())),
                                   ("comau_smart_six", FileNotFoundError, lambda: saccade.Arm("unheard-of"))):
            with self.assertRaisesRegex(error, words):
                call()


class Comparisons(unittest.TestCase):
    def test_a_strategy_of_ones_own_beside_ours(self):
        told = []
        ring = saccade.Strategy(views=Ring(), name="ring", min_gain=20.0)
        result = saccade.trial.compare(["sphere", ring], ["tabletop-1"], [1, 2], max_views=2, progress=lambda *state: told.append(state), **SMALL)
        self.assertEqual([(run["strategy"], run["seed"]) for run in result["runs"]], [("sphere", 1), ("ring", 1), ("sphere", 2), ("ring", 2)])
        rows = {row["strategy"]: row for row in result["summary"]}
        covered = [run["final"]["coverage"] for run in result["runs"] if run["strategy"] == "ring"]
        name = next(name for name in rows["ring"] if name.startswith("coverage"))
        self.assertAlmostEqual(rows["ring"][name]["mean"], np.mean(covered), places=9)
        self.assertEqual(rows["ring"][name]["n"], 2)
        self.assertLessEqual(rows["ring"][name]["low"], rows["ring"][name]["mean"])
        self.assertEqual([row["strategy"] for row in result["gaps"]], ["ring"])
        self.assertAlmostEqual(result["gaps"][0][name]["mean"], rows["ring"][name]["mean"] - rows["sphere"][name]["mean"], places=9)
        self.assertIn(("runs", 4, 4), told)
        alone = saccade.trial.run("tabletop-1", "sphere", max_views=2, seed=2, **SMALL)
        self.assertEqual(alone["final"], result["runs"][2]["final"])

    def test_what_cannot_be_compared_is_said(self):
        for words, call in (("one scene", lambda: saccade.trial.compare(["sphere"], [], [1])),
                            ("called sphere", lambda: saccade.trial.compare(["sphere", "sphere"], ["tabletop-1"], [1])),
                            ("nowhere", lambda: saccade.trial.compare(["nowhere"], ["tabletop-1"], [1]))):
            with self.assertRaisesRegex(ValueError, words):
                call()

    def test_an_exception_ends_a_comparison(self):
        def stop(stage, done, total):
            raise RuntimeError("enough")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            saccade.trial.compare(["sphere"], ["tabletop-1"], [1], progress=stop, **SMALL)


if __name__ == "__main__":
    unittest.main()
