#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The scripts of `make evidence`: their statistics, the document of the headline figures from made-up campaigns, and campaigns
on a cluster that fails; the program, sinfo, squeue and sbatch are stand-ins.
Usage: evidence_test.py SCRIPTS"""
import csv
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(sys.argv[1]).resolve()
sys.path.insert(0, str(SCRIPTS))
import evidence_campaign  # noqa: E402
import evidence_headline  # noqa: E402
import evidence_planner  # noqa: E402

RUNS = ("scene", "scene_hash", "strategy", "noise", "seed", "initial_coverage", "coverage", "coverage_area", "unknown_near_objects", "views",
        "program_version", "settings")
VIEWS = ("scene", "scene_hash", "strategy", "noise", "seed", "number", "gain", "gain_observed", "coverage")
STAND_IN = """#!/bin/sh
folder=$(dirname "$0")
echo "$*" >>"$folder/calls"
case " $* " in
  *" --status "*) cat "$folder/status.json" ;;
  *" --slurm "*) printf 'array     job 12: 3 runs in 3 slices\\nmerge     job 13, when it has ended\\n' ;;
esac
"""


def settings_of(strategy, revision=3):
    own = {"surface": {"least_share": 0.005}, "attention": {"rival_share": 0.5}}
    return {"robot": "free", "revision": revision, **own.get(strategy, {})}


def write_tables(campaign, worst="attention", scenes=range(201, 301), seeds=(1,), settings=settings_of, version="0.2.0", hashes="e8{}"):
    """Tables of a campaign, in which strategy `worst` has the least of everything."""
    campaign.mkdir(parents=True, exist_ok=True)
    with (campaign / "runs.csv").open("w") as runs, (campaign / "views.csv").open("w") as views:
        runs, views = csv.DictWriter(runs, RUNS), csv.DictWriter(views, VIEWS)
        runs.writeheader()
        views.writeheader()
        for seed, scene in ((seed, scene) for seed in seeds for scene in scenes):
            chance = random.Random(1000 * seed + scene)
            level = chance.uniform(0.8, 0.9)
            for strategy in evidence_headline.STRATEGIES:
                loss = 0.2 if strategy == worst else 0.0 if strategy == "oracle" else 0.001 if strategy == "surface" else 0.05
                area = level - loss + chance.uniform(0, 0.001)
                key = {"scene": f"clutter:{scene}", "scene_hash": hashes.format(scene), "strategy": strategy, "noise": "kinect-v1", "seed": seed}
                runs.writerow({**key, "initial_coverage": 0.3, "coverage": area + 0.1, "coverage_area": area, "views": 1,
                               "unknown_near_objects": 1000 * (2 - level), "program_version": version,
                               "settings": json.dumps(settings(strategy))})
                views.writerow({**key, "number": 0, "coverage": 0.3})
                views.writerow({**key, "number": 1, "gain": 100 * level, "gain_observed": 80 * level, "coverage": area + 0.1})


class Statistics(unittest.TestCase):
    def test_quantiles_of_t(self):
        tabled = {1: 12.7062, 2: 4.3027, 3: 3.1824, 4: 2.7764, 5: 2.5706, 9: 2.2622, 10: 2.2281, 14: 2.1448, 29: 2.0452, 49: 2.0096,
                  98: 1.9845, 99: 1.9842, 120: 1.9799, 1000: 1.9623}
        for degrees, value in tabled.items():
            self.assertAlmostEqual(evidence_planner.student_t(degrees), value, delta=1e-4, msg=degrees)

    def test_views_that_promised_nothing_are_left_out(self):
        pairs = [(4.0, 2.0), (3.0, 3.0), (2.0, 1.0), (1.0, 0.5)]
        correlation, kept = evidence_planner.calibration(pairs)
        self.assertAlmostEqual(correlation, 0.8)  # 1 - 6 (1 + 1) / (4 * 15)
        self.assertEqual(kept, 0.5)
        self.assertEqual(evidence_planner.calibration([*pairs, (0.0, 9.0), (-1.0, 5.0), (2.0, math.nan)]), (correlation, kept))
        self.assertTrue(all(map(math.isnan, evidence_planner.calibration([(1.0, 1.0), (2.0, 1.0), (0.0, 0.0)]))))

    def test_views_that_are_all_alike_have_no_order(self):
        correlation, kept = evidence_planner.calibration([(2.0, 1.0)] * 3)
        self.assertTrue(math.isnan(correlation))
        self.assertEqual(kept, 0.5)

    def test_intervals_of_ratios_hold_the_true_one(self):
        chance, held, times = random.Random(1), 0, 400
        for _ in range(times):
            runs = []
            for scene in range(40):
                common = chance.gauss(100, 20)  # the true ratio: 130 / 100
                runs += [{"scene": scene, "strategy": "a", "figure": str(1.3 * common + chance.gauss(0, 10))},
                         {"scene": scene, "strategy": "b", "figure": str(common + chance.gauss(0, 10))}]
            figures = evidence_planner.Figures(runs, [])
            ratio = figures.mean("a", "figure") / figures.mean("b", "figure")
            held += abs(ratio - 1.3) < figures.ratio_half_width("a", "b", "figure")
        self.assertAlmostEqual(held / times, 0.95, delta=0.03)


class Headline(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def write_campaign(self, kind, worst="attention", without=0):
        write_tables(self.folder / kind / "campaign", worst, scenes=range(201, 301 - without))

    def document(self, seeds="1"):
        """Exit status, and the text."""
        document = self.folder / "document.md"
        done = subprocess.run([SCRIPTS / "evidence_headline.py", "no-program", self.folder, document, "table"], check=False,
                              env={**os.environ, "SACCADE_HEADLINE_SEEDS": seeds}, stdout=subprocess.DEVNULL)
        return done.returncode, document.read_text()

    def test_complete_campaigns_met_what_they_are_held_to(self):
        for kind in evidence_headline.CAMPAIGNS:
            self.write_campaign(kind)
        status, text = self.document()
        self.assertEqual(status, 0, text)
        self.assertEqual(text.count("- met: "), 12)
        self.assertNotIn(" so far:", text)
        self.assertEqual(text.count("500 of 500 runs: 100 scenes, 1.0 seeds each."), 2)
        self.assertEqual(text.count("nothing is corrected for the number of comparisons"), 1)
        self.assertIn("unknown near objects, as a multiple of the oracle's: 1.00 ± 0.00 (at most 1.30)", text)
        self.assertRegex(text, r"area as a share of the oracle's: 0\.99\d ± 0\.000 \(at least 0\.980\)")
        self.assertRegex(text, r"\| `surface` \|.*\| 1\.00 \| 0\.80 \|")

    def test_the_command_is_told_as_it_was_given(self):
        for seeds, text in ((range(1, 11), "1-10"), ([3, 5], "3,5"), ([7, 1, 2, 3], "1-3,7"), ([1], "1")):
            self.assertEqual(evidence_headline.seeds_text(seeds), text)
        for seeds, text in (("1", "1"), ("2", "1-2"), ("10", "1-10")):
            _, told = self.document(seeds)
            command = (f"saccade compare --scenes clutter:201-300 --strategies surface,oracle,sphere,standard,attention --seeds {text} "
                       "--max-views 5")
            self.assertIn(f"```sh\n{command} --robot comau --out DIR\n```", told)
            self.assertIn(f"```sh\n{command} --out DIR\n```", told)

    def test_unfinished_campaigns_met_it_so_far(self):
        self.write_campaign("arm", without=1)
        status, text = self.document()
        self.assertEqual(status, 3, text)
        self.assertEqual(text.count("- met so far: "), 6)
        self.assertNotIn("- met: ", text)
        self.assertIn("495 of 500 runs: 99 scenes", text)
        self.assertIn("Not run yet.", text)
        self.assertNotIn("are kept run by run", text)  # no seed is whole

    def test_what_is_missed_is_said(self):
        self.write_campaign("arm", worst="surface")
        self.write_campaign("flying", worst="surface", without=50)
        status, text = self.document()
        self.assertEqual(status, 1, text)
        self.assertEqual((text.count("- **missed**: "), text.count("- **missed so far**: ")), (5, 5))

    def test_ratio_of_one_scene_has_no_interval(self):
        figures = evidence_planner.Figures([{"scene": "a", "strategy": strategy, "figure": "1"} for strategy in "ab"], [])
        self.assertEqual(figures.ratio_half_width("a", "b", "figure"), math.inf)


class CampaignOnACluster(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.stand_in("saccade", STAND_IN)
        self.stand_in("sbatch", "#!/bin/sh\nexit 1\n")
        self.cluster(answers=True, queue="")
        self.campaign = self.folder / "campaign"
        self.note = self.folder / "campaign.submitted.json"
        self.environment = {**os.environ, "PATH": f"{self.folder}:/usr/bin:/bin"}
        self.environment.pop("SACCADE_SLURM", None)

    def stand_in(self, name, text):
        (self.folder / name).write_text(text)
        (self.folder / name).chmod(0o755)

    def cluster(self, answers, queue=None):
        self.stand_in("sinfo", "#!/bin/sh\necho main up\n" if answers else "#!/bin/sh\nexit 1\n")
        self.stand_in("squeue", "#!/bin/sh\nexit 1\n" if queue is None else f"#!/bin/sh\nprintf '{queue}'\n")

    def begin(self, state, merged=0, done=0, before=0):
        """A campaign of three runs in slices that a submission as job 12 has left so."""
        shard = self.campaign / "shards/0-of-3"
        shard.mkdir(parents=True, exist_ok=True)
        (shard / "campaign.sqlite").touch()
        one = {"slice": 0, "of": 3, "state": state, "planned": 1, "done": 0, "tries": 1, "machine": "one", "job": "12_0", "error": ""}
        (self.folder / "status.json").write_text(json.dumps(
            {"result": {"runs": {"planned": 3, "done": done, "merged": merged}, "slices": [one]}}))
        self.note.write_text(json.dumps({"merged": before, "jobs": ["12", "13"]}))

    def call(self, **more):
        """Exit status, what was said, and the options that the program was called with last."""
        (self.folder / "calls").unlink(missing_ok=True)
        done = subprocess.run([SCRIPTS / "evidence_campaign.py", self.folder / "saccade", self.campaign, "compare"], check=False,
                              capture_output=True, text=True, env={**self.environment, **more}, timeout=60)
        self.assertEqual(done.stderr, "")
        calls = self.folder / "calls"
        return done.returncode, done.stdout, calls.read_text().splitlines()[-1] if calls.exists() else ""

    def test_a_submission_is_noted_with_its_jobs(self):
        status, _, last = self.call()
        self.assertEqual(status, 3)
        self.assertTrue(last.endswith("--slurm"), last)
        self.assertEqual(json.loads(self.note.read_text()), {"merged": 0, "jobs": ["12", "13"]})

    def test_slices_that_ended_fail_the_call_once(self):
        self.assertEqual(list(evidence_campaign.ENDED), ["failed", "killed", "interrupted", "lost"])
        for state, words in evidence_campaign.ENDED.items():
            with self.subTest(state):
                self.begin(state)
                status, said, last = self.call()
                self.assertEqual(status, 1, said)
                self.assertIn(f"slice 0 of 3 {words} without any progress: job 12_0 on one", said)
                self.assertTrue(last.endswith("--status --json -"), last)
        status, said, last = self.call()
        self.assertEqual(status, 3, said)
        self.assertTrue(last.endswith("--slurm"), last)

    def test_slices_whose_job_is_queued_or_that_may_be_do_not(self):
        for state, queue in (("killed", "12\n99\n"), ("lost", "13\n"), ("failed", None), ("waiting", "")):
            with self.subTest(state=state, queue=queue):
                self.cluster(answers=True, queue=queue)
                self.begin(state)
                status, said, last = self.call()
                self.assertEqual(status, 3, said)
                self.assertTrue(last.endswith("--slurm"), last)  # which the program refuses while a job is queued

    def test_progress_is_submitted_again(self):
        self.begin("killed", merged=1, done=1, before=0)
        self.assertEqual(self.call()[0], 3)
        self.begin("killed", merged=1, done=1, before=1)
        self.assertEqual(self.call()[0], 1)

    def test_nothing_runs_beside_an_array_when_the_cluster_does_not_answer(self):
        self.begin("running")
        self.cluster(answers=False)
        status, said, last = self.call()
        self.assertEqual(status, 3, said)
        self.assertIn("no cluster answers now", said)
        self.assertTrue(last.endswith("--status --json -"), last)
        self.note.unlink()
        self.assertEqual(self.call()[2].split()[-1], "%s.json" % self.campaign)  # its shards hold nothing new
        self.begin("running", done=1)
        self.note.unlink()
        self.assertEqual(self.call()[0], 3)  # runs that are not merged

    def test_nothing_runs_before_the_first_task_either(self):
        self.note.write_text('{"merged": 0, "jobs": ["12", "13"]}')
        self.cluster(answers=False)
        self.assertEqual(self.call()[::2], (3, ""))

    def test_it_runs_here_when_told_so(self):
        self.begin("running", done=1)
        status, said, last = self.call(SACCADE_SLURM="off")
        self.assertEqual(status, 0, said)
        self.assertTrue(last.endswith(f"--json {self.campaign}.json"), last)
        self.assertIn("--merge", said)
        self.assertFalse(self.note.exists())

    def test_interruptions_are_passed_on(self):
        for status in (129, 130, 140, 143):
            self.stand_in("saccade", f"#!/bin/sh\nexit {status}\n")
            self.assertEqual(self.call()[0], status)
            self.assertEqual(self.planner("rooms_flying").returncode, status)
            headline = [SCRIPTS / "evidence_headline.py", self.folder / "saccade", self.folder, self.folder / "document.md"]
            done = subprocess.run(headline, check=False, capture_output=True, env={**self.environment, "SACCADE_SLURM": "off"}, timeout=60)
            self.assertEqual(done.returncode, status)

    def test_it_runs_here_where_no_cluster_ever_was(self):
        self.cluster(answers=False)
        status, said, last = self.call()
        self.assertEqual(status, 0, said)
        self.assertTrue(last.endswith(f"--json {self.campaign}.json"), last)

    def test_a_complete_campaign_is_summed_up_without_the_cluster(self):
        self.begin("done", merged=3, done=3)
        self.cluster(answers=False)
        self.assertEqual(self.call()[0], 0)
        self.assertFalse(self.note.exists())

    def test_the_headline_waits_as_well(self):
        self.cluster(answers=False)
        for kind in evidence_headline.CAMPAIGNS:
            (self.folder / kind).mkdir()
            (self.folder / kind / "campaign.submitted.json").write_text('{"merged": 0, "jobs": []}')
        done = subprocess.run([SCRIPTS / "evidence_headline.py", self.folder / "saccade", self.folder, self.folder / "document.md"],
                              check=False, capture_output=True, text=True, env=self.environment, timeout=60)
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count("no cluster answers now"), 2)
        self.assertFalse((self.folder / "calls").exists())

    def planner(self, *more):
        return subprocess.run([SCRIPTS / "evidence_planner.py", self.folder / "saccade", self.folder, self.folder / "document.md", *more],
                              check=False, capture_output=True, text=True, env=self.environment, timeout=60)

    def test_the_planner_is_submitted_campaign_by_campaign(self):
        done = self.planner("clutter_arm", "rooms_flying")
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertIn("document.md stays as it is; failed: none; not complete: clutter_arm, rooms_flying", done.stdout)
        self.assertFalse((self.folder / "document.md").exists())
        self.assertTrue((self.folder / "rooms_flying.submitted.json").exists())
        self.assertIn("--robot comau", (self.folder / "calls").read_text())
        self.stand_in("saccade", "#!/bin/sh\nexit 1\n")
        done = self.planner("rooms_flying")
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn("failed: rooms_flying", done.stdout)

    def test_the_headline_notes_its_jobs(self):
        done = subprocess.run([SCRIPTS / "evidence_headline.py", self.folder / "saccade", self.folder, self.folder / "document.md"],
                              check=False, capture_output=True, text=True, env=self.environment, timeout=60)
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        for kind in evidence_headline.CAMPAIGNS:
            self.assertEqual(json.loads((self.folder / kind / "campaign.submitted.json").read_text())["jobs"], ["12", "13"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
