#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Rooms of the library from Python: hands, frames, clouds, tracking. What the module says is held against the truth and the program."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import saccade


def program(*arguments):
    """Runs the program, and returns the result that it writes as JSON."""
    run = subprocess.run([sys.executable, "-m", "saccade", "--json", "-", "--quiet", *map(str, arguments)],
                         stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=True)
    return json.loads(run.stdout)["result"]


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


PLACES = np.array([(-0.4, 0.0, 0.3), (0.1, 0.35, 0.05), (0.35, -0.1, 0.1), (-0.1, -0.4, 0.1), (-0.4, 0.0, 0.3)])


def hand():
    """A hand that goes from place to place, 0.6 s each, and rests a fifth of a second at each."""
    u = np.linspace(0.0, 1.0, 60, endpoint=False)[:, None]
    smooth = u**3 * (10.0 - 15.0 * u + 6.0 * u * u)
    parts = [np.vstack([a + smooth * (b - a) + np.sin(np.pi * smooth) * (0.0, 0.0, 0.15), np.repeat([b], 20, axis=0)])
             for a, b in zip(PLACES, PLACES[1:])]
    positions_m = np.vstack(parts)
    positions_m = positions_m + np.random.default_rng(1).normal(0.0, 0.0005, positions_m.shape)
    return 0.01 * np.arange(len(positions_m)), positions_m


class Hands(Folder):
    def test_actions_are_where_the_hand_was_slow(self):
        actions = saccade.find_actions(*hand())
        self.assertEqual(len(actions), 3)
        for action, place, time_s in zip(actions, PLACES[1:], (0.7, 1.5, 2.3)):
            self.assertLess(np.linalg.norm(action["position_m"] - place), 0.03)
            self.assertAlmostEqual(action["time_s"], time_s, delta=0.15)
            self.assertGreater(action["saliency"], 0.0)
            self.assertTrue(action["why"])
        scored = saccade.score_actions(actions, PLACES[1:])
        self.assertEqual((scored["labels"], scored["true_positives"], scored["false_positives"]), (4, 3, 0))
        self.assertEqual((scored["precision"], scored["recall"]), (1.0, 0.75))
        self.assertIsNone(saccade.score_actions([], PLACES)["precision"])

    def test_methods_say_what_the_program_says(self):
        times_s, positions_m = hand()
        file = self.folder / "hand.csv"
        np.savetxt(file, np.column_stack([times_s, positions_m]), delimiter=",", header="time,x,y,z", comments="",
                   fmt="%.17g")
        read = saccade.read_hand(str(file))
        np.testing.assert_array_equal(read[0], times_s)
        np.testing.assert_array_equal(read[1], positions_m)
        for method, printed in (("ours", False), ("gmm-as", False), ("gmm-as", True), ("zvc", False), ("zvc", True)):
            found = saccade.find_actions(times_s, positions_m, method=method, as_printed=printed)
            self.assertTrue(found, method)
            options = ["--as-printed"] if printed else []
            said = program("attend", file, "--method", method, *options)["details"][0]["actions"]
            self.assertEqual([{**action, "position_m": action["position_m"].tolist()} for action in found], said)

    def test_a_stream_tells_of_an_action_before_the_hand_is_through(self):
        times_s, positions_m = hand()
        stream = saccade.ActionStream()
        told = [(time_s, action) for time_s, position_m in zip(times_s, positions_m)
                for action in stream.put(time_s, position_m)]
        self.assertEqual(len(told), 3)
        for (now_s, action), place in zip(told, PLACES[1:]):
            self.assertLess(np.linalg.norm(action["position_m"] - place), 0.05)
            self.assertLess(now_s, action["time_s"] + 0.9)
        with self.assertRaisesRegex(ValueError, "before"):
            stream.put(0.0, (0, 0, 0))

    def test_what_is_wrong_is_an_exception(self):
        times_s, positions_m = hand()
        nan = np.where(np.arange(len(times_s))[:, None] == 7, np.nan, positions_m)
        self.assertEqual(saccade.find_actions([], np.zeros((0, 3))), [])
        for error, words, call in (
                (ValueError, "320 samples, positions_m has 10", lambda: saccade.find_actions(times_s, positions_m[:10])),
                (ValueError, "N x 3, not of shape .320, 2.", lambda: saccade.find_actions(times_s, positions_m[:, :2])),
                (TypeError, "of numbers", lambda: saccade.find_actions(times_s, positions_m.astype(str))),
                (ValueError, "sample 7", lambda: saccade.find_actions(times_s, nan)),
                (ValueError, "back in time|decrease|before", lambda: saccade.find_actions(times_s[::-1], positions_m)),
                (ValueError, "ours, gmm-as or zvc, not lstm", lambda: saccade.find_actions([], [], method="lstm")),
                (ValueError, "prints nothing", lambda: saccade.find_actions([], [], as_printed=True)),
                (ValueError, "position_m", lambda: saccade.score_actions([{}], PLACES)),
                (FileNotFoundError, "no such", lambda: saccade.read_hand("/nowhere.csv"))):
            with self.assertRaisesRegex(error, words):
                call()


def rendered(folder, frames=5):
    """Frames of a camera that moves slowly before a painted scene, with their poses."""
    subprocess.run([sys.executable, "-m", "saccade", "--quiet", "scene", "sequence", "desk", "--out", str(folder),
                    "--frames", str(frames), "--image-size", "160,120", "--depth-noise", "off"],
                   stdout=subprocess.DEVNULL, check=True)
    return str(folder)


class Frames(Folder):
    def test_a_folder_gives_the_map_that_the_program_makes_of_it(self):
        path = rendered(self.folder / "frames")
        frames = saccade.open_frames(path)
        self.assertEqual((len(frames), frames.has_poses, frames.has_color), (5, True, True))
        m = saccade.TsdfMap(voxel_size_m=0.02, clearing_percent=50, threads=1)
        for frame in frames:
            self.assertEqual((frame.depth.shape, frame.depth.dtype), ((120, 160), np.float32))
            self.assertEqual((frame.color.shape, frame.color.dtype), ((120, 160, 3), np.uint8))
            m.integrate(frames.camera, frame.depth, frame.T_world_camera, frame.color)
        out = self.folder / "run"
        said = program("fuse", path, "--out", out, "--voxel-size", 0.02, "--no-pictures", "--no-mesh")
        self.assertEqual(said["tracking"], "forced")
        theirs = saccade.TsdfMap.load(str(out / "map.sacmap"))
        np.testing.assert_array_equal(m.ternary(), theirs.ternary())
        np.testing.assert_array_equal(m.tsdf(), theirs.tsdf())
        self.assertGreater(np.count_nonzero(m.ternary() == 1), 1000)

    def test_a_recording_of_a_run_gives_its_views(self):
        bag = self.folder / "run.mcap"
        said = program("explore", "tabletop-1", "--max-views", 1, "--voxel-size", 0.03, "--image-size", "96,72",
                       "--gain-width", 32, "--no-pictures", "--out", self.folder / "run", "--record", bag)
        frames = saccade.open_frames(str(bag))
        self.assertEqual((len(frames), frames.has_poses, frames.camera.width, frames.damage),
                         (len(said["views"]), True, 96, ""))
        self.assertGreater(np.count_nonzero(frames[0].depth > 0.0), 1000)
        # The frame that is recorded is one of several of the view, tilted about the camera's x axis.
        np.testing.assert_allclose(frames[0].T_world_camera[:, [0, 3]],
                                   np.array(said["views"][0]["T_world_camera"])[:, [0, 3]], atol=1e-6)
        with self.assertRaisesRegex(FileNotFoundError, "/nothing"):
            saccade.open_frames(str(bag), depth_topic="/nothing")
        _, positions_m = saccade.read_hand(str(bag), hand="/saccade/next_view")
        np.testing.assert_allclose(positions_m, [np.array(said["views"][0]["T_world_camera"])[:3, 3]], atol=1e-6)
        with self.assertRaisesRegex(FileNotFoundError, "/glove is neither a topic .* nor a frame of TF"):
            saccade.read_hand(str(bag), hand="/glove")

    def test_frames_are_chosen_and_read_again(self):
        path = rendered(self.folder / "frames")
        frames = saccade.open_frames(path)
        np.testing.assert_array_equal(frames[-1].depth, list(frames)[4].depth)
        chosen = saccade.open_frames(path, first=1, every=2, count=2, color=False)
        self.assertEqual([frame.index for frame in chosen], [1, 3])
        np.testing.assert_array_equal(chosen[1].depth, frames[3].depth)
        self.assertIsNone(chosen[0].color)
        half = saccade.PinholeCamera(160, 120, fx=frames.camera.fx / 2, fy=frames.camera.fy / 2, max_range_m=1.0)
        near = saccade.open_frames(path, camera=half)
        self.assertEqual((near.camera.fx, near.camera.max_range_m), (half.fx, 1.0))
        for error, words, call in (
                (IndexError, "5 frames, none at 5", lambda: frames[5]),
                (FileNotFoundError, "", lambda: saccade.open_frames("/nowhere")),
                (ValueError, "seven-scenes", lambda: saccade.open_frames(path, layout="mine")),
                (ValueError, "bags", lambda: saccade.open_frames(path, depth_topic="/depth")),
                (ValueError, "", lambda: saccade.open_frames(path, every=0))):
            with self.assertRaisesRegex(error, words):
                call()

    def test_a_frame_that_is_broken_raises_and_the_next_follows(self):
        path = pathlib.Path(rendered(self.folder / "frames"))
        broken = sorted(path.rglob("*depth*.png")) or sorted((path / "depth").glob("*.png"))
        broken[2].write_bytes(b"no PNG")
        walk = iter(saccade.open_frames(str(path)))
        self.assertEqual((next(walk).index, next(walk).index), (0, 1))
        with self.assertRaisesRegex(ValueError, broken[2].name):
            next(walk)
        self.assertEqual([frame.index for frame in walk], [3, 4])


class Clouds(Folder):
    def test_files_give_the_arrays_back(self):
        random = np.random.default_rng(3)
        points = random.normal(size=(50, 3)).astype(np.float32)
        normals = (points / np.linalg.norm(points, axis=1, keepdims=True)).astype(np.float32)
        colors = random.integers(0, 256, (50, 3), np.uint8)
        labels = random.integers(0, 9, 50)
        radii = random.uniform(0.1, 0.2, 50).astype(np.float32)
        for name in ("cloud.ply", "cloud.pcd", "cloud.csv"):
            path = str(self.folder / name)
            saccade.write_cloud(path, points, normals=normals, colors=colors, radii=radii, labels=labels)
            read = saccade.read_cloud(path)
            for key, array in (("points", points), ("normals", normals), ("radii", radii), ("labels", labels)):
                np.testing.assert_array_equal(read[key], array, f"{key} of {name}")
            np.testing.assert_array_equal(read["colors"], colors, name)
            np.testing.assert_array_equal(read["offset"], np.zeros(3))
        offset = np.array([461200.0, 5263500.0, 500.0])
        saccade.write_cloud(path, points, offset=offset)
        far = saccade.read_cloud(path)
        np.testing.assert_allclose(far["points"] + (far["offset"] - offset), points, atol=1e-6)
        saccade.write_cloud(path, points.astype(np.float64) + offset)  # doubles keep what floats would cut
        np.testing.assert_allclose(saccade.read_cloud(path)["points"], far["points"], atol=1e-6)
        saccade.write_cloud(path, points.astype(np.float64)[::2])
        read = saccade.read_cloud(path)
        np.testing.assert_array_equal(read["points"], points[::2])
        self.assertEqual([read[key] for key in ("normals", "colors", "radii", "labels")], [None] * 4)

    def test_what_is_wrong_is_an_exception(self):
        points, path, text = np.zeros((4, 3)), str(self.folder / "cloud.ply"), self.folder / "text.md"
        text.write_text("no cloud")
        for error, words, call in (
                (ValueError, "N x 3", lambda: saccade.write_cloud(path, np.zeros((4, 2)))),
                (ValueError, "4 points, but 2 normals", lambda: saccade.write_cloud(path, points, normals=points[:2])),
                (ValueError, "4 points, but 0 colors", lambda: saccade.write_cloud(path, points, colors=[])),
                (ValueError, "4 points, but 2 labels", lambda: saccade.write_cloud(path, points, labels=[1, 2])),
                (ValueError, "not be -1", lambda: saccade.write_cloud(path, points, labels=[-1, 0, 0, 0])),
                (TypeError, "whole", lambda: saccade.write_cloud(path, points, labels=np.zeros(4))),
                (ValueError, "0, 1", lambda: saccade.write_cloud(path, points, colors=points + 2.0)),
                (FileNotFoundError, "", lambda: saccade.read_cloud("/nowhere.ply")),
                (ValueError, "not a point cloud", lambda: saccade.read_cloud(str(text)))):
            with self.assertRaisesRegex(error, words):
                call()


CAMERA = saccade.PinholeCamera(160, 120, fx=131.25, fy=131.25)
BALLS = np.array([(0.0, 0.0, 0.05, 0.12), (0.3, 0.1, 0.1, 0.15), (-0.25, 0.2, 0.02, 0.1), (-0.1, -0.3, 0.1, 0.12)])


def seen(T_world_camera):
    """Depth of a table, z = 0, with balls on it."""
    v, u = np.mgrid[:CAMERA.height, :CAMERA.width]
    rays = np.stack([(u - CAMERA.cx) / CAMERA.fx, (v - CAMERA.cy) / CAMERA.fy, np.ones(u.shape)], axis=-1)
    ways, start = rays @ T_world_camera[:3, :3].T, T_world_camera[:3, 3]
    depth = -start[2] / ways[..., 2]
    for ball in BALLS:
        to = start - ball[:3]
        a, b, c = (ways**2).sum(-1), ways @ to, to @ to - ball[3]**2
        root = b * b - a * c
        meets = (-b - np.sqrt(np.maximum(root, 0.0))) / a
        depth = np.where((root > 0.0) & (meets < depth), meets, depth)
    return depth.astype(np.float32)


class Tracking(unittest.TestCase):
    def test_icp_finds_the_camera_and_a_wrong_place_is_refused(self):
        true = [saccade.look_at((0.02 * i, -0.6, 0.8 + 0.01 * i), (0.0, 0.0, 0.0)) for i in range(6)]
        maps = {}
        for mode in ("icp", "hint", "forced"):
            maps[mode] = saccade.TsdfMap(voxel_size_m=0.01, threads=1)
            tracker = saccade.Tracker(maps[mode], CAMERA, mode)
            self.assertIsNone(tracker.T_world_camera)
            for i, pose in enumerate(true):
                found = tracker.fuse(seen(pose), pose if mode == "forced" or i == 0 else
                                     true[i - 1] if mode == "hint" else None)
                self.assertTrue(found["accepted"] and found["fused"], found["why"])
                off_m = np.linalg.norm((found["T_world_camera"] - pose)[:3, 3])
                self.assertLessEqual(off_m, 0.0 if mode == "forced" else 0.004)
                self.assertEqual(found["iterations"] > 0, mode != "forced" and i > 0)
            np.testing.assert_array_equal(tracker.T_world_camera, found["T_world_camera"])
        before = maps["icp"].weights()
        tracker = saccade.Tracker(maps["icp"], CAMERA, "hint")
        self.assertLess(tracker.track(seen(true[3]), true[3])["rmse_m"], 0.01)
        away = true[3].copy()
        away[:3, :3] = away[:3, :3] @ [[-1, 0, 0], [0, 1, 0], [0, 0, -1]]
        lost = tracker.fuse(seen(true[3]), away)
        self.assertEqual((lost["accepted"], lost["fused"]), (False, False))
        self.assertTrue(lost["why"])
        np.testing.assert_array_equal(maps["icp"].weights(), before)
        with self.assertRaisesRegex(ValueError, "needs T_hint"):
            tracker.track(seen(true[0]))
        with self.assertRaisesRegex(ValueError, "size"):
            tracker.track(seen(true[0])[:60], true[0])
        with self.assertRaisesRegex(ValueError, "icp, rgbd, hint or forced"):
            saccade.Tracker(maps["icp"], CAMERA, "magic")
        with self.assertRaisesRegex(TypeError, "TsdfMap"):
            saccade.Tracker(None, CAMERA)
        maps["icp"].close()
        with self.assertRaisesRegex(ValueError, "closed"):
            tracker.track(seen(true[3]), true[3])


class Filter(unittest.TestCase):
    def test_the_shadow_of_a_box_is_removed(self):
        camera = saccade.PinholeCamera(160, 120, fx=114.0, fy=114.0)
        depth = np.full((120, 160), 2.0, np.float32)
        depth[40:80, 60:100] = 1.0
        depth[0, :5] = 0.0
        baseline_m = 0.08
        for side, first in (("left", 100), ("right", 60 - 1)):
            kept, pixels = saccade.filter_kinect_v2(camera, depth, method="thesis", emitter_side=side, veil_points=False)
            # The edge at z = 1 hides what lies behind it up to fx b (1 / 1 - 1 / 2) pixels beyond.
            wide = int(114.0 * baseline_m * 0.5)
            shadow = np.zeros(depth.shape, bool)
            step = 1 if side == "left" else -1
            shadow[40:80, [first + step * i for i in range(wide)]] = True
            np.testing.assert_array_equal(pixels == 2, shadow)
            np.testing.assert_array_equal(kept, np.where(shadow, 0, depth))
            np.testing.assert_array_equal(pixels == 0, depth == 0)
        self.assertEqual(np.count_nonzero(saccade.filter_kinect_v2(camera, depth, shadow_points=False)[1] == 2), 0)
        for error, words, call in (
                (ValueError, "surface or thesis", lambda: saccade.filter_kinect_v2(camera, depth, method="none")),
                (ValueError, "left or right", lambda: saccade.filter_kinect_v2(camera, depth, emitter_side="up")),
                (ValueError, "", lambda: saccade.filter_kinect_v2(camera, depth[:7])),
                (ValueError, "", lambda: saccade.filter_kinect_v2(camera, depth, baseline_m=-1.0))):
            with self.assertRaisesRegex(error, words):
                call()


class Surfels(Folder):
    def test_a_folder_gives_the_surfels_that_the_program_makes_of_it(self):
        path = rendered(self.folder / "frames", 8)
        frames = saccade.open_frames(path)
        options = (("sharpened", {}), ("heaviest", {"exposure_compensation": True}))
        for choice, more in options:
            surfels = saccade.SurfelMap(choice=choice, **more)
            created = sum(surfels.integrate(frames.camera, frame.depth, frame.T_world_camera, frame.color)["created"]
                          for frame in frames)
            self.assertEqual(len(surfels), created)
            ours, theirs, average = (str(self.folder / name) for name in ("ours.ply", "all.ply", "all.average.ply"))
            extra = ["--exposure-compensation", "on"] if more else []
            program("surfels", path, "--out", theirs, "--mode-filter", "both", "--choice", choice, "--min-confidence", 0,
                    *extra)
            for averages, other in ((False, theirs), (True, average)):
                surfels.save(ours, averages=averages)
                self.assertEqual(pathlib.Path(ours).read_bytes(), pathlib.Path(other).read_bytes(), choice)
        points = surfels.points()
        read = saccade.read_cloud(theirs)
        for key in ("points", "normals", "colors", "radii"):
            np.testing.assert_array_equal(points[key], read[key])
        sure = surfels.points(min_confidence=1.5)["confidences"]
        self.assertEqual(len(sure), np.count_nonzero(points["confidences"] >= 1.5))
        self.assertLess(len(sure), len(points["confidences"]))

    def test_a_wall_is_where_it_is_and_noise_is_guided_away(self):
        depth = np.full((120, 160), 1.0, np.float32)
        color = np.full((120, 160, 3), 90, np.uint8)
        surfels = saccade.SurfelMap(mode_filter=False)
        report = surfels.integrate(CAMERA, depth, saccade.look_at((0, 0, 1), (0, 0, 0)), color)
        self.assertEqual(report["created"], len(surfels))
        made = surfels.points()
        np.testing.assert_allclose(made["points"][:, 2], 0.0, atol=1e-6)
        np.testing.assert_allclose(made["normals"][:, 2], 1.0, atol=1e-5)
        self.assertEqual(set(np.unique(made["colors"])), {90})
        noisy = (depth + np.random.default_rng(1).normal(0.0, 0.01, depth.shape)).astype(np.float32)
        smooth = saccade.guided_filter(noisy, depth, color)
        self.assertLess(np.std(smooth), 0.4 * np.std(noisy))
        noisy[3, 3] = 0.0
        self.assertEqual(saccade.guided_filter(noisy, depth, color)[3, 3], 0.0)
        for error, words, call in (
                (ValueError, "sharpened, densest or heaviest", lambda: saccade.SurfelMap(choice="best")),
                (ValueError, "", lambda: saccade.SurfelMap(max_modes=0)),
                (ValueError, "", lambda: surfels.integrate(CAMERA, depth[:9], np.eye(4))),
                (ValueError, "", lambda: surfels.integrate(CAMERA, depth, np.full((4, 4), np.nan))),
                (ValueError, "differ in size", lambda: saccade.guided_filter(depth, depth[:9], color)),
                (ValueError, "", lambda: saccade.guided_filter(depth, depth, color, radius_px=-1)),
                (OSError, "", lambda: surfels.save("/nowhere/at/all.ply"))):
            with self.assertRaisesRegex(error, words):
                call()


if __name__ == "__main__":
    unittest.main()
