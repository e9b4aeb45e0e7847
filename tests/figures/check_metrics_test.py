#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/check_metrics.py agrees with a small exploration, and notices figures that were changed.
Usage: check_metrics_test.py PROGRAM SCRIPT"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SCRIPT = sys.argv[1:3]
SCENE = "clutter:5"


def saccade(*arguments):
    subprocess.run([PROGRAM, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL, timeout=120)


def start(*arguments):
    return subprocess.Popen([sys.executable, "-B", SCRIPT, *map(str, arguments)], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True)


def outcome(process):
    out, err = process.communicate(timeout=240)
    return process.returncode, out, err


class CheckMetrics(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        for views in range(2):
            saccade("explore", SCENE, "--out", cls.folder / f"run-{views}", "--max-views", views, "--min-gain", 5,
                    "--image-size", "128,96", "--voxel-size", 0.02, "--no-pictures", "--quiet")
        saccade("scene", "export", SCENE, "--out", cls.folder / "truth", "--quiet")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_figures(self):
        """Those of a run are right, and where some were changed, exactly those are wrong."""
        run, tampered = self.folder / "run-1", self.folder / "tampered"
        shutil.copytree(run, tampered)
        document = json.loads((run / "run.json").read_text())
        view = document["result"]["views"][0]
        self.assertGreater(document["result"]["final"]["unknown_near_objects"], 0)
        document["result"]["final"]["coverage"] += 0.01
        document["result"]["final"]["accuracy_m"] *= 1.001
        document["result"]["final"]["unknown_near_objects"] += 1
        view["points_at_object"] = not view["points_at_object"]
        (tampered / "run.json").write_text(json.dumps(document))

        good, changed = [start(folder, self.folder / "truth", "--before", self.folder / "run-0")
                         for folder in (run, tampered)]
        status, out, err = outcome(good)
        self.assertEqual((status, err), (0, ""), out)
        for name in ["coverage", "accuracy_m", "chamfer_m", "f_score", "unknown_left", "unknown_near_objects",
                     "points_at_object, last view"]:
            self.assertIn(f"\n{name} ", out)
        status, out, err = outcome(changed)
        self.assertEqual((status, err), (1, ""), out)
        wrong = {line[:34].strip() for line in out.splitlines() if line.endswith("DIFFERS")}
        self.assertEqual(wrong, {"coverage", "coverage, last view", "accuracy_m", "unknown_near_objects",
                                 "unknown_near_objects, last view", "points_at_object, last view"}, out)

    def test_files_that_do_not_belong_together(self):
        other = self.folder / "other"
        saccade("scene", "export", SCENE, "--out", other, "--spacing", 0.02, "--quiet")
        for arguments, part in [([self.folder / "run-1", other], "--spacing 0.004"),
                                ([other, other], "run.json")]:
            status, _, err = outcome(start(*arguments))
            self.assertEqual(status, 2, err)
            self.assertIn(part, err)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
