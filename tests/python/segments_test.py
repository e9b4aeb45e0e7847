#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Segments, saliency and annotation of clouds from Python, against the truth and against the program."""
import json
import pathlib
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import saccade


def program(*arguments):
    """Runs the program, and returns the result that it writes as JSON."""
    run = subprocess.run([sys.executable, "-m", "saccade", "--json", "-", "--quiet", *map(str, arguments)],
                         stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=True)
    return json.loads(run.stdout)["result"]


def scene():
    """A red table, z = 0, with a green box and a blue ball on it: points, colours, labels 1, 2, 3."""
    random = np.random.default_rng(5)
    table = np.column_stack([random.uniform(-0.4, 0.4, (20000, 2)), np.zeros(20000)])
    sides = random.uniform(-0.1, 0.1, (9000, 3)) + (-0.2, 0.0, 0.1)
    sides[:3000, 2] = 0.2
    sides[3000:6000, 0] = np.where(np.arange(3000) % 2, -0.3, -0.1)
    sides[6000:, 1] = np.where(np.arange(3000) % 2, -0.1, 0.1)
    ball = random.normal(size=(8000, 3))
    ball = 0.12 * ball / np.linalg.norm(ball, axis=1, keepdims=True) + (0.2, 0.0, 0.1)
    ball = ball[ball[:, 2] > 0.0]
    table = table[(np.abs(table[:, 0] + 0.2) > 0.1) | (np.abs(table[:, 1]) > 0.1)]
    table = table[np.hypot(table[:, 0] - 0.2, table[:, 1]) > 0.066]
    parts = [table, sides, ball]
    points = np.vstack(parts).astype(np.float32)
    labels = np.repeat([1, 2, 3], [len(part) for part in parts])
    colors = np.array([(0, 0, 0), (200, 40, 30), (30, 180, 60), (40, 60, 200)], np.uint8)[labels]
    return points, colors, labels


POINTS, COLORS, TRUTH = scene()


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class Segments(Folder):
    def test_methods_say_what_the_program_says_and_find_the_objects(self):
        file = self.folder / "cloud.ply"
        saccade.write_cloud(str(file), POINTS, colors=COLORS, labels=TRUTH)
        for method, least in (("lccp", 0.8), ("sv-lccp", 0.8), ("flood-fill", 0.5)):
            labels = saccade.segment(POINTS, method, colors=COLORS, viewpoint=(0, 0, 2))
            self.assertEqual((labels.dtype, labels.shape), (np.uint32, (len(POINTS),)))
            self.assertEqual(labels.min(), 1)
            out = self.folder / f"{method}.ply"
            said = program("segment", file, "--method", method, "--viewpoint", "0,0,2", "--out", out)
            np.testing.assert_array_equal(labels, saccade.read_cloud(str(out))["labels"])
            self.assertEqual(labels.max(), len(said["segments"]) if method != "flood-fill" else labels.max())
            scores = saccade.segment_scores(labels, TRUTH, points=POINTS)
            theirs = program("score", out, file)
            for ours, name in (("weighted_overlap", "wov"), ("over_segmentation", "fos"), ("under_segmentation", "fus"),
                               ("consistency_error", "bce"), ("boundary_f", "boundary_f"),
                               ("boundary_precision", "boundary_precision")):
                self.assertEqual(scores[ours], theirs[name], name)
            self.assertGreater(scores["weighted_overlap"], least)
            self.assertEqual(scores["objects"], 3)

    def test_doubles_far_from_the_origin_keep_their_places(self):
        place = np.array((461200.0, 5263500.0, 500.0))
        far = POINTS.astype(np.float64) + place
        near = saccade.segment(POINTS, "lccp", colors=COLORS, viewpoint=(0, 0, 2))
        labels = saccade.segment(far, "lccp", colors=COLORS, viewpoint=place + (0, 0, 2))
        self.assertGreater(np.mean(labels == near), 0.99)  # doubles there differ by a billionth of a metre
        scores = saccade.segment_scores(labels, TRUTH, points=far)
        self.assertGreater(scores["weighted_overlap"], 0.8)
        self.assertEqual(len(np.unique(saccade.segment_saliency(far, labels) >= 0)), 1)

    def test_scores_of_what_is_right_and_of_what_is_one(self):
        right = saccade.segment_scores(TRUTH, TRUTH, points=POINTS)
        self.assertEqual((right["weighted_overlap"], right["over_segmentation"], right["under_segmentation"]), (1, 0, 0))
        self.assertEqual((right["consistency_error"], right["boundary_f"]), (0.0, 1.0))
        one = saccade.segment_scores(np.ones_like(TRUTH), TRUTH)
        shares = np.bincount(TRUTH)[1:] / len(TRUTH)
        self.assertAlmostEqual(one["weighted_overlap"], (shares**2).sum())
        self.assertIsNone(one["boundary_f"])

    def test_a_curve_is_that_of_the_program(self):
        file, thresholds = self.folder / "cloud.ply", (0.02, 0.1, 0.4)
        saccade.write_cloud(str(file), POINTS, colors=COLORS, labels=TRUTH)
        stages = []
        for method in ("sv-lccp", "flood-fill"):
            curve = saccade.segment_curve(POINTS, TRUTH, thresholds, method, colors=COLORS,
                                          progress=lambda stage, done, total: stages.append((stage, done, total)))
            theirs = program("segment", file, "--method", method, "--curve", file, "--thresholds",
                             ",".join(map(str, thresholds)))["curve"]
            self.assertEqual([point["threshold"] for point in curve["points"]], list(thresholds))
            for name, key in (("segments", "segments"), ("boundary_precision", "boundary_precision"),
                              ("boundary_recall", "boundary_recall"), ("boundary_f", "boundary_f"),
                              ("consistency_error", "bce")):
                self.assertEqual([point[name] for point in curve["points"]], [point[key] for point in theirs["points"]])
            self.assertEqual(curve["area"], theirs["area"])
            self.assertEqual(curve["best_f"]["threshold"], theirs["best_f"]["threshold"])
        self.assertTrue(stages)

    def test_saliency_is_that_of_the_program(self):
        file = self.folder / "cloud.ply"
        saccade.write_cloud(str(file), POINTS)
        said = program("segment", file, "--viewpoint", "0,0,2")["segments"]
        labels = saccade.segment(POINTS, viewpoint=(0, 0, 2))
        saliency = saccade.segment_saliency(POINTS, labels)
        self.assertEqual([entry["saliency"] for entry in said], saliency[[entry["id"] - 1 for entry in said]].tolist())
        ball, table = (np.bincount(labels[TRUTH == label]).argmax() for label in (3, 1))
        self.assertGreater(saliency[ball - 1], 5 * saliency[table - 1])

    def test_a_depth_image_and_a_map(self):
        camera = saccade.PinholeCamera(160, 120, fx=131.25, fy=131.25)
        depth = np.full((120, 160), 1.5, np.float32)
        depth[40:80, 60:100] = 1.2
        depth[0, 0] = 0.0
        points = saccade.depth_points(camera, depth)
        self.assertEqual((points.shape, points.dtype), ((120, 160, 3), np.float32))
        self.assertTrue(np.isnan(points[0, 0]).all())
        np.testing.assert_allclose(points[7, 9], ((9 - camera.cx) / camera.fx * 1.5, (7 - camera.cy) / camera.fy * 1.5, 1.5),
                                   rtol=1e-6)
        labels = saccade.segment(points.reshape(-1, 3), single_camera=True).reshape(depth.shape)
        self.assertEqual(labels[0, 0], 0)
        self.assertNotEqual(labels[60, 80], labels[60, 20])
        pose = saccade.look_at((0, 0, 1.5), (0, 0, 0))
        in_world = saccade.depth_points(camera, depth, pose)
        np.testing.assert_allclose(in_world[60, 20, 2], 0.0, atol=1e-6)
        m = saccade.TsdfMap(voxel_size_m=0.01, threads=1)
        m.integrate(camera, depth, pose)
        surface = saccade.segment_map(m)
        high = surface["labels"][surface["points"][:, 2] > 0.28]
        low = surface["labels"][surface["points"][:, 2] < 0.02]
        self.assertNotEqual(np.bincount(high).argmax(), np.bincount(low).argmax())
        self.assertEqual(surface["normals"].shape, surface["points"].shape)

    def test_what_is_wrong_is_an_exception(self):
        camera = saccade.PinholeCamera(64, 48, fx=52.5, fy=52.5)
        self.assertEqual(len(saccade.segment(np.zeros((0, 3)))), 0)
        self.assertEqual(saccade.segment(np.full((5, 3), np.nan)).tolist(), [0] * 5)
        for error, words, call in (
                (ValueError, "lccp, sv-lccp or flood-fill", lambda: saccade.segment(POINTS, "snake")),
                (ValueError, "threshold has no meaning", lambda: saccade.segment(POINTS, threshold=0.1)),
                (ValueError, "rounds has no meaning", lambda: saccade.segment(POINTS, "flood-fill", rounds=2)),
                (ValueError, "", lambda: saccade.segment(POINTS, voxel_size_m=-1.0)),
                (ValueError, "", lambda: saccade.segment(POINTS, colors=COLORS[:5])),
                (TypeError, "uint8", lambda: saccade.segment(POINTS, colors=COLORS.astype(np.int32))),
                (ValueError, "", lambda: saccade.segment_scores(TRUTH, TRUTH[:9])),
                (ValueError, "has no threshold", lambda: saccade.segment_curve(POINTS, TRUTH, [0.1], "lccp")),
                (ValueError, "", lambda: saccade.segment_curve(POINTS, TRUTH[:9], [0.1])),
                (ValueError, "gaps", lambda: saccade.segment_saliency(POINTS[:3], [1, 2, 99])),
                (ValueError, "objectness", lambda: saccade.segment_saliency(POINTS, TRUTH, "beauty")),
                (ValueError, "size", lambda: saccade.depth_points(camera, np.ones((5, 5), np.float32)))):
            with self.assertRaisesRegex(error, words):
                call()


class Annotations(unittest.TestCase):
    def clicks(self):
        return [np.flatnonzero(TRUTH == label)[np.abs(POINTS[TRUTH == label] - place).sum(axis=1).argmin()]
                for label, place in ((1, (0.0, 0.3, 0.0)), (2, (-0.2, 0.0, 0.2)), (3, (0.2, 0.0, 0.22)))]

    def test_labels_spread_from_clicks(self):
        annotation = saccade.Annotation(POINTS, colors=COLORS)
        self.assertEqual(annotation.labels().tolist(), [0] * len(POINTS))
        table, box, ball = self.clicks()
        self.assertEqual(annotation.click(table, 1), len(POINTS))
        annotation.click(int(box), 2)
        before = annotation.labels()
        changed = annotation.click([ball], 3)
        self.assertEqual(changed, np.count_nonzero(annotation.labels() != before))
        score = saccade.annotation_score(annotation.labels(), TRUTH)
        self.assertEqual(score["points"], len(TRUTH))
        self.assertEqual(score["wrong"], np.count_nonzero(annotation.labels() != TRUTH))
        self.assertLess(score["wrong"], 0.03 * len(TRUTH))
        self.assertEqual(annotation.control_points, {table: 1, box: 2, ball: 3})
        self.assertEqual(sum(annotation.counts.values()), len(POINTS))
        self.assertEqual(annotation.undo(), changed)
        np.testing.assert_array_equal(annotation.labels(), before)
        self.assertEqual(annotation.redo(), changed)
        self.assertEqual(annotation.redo(), -1)
        self.assertEqual(annotation.paint([7, 8], 9), 2)
        self.assertEqual(annotation.labels()[[7, 8]].tolist(), [9, 9])
        annotation.remove(box)
        self.assertNotIn(2, annotation.counts)

    def test_shapes_in_a_picture_take_what_is_seen_in_them(self):
        annotation = saccade.Annotation(POINTS)
        camera = saccade.PinholeCamera(320, 240, fx=262.5, fy=262.5)
        pose = saccade.look_at((0.0, 0.0, 1.2), (0.0, 0.0, 0.0))
        in_camera = (POINTS - pose[:3, 3]) @ pose[:3, :3]
        pixels = in_camera[:, :2] / in_camera[:, 2:] * (camera.fx, camera.fy) + (camera.cx, camera.cy)
        corners = ((60.0, 70.0), (140.0, 170.0))
        inside = np.flatnonzero(((pixels + 0.5 >= corners[0]) & (pixels + 0.5 < corners[1])).all(axis=1))
        deep = annotation.select(camera, pose, rectangle=corners, below_m=np.inf)
        # A point is in the rectangle where its pixel is: those within a pixel of the border may go either way.
        self.assertLess(len(np.setxor1d(deep, inside)), 0.03 * len(inside))
        u0, v0, u1, v1 = (*corners[0], *corners[1])
        lasso = annotation.select(camera, pose, polygon=((u0, v0), (u1, v0), (u1, v1), (u0, v1)), below_m=np.inf)
        np.testing.assert_array_equal(lasso, deep)
        seen = annotation.select(camera, pose, rectangle=corners, below_m=0.01)
        self.assertLess(len(seen), len(deep))                    # the sides of the box are below its top
        self.assertTrue(set(seen) <= set(deep))
        stroke = annotation.select(camera, pose, stroke=((65, 120), (135, 120)), radius_px=3, below_m=np.inf)
        self.assertTrue(np.all(np.abs(pixels[stroke, 1] - 120) < 4.5))
        self.assertEqual(annotation.paint(seen, 5), len(seen))
        np.testing.assert_array_equal(np.flatnonzero(annotation.labels() == 5), seen)
        for words, shape in (("one of rectangle", {}), ("two opposite", {"rectangle": ((1, 2),)}),
                             ("pixels .u, v.", {"stroke": ((1, 2, 3),)}), ("", {"polygon": ((1, 2), (3, 4))}),
                             ("", {"rectangle": corners, "below_m": -1.0})):
            with self.assertRaisesRegex(ValueError, words):
                annotation.select(camera, pose, **shape)

    def test_a_simulated_annotator_gets_better(self):
        clicks = saccade.simulate_annotation(POINTS, TRUTH, colors=COLORS, clicks=8)
        self.assertEqual({click["label"] for click in clicks[:3]}, {1, 2, 3})
        self.assertLess(clicks[-1]["wrong"], 0.02 * len(TRUTH))
        again = saccade.Annotation(POINTS, colors=COLORS)
        for click in clicks:
            again.click(click["point"], click["label"])
        self.assertEqual(saccade.annotation_score(again.labels(), TRUTH)["wrong"], clicks[-1]["wrong"])

    def test_two_threads_click_one_after_the_other(self):
        annotation = saccade.Annotation(POINTS[::4])

        def click(start):
            for point in range(start, start + 40, 2):
                annotation.click(point, point + 1)
                annotation.labels()

        threads = [threading.Thread(target=click, args=(start,)) for start in (0, 1)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(annotation.control_points, {point: point + 1 for point in range(40)})

    def test_what_is_wrong_is_an_exception(self):
        annotation = saccade.Annotation(POINTS[::8])

        def stop(*_):
            raise KeyError("enough")
        for error, words, call in (
                (ValueError, "empty", lambda: saccade.Annotation(np.zeros((0, 3)))),
                (ValueError, "", lambda: saccade.Annotation(POINTS, neighbours=0)),
                (KeyError, "enough", lambda: saccade.Annotation(POINTS, progress=stop)),
                (ValueError, "", lambda: annotation.click(10**6, 1)),
                (ValueError, "indices", lambda: annotation.click(-1, 1)),
                (ValueError, "", lambda: annotation.click(3, 0)),
                (ValueError, "", lambda: annotation.remove(3)),
                (ValueError, "", lambda: saccade.simulate_annotation(POINTS, TRUTH[:5])),
                (ValueError, "", lambda: saccade.annotation_score(TRUTH, TRUTH[:5]))):
            with self.assertRaisesRegex(error, words):
                call()


if __name__ == "__main__":
    unittest.main()
