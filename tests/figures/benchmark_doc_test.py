#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The document of published protocols that scripts/evidence_benchmark.py writes, from made-up tables,
and what it calls of a stand-in for the program.
Usage: benchmark_doc_test.py SCRIPTS"""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(sys.argv[1]).resolve()
sys.path.insert(0, str(SCRIPTS))
import evidence_benchmark  # noqa: E402

TABLE = ("benchmark", "version", "objects_from", "complete", "method", "views", "views_taken", "of_visible", "of_visible_low",
         "of_visible_high", "of_all", "of_all_low", "of_all_high", "objects", "path_m", "motion_s", "published", "year", "source", "object",
         "same_object", "differs")
DIFFERENCES = ("method", "beside", "views", "objects", "of_visible", "of_visible_low", "of_visible_high", "of_visible_excludes_0",
               "of_all", "of_all_low", "of_all_high", "of_all_excludes_0")
CURVES = ("object", "strategy", "seed", "view", "of_visible", "of_all", "views_taken")
SHARES = {"surface": 0.95, "surface-one-shot": 0.9, "projection": 0.85}  # after twelve views; after ten 2 points less
PUBLISHED = (("Early", 1, 0.99, "book"), ("Network", 12.2, 0.93, "survey"), ("Gains", 20, 0.92, "survey"), ("Old", 10, 0.8, "book"))


class BenchmarkDocument(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def write(self, name, columns, rows):
        (self.folder / name).parent.mkdir(exist_ok=True)
        with (self.folder / name).open("w", newline="") as file:
            table = csv.DictWriter(file, columns, restval="")
            table.writeheader()
            table.writerows(rows)

    def write_protocol(self, name="benchmark_one-shot", loss=0.0, seeds=3, complete="yes", objects_from="stand-ins", same_object="no", objects=2):
        """A campaign of one object from two first views; its table says that there are more.

        @param loss  how much each strategy of ours has less"""
        about = {"benchmark": "made-up", "version": 2, "objects_from": objects_from, "complete": complete}
        rows, curves, runs = [], [], []
        for strategy, share in SHARES.items():
            for views, of_all in ((10, share - 0.02 - loss), (12, share - loss)):
                rows.append({**about, "method": strategy, "views": views, "views_taken": views - 0.5, "of_visible": of_all + 0.01,
                             "of_all": of_all, "of_all_low": of_all - 0.005, "of_all_high": of_all + 0.005, "objects": objects})
            for scene in ("jug@4", "jug@12"):
                for seed in range(1, seeds + 1):
                    runs.append({"scene": scene, "strategy": strategy, "seed": seed, "views": 0 if strategy == "projection" else 11})
                    curves += [{"object": scene, "strategy": strategy, "seed": seed, "view": view,
                                "of_all": min(share, 0.1 * view) - loss} for view in range(1, 13)]
        rows += [{**about, "method": method, "views": views, "published": share, "source": source, "object": "a hand", "same_object": same_object,
                  "differs": f"all of the {source}"} for method, views, share, source in PUBLISHED]
        gaps = [{"method": "surface", "beside": other, "views": 12, "of_visible": 0.05, "of_visible_low": 0.04,
                 "of_visible_excludes_0": "yes", "of_all": -0.0001, "of_all_low": -0.02, "of_all_excludes_0": "no"}
                for other in list(SHARES)[1:]]
        for file, columns, content in (("table", TABLE, rows), ("differences", DIFFERENCES, gaps), ("curves", CURVES, curves),
                                       ("runs", ("scene", "strategy", "seed", "views"), runs)):
            self.write(f"{name}/{file}.csv", columns, content)

    def document(self, program=None):
        """Exit status, and the text; nothing runs without a program."""
        document = self.folder / "document.md"
        data = self.folder / "data"
        command = [SCRIPTS / "evidence_benchmark.py", program or "no-program", self.folder, document, *([] if program else ["table"])]
        environment = {**os.environ, "SACCADE_DATA": str(data), "STANFORD": str(self.folder / "stanford"), "SACCADE_BENCHMARK_SEEDS": "3", "SACCADE_SLURM": "off"}
        done = subprocess.run(command, check=False, env=environment, stdout=subprocess.DEVNULL)
        text = document.read_text()
        self.assertNotIn(str(self.folder), text)
        return done.returncode, text

    def test_all_strategies_stand_beside_all_published_figures(self):
        self.write_protocol()
        status, text = self.document()
        self.assertEqual(status, 3, text)
        self.assertIn("saccade benchmark one-shot --seeds 1-3 --out DIR", text)
        self.assertIn("Objects: jug; stand-ins, made by rule", text)
        self.assertIn("18 runs.", text)
        for row in ("| `surface` | ours | 93.0 ± 0.5 | 95.0 ± 0.5 | 96.0 | 11.5 | this run |",
                    "| `projection` | baseline | 83.0 ± 0.5 | 85.0 ± 0.5 | 86.0 | 11.5 | this run |",
                    "| Network | published |  | 93.0 (12.2 views) | | | [2] |", "| Gains | published |  | 92.0 (20 views) | | | [2] |",
                    "| Old | published | 80.0 |  | | | [1] |", "| `projection` | **+5.0 ± 1.0** | 0.0 ± 2.0 |"):
            self.assertIn(row, text)
        self.assertEqual(text.count("say only that no view after the first had any gain for it"), 1)
        self.assertIn("Differences beside `projection` say only", text)
        self.assertIn("[2] survey. Network: a hand; Gains: a hand. What differs here: all of the survey.", text)

    def test_ours_met_or_missed_the_published_figures(self):
        self.write_protocol()
        text = self.document()[1]
        self.assertIn("- met: `surface` after 12 views: 95.0 ± 0.5 % of all; Network: 93.0 % after 12.2 views (other objects); "
                      "reached after 10 views", text)
        self.assertIn("- **missed**: `surface-one-shot` after 12 views: 90.0 ± 0.5 % of all; Network: 93.0 % after 12.2 views "
                      "(other objects); short by 3.0 points\n", text)
        self.assertEqual((text.count("- met: "), text.count("- **missed**: ")), (4, 2))
        self.assertNotIn("Early: 99.0 % after", text)  # the first view is given
        self.assertNotIn("`projection` after", text)

    def test_a_miss_of_the_first_strategy_fails(self):
        self.write_protocol(loss=0.025, objects_from="published", same_object="yes")
        status, text = self.document()
        self.assertEqual(status, 1, text)
        self.assertIn("- **missed**: `surface` after 12 views: 92.5 ± 0.5 % of all; Network: 93.0 % after 12.2 views; short by 0.5 points",
                      text)
        self.assertNotIn("(other objects)", text)

    def test_fewer_seeds_or_runs_are_said(self):
        self.write_protocol(seeds=1)
        self.write_protocol("benchmark_household", complete="no")
        self.write_protocol("benchmark_view-sphere", complete="no", objects=1)
        status, text = self.document()
        self.assertEqual(status, 3, text)
        self.assertIn("saccade benchmark one-shot --seeds 1 --out DIR", text)
        self.assertIn("6 runs; 1 of 3 seeds so far.", text)
        self.assertIn("18 runs; runs are missing", text)
        self.assertIn("--out DIR\n```\n\n18 runs so far: too few for figures.\n", text)
        self.assertEqual((text.count("- met so far: "), text.count("- **missed so far**: ")), (8, 4))

    def test_protocols_that_were_not_run_are_said(self):
        self.write("benchmark_view-sphere.json", ("none",), [])
        (self.folder / "benchmark_view-sphere.json").write_text(json.dumps({"result": {"benchmark": {}}}))
        status, text = self.document()
        self.assertEqual(status, 3, text)
        self.assertEqual(text.count("Not run yet."), 4)
        self.assertEqual(text.count(" was not there."), len(evidence_benchmark.CAMPAIGNS) - 4)
        self.assertIn("## `one-shot`\n\n```sh\nsaccade benchmark one-shot --seeds 1-3 --out DIR\n```\n\nNot run yet.", text)
        self.assertIn("Not run yet: `$SACCADE_DATA/meshes_ycb` was not there.", text)
        self.assertIn("Not run yet: `$STANFORD/armadillo.off` was not there.", text)

    def test_every_protocol_that_can_run_is_run(self):
        for ending, expected in (("exit 0", 3), ("exit 1", 2)):
            program = self.folder / "saccade"
            program.write_text(f'#!/bin/sh\necho "$*" >>"{self.folder}/calls"\n{ending}\n')
            program.chmod(0o755)
            for folder in ("data/meshes_ycb", "stanford"):
                (self.folder / folder).mkdir(parents=True, exist_ok=True)
            (self.folder / "stanford/armadillo.off").touch()
            (self.folder / "calls").unlink(missing_ok=True)
            self.assertEqual(self.document(program)[0], expected)
            calls = (self.folder / "calls").read_text().splitlines()
            self.assertEqual([call.split()[2] for call in calls], ["view-sphere", "one-shot", "tabletop-arm", "household", "household",
                                                                  "view-sphere", "view-sphere", "one-shot"])
            self.assertIn(f"--objects {self.folder}/data/meshes_ycb --seeds 1-3 --out {self.folder}/benchmark_ycb", calls[4])
            self.assertIn(f"--objects {self.folder}/stanford --only armadillo --seeds 1-3", calls[5])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
