#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The Python module: arrays in and out, exceptions for what is wrong, gains and runs, threads and callbacks."""
import threading
import unittest

import numpy as np

import saccade

CAMERA = saccade.PinholeCamera(64, 48, fx=52.5, fy=52.5)
ABOVE = saccade.look_at((0.0, 0.0, 1.0), (0.0, 0.0, 0.0))
WALL = np.full((48, 64), 1.0, np.float32)


def small_map():
    return saccade.TsdfMap(voxel_size_m=0.02, workspace=((-0.4, -0.4, -0.1), (0.4, 0.4, 0.4)), threads=1)


class Maps(unittest.TestCase):
    def test_unknown_empty_and_occupied_are_kept_apart(self):
        m = small_map()
        self.assertEqual(set(np.unique(m.ternary())), {0})
        stats = m.integrate(CAMERA, WALL, ABOVE)
        self.assertEqual(stats["valid_pixels"], 64 * 48)
        states, weights = m.ternary(), m.weights()
        self.assertEqual((states.shape, states.dtype, states.flags.c_contiguous), ((25, 40, 40), np.int8, True))
        self.assertTrue(np.array_equal(states == 0, weights == 0))
        np.testing.assert_array_equal(states == 1, (weights > 0) & (m.tsdf() <= 0))
        np.testing.assert_allclose(m.origin(), (-0.39, -0.39, -0.09))
        x, y, z = 20, 20, 10  # above the wall, in sight
        self.assertEqual(states[z, y, x], -1)
        self.assertEqual(m.count_unknown(((-0.4, -0.4, -0.1), (0.4, 0.4, 0.4))), np.count_nonzero(states == 0))
        m.forget(saccade.Sphere((0.0, 0.0, 0.1), 0.05))
        self.assertEqual(m.ternary()[z, y, x], 0)

    def test_strides_and_types_give_one_map(self):
        slanted = np.linspace(0.8, 1.2, 48 * 64, dtype=np.float32).reshape(48, 64)
        millimetres = np.round(slanted * 1000).astype(np.uint16)
        as_float = (millimetres * np.float32(1e-3)).astype(np.float32)
        wide = np.zeros((96, 128), np.float32)
        wide[::2, ::2] = as_float
        for depth in (millimetres, wide[::2, ::2], np.asfortranarray(as_float), as_float.astype(np.float64)):
            a, b = small_map(), small_map()
            a.integrate(CAMERA, as_float, ABOVE)
            b.integrate(CAMERA, depth, ABOVE[:3])
            np.testing.assert_array_equal(a.tsdf(), b.tsdf())

    def test_a_mesh_lies_on_the_wall_and_a_file_gives_the_map_back(self):
        import tempfile
        m = small_map()
        m.integrate(CAMERA, WALL, ABOVE, np.full((48, 64, 3), 200, np.uint8))
        mesh = m.mesh()
        self.assertGreater(len(mesh["triangles"]), 100)
        self.assertLess(np.abs(mesh["vertices"][:, 2]).max(), 0.02)
        self.assertEqual(mesh["colors"].shape, mesh["vertices"].shape)
        with tempfile.TemporaryDirectory() as folder:
            m.save(folder + "/m.sacmap")
            np.testing.assert_array_equal(saccade.TsdfMap.load(folder + "/m.sacmap").ternary(), m.ternary())

    def test_what_is_wrong_is_an_exception(self):
        m = small_map()
        nan = np.full((4, 4), np.nan)
        for error, words, call in (
                (ValueError, "10x48|64x10", lambda: m.integrate(CAMERA, WALL[:10], ABOVE)),
                (ValueError, "empty", lambda: m.integrate(CAMERA, WALL[:0], ABOVE)),
                (ValueError, "H x W", lambda: m.integrate(CAMERA, WALL[0], ABOVE)),
                (TypeError, "int64", lambda: m.integrate(CAMERA, WALL.astype(np.int64), ABOVE)),
                (ValueError, "3 x 3", lambda: m.integrate(CAMERA, WALL, np.eye(3))),
                (ValueError, "", lambda: m.integrate(CAMERA, WALL, nan)),
                (ValueError, "", lambda: m.integrate(CAMERA, WALL, 2.0 * np.eye(4))),
                (ValueError, "4 billion", lambda: m.ternary(((-1e9, -1e9, -1e9), (1e9, 1e9, 1e9)))),
                (ValueError, "4 billion", lambda: m.count_unknown(((-1e9, -1e9, -1e9), (1e9, 1e9, 1e9)))),
                (ValueError, "one pixel", lambda: CAMERA.scaled_to_width(0)),
                (ValueError, "one pixel", lambda: saccade.trial.run("tabletop-1", width=0)),
                (ValueError, "corners", lambda: m.forget((1.0, 2.0, 3.0))),
                (FileNotFoundError, "no such", lambda: saccade.TsdfMap.load("/nowhere.sacmap")),
                (ValueError, "", lambda: saccade.TsdfMap(voxel_size_m=-1.0)),
                (ValueError, "rays or voxels", lambda: saccade.view_gains(m, ((0, 0, 0), (1, 1, 1)), [], CAMERA, count="x"))):
            with self.assertRaisesRegex(error, words):
                call()
        m.close()
        with self.assertRaisesRegex(ValueError, "closed"):
            m.ternary()

    def test_threads_that_read_do_not_stop_one_that_writes(self):
        m = saccade.TsdfMap(voxel_size_m=0.01, workspace=((-0.5, -0.5, 0.0), (0.5, 0.5, 0.6)))
        camera = saccade.PinholeCamera(160, 120, fx=131.25, fy=131.25, min_range_m=0.3, max_range_m=2.0)
        depth = np.full((120, 160), 0.8, np.float32)
        depth[40:80, 53:106] = 0.6
        pose = saccade.look_at((0, 0, 0.8), (0, 0, 0))
        region = saccade.Sphere((0, 0, 0.3), 0.2)
        poses = saccade.view_sphere((0, 0, 0.3))[:50]
        bodies = [lambda: m.integrate(camera, depth, pose), lambda: saccade.view_gains(m, region, poses, camera),
                  m.ternary]
        threads = [threading.Thread(target=lambda body=body: [body() for _ in range(300)], daemon=True) for body in bodies]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(60)
            self.assertFalse(thread.is_alive())

    def test_numbers_out_of_range_are_said(self):
        camera = saccade.PinholeCamera(160, 120, fx=131.25, fy=131.25)
        m = saccade.TsdfMap(voxel_size_m=0.02, workspace=((-0.5, -0.5, 0.0), (0.5, 0.5, 0.6)))
        for wrong in (lambda: saccade.TsdfMap(voxel_size_m=0.01, free_weight=65541), lambda: m.mesh(65537),
                      lambda: m.mesh(-1), lambda: camera.scaled_to_width(1000000), lambda: camera.scaled_to_width(0),
                      lambda: saccade.look_at((0, 0, 0), (0, 0, 0)), lambda: saccade.look_at((0, 0, np.inf), (0, 0, 0)),
                      lambda: saccade.ViewPlanner(camera, regions=[saccade.Sphere((0, 0, 0), 0.2)]).next_views(m, 1),
                      lambda: saccade.ViewPlanner(camera, "sphere", regions=[saccade.Sphere((0, 0, 0), -1)]).next_views(m, 1),
                      lambda: saccade.ViewPlanner(camera, min_gain=-1.0)):
            with self.assertRaises(ValueError):
                wrong()

    def test_two_threads_write_one_after_the_other(self):
        m = small_map()

        def fuse():
            for _ in range(10):
                m.integrate(CAMERA, WALL, ABOVE)
                m.ternary()

        threads = [threading.Thread(target=fuse) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(m.weights().max(), 20)


class Views(unittest.TestCase):
    def test_gains_are_of_views_that_look_at_unknown_space(self):
        m = small_map()
        m.integrate(CAMERA, WALL, ABOVE)
        poses = saccade.view_sphere((0.0, 0.0, 0.0), roll_step_deg=90.0)
        self.assertEqual(poses.shape, (480, 4, 4))
        m.free(saccade.Box((-2, -2, -2), (2, 2, 2)))
        m.forget(saccade.Sphere((0.0, 0.0, 0.1), 0.08))
        told = []
        gains = saccade.view_gains(m, saccade.Sphere((0.0, 0.0, 0.1), 0.2), poses, CAMERA,
                                   progress=lambda *state: told.append(state))
        self.assertEqual((gains.dtype, gains.shape), (np.uint64, (480,)))
        self.assertGreater(gains.min(), 0)
        self.assertTrue(told)

        def stop(*_):
            raise KeyError("enough")
        with self.assertRaisesRegex(KeyError, "enough"):
            saccade.view_gains(m, saccade.Sphere((0.0, 0.0, 0.1), 0.2), poses, CAMERA, progress=stop)


class Runs(unittest.TestCase):
    SMALL = {"max_views": 1, "width": 96, "gain_width": 64, "voxel_size_m": 0.02, "threads": 1}

    def test_a_gain_of_ones_own_chooses_the_views(self):
        asked = []

        def gain(context, poses):
            asked.append((len(poses), context.sensor.width, context.map.voxel_size_m))
            return saccade.view_gains(context.map, context.region, poses, context.sensor)

        run = saccade.trial.run("tabletop-1", "sphere", gain=gain, **self.SMALL)
        self.assertEqual(len(run["views"]), 1)
        self.assertEqual(asked[0][1:], (64, 0.02))
        self.assertGreater(run["final"]["coverage"], run["scan"]["coverage"])

    def test_what_a_gain_raises_comes_back(self):
        def broken(context, poses):
            raise LookupError("mine")
        with self.assertRaisesRegex(LookupError, "mine"):
            saccade.trial.run("tabletop-1", "sphere", gain=broken, **self.SMALL)
        with self.assertRaisesRegex(ValueError, "one number for each"):
            saccade.trial.run("tabletop-1", "sphere", gain=lambda context, poses: [1.0], **self.SMALL)
        with self.assertRaisesRegex(ValueError, "no strategy"):
            saccade.trial.run("tabletop-1", "nothing", **self.SMALL)


if __name__ == "__main__":
    unittest.main()
