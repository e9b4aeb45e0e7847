#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Rooms of the library from Python: hands. What the module says is held against the truth and the program."""
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


if __name__ == "__main__":
    unittest.main()
