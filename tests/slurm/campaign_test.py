#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A campaign on a cluster of two nodes, of which one is lost on the way and two tasks are killed, equals the same campaign on
one machine to the bit; and a benchmark there is measured.

Usage: campaign_test.py SACCADE. Ends with 77 where Slurm is not installed."""
import json
import os
import pathlib
import signal
import sqlite3
import subprocess
import sys
import time
import unittest

from cluster import Cluster, until

PROGRAM = os.path.abspath(sys.argv[1])
EVIDENCE = str(pathlib.Path(__file__).resolve().parents[2] / "scripts/evidence_campaign.py")
TIMES = {"id", "run", "seconds", "finished_at"}


def comparison(out, *more):
    size = [] if "--image-size" in more else ["--image-size", "160,120", "--max-views", "1"]
    return [PROGRAM, "compare", "--scenes", "clutter:5-6", "--strategies", "sphere,random", "--seeds", "1-6", *size,
            "--min-gain", "1", "--voxel-size", "0.015", "--quiet", "--out", str(out), *more]


def done_in(shard):
    """How many runs a shard has."""
    if not shard.exists():
        return 0
    try:
        with sqlite3.connect(f"file:{shard}?mode=ro", uri=True) as file:
            return file.execute("SELECT count(*) FROM runs").fetchone()[0]
    except sqlite3.OperationalError:
        return 0  # its tables are being made


def run(out, *more):
    done = subprocess.run(comparison(out, *more), capture_output=True, text=True, timeout=300)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(more)}: {done.returncode}\n{done.stderr}")
    return done.stdout


def rows(out):
    """All that a campaign holds but the times, and where it was made; every number with all its bits."""
    with sqlite3.connect(f"file:{out}/campaign.sqlite?mode=ro", uri=True) as file:
        file.row_factory = sqlite3.Row
        tables = [list(file.execute("SELECT * FROM runs")),
                  list(file.execute("SELECT runs.scene, runs.strategy, runs.noise, runs.seed, views.* FROM views "
                                    "JOIN runs ON runs.id = views.run"))]
    return [sorted(tuple((name, value.hex() if isinstance(value, float) else value) for name, value in zip(row.keys(), row)
                         if name not in TIMES and not name.endswith("_ms")) for row in table) for table in tables]


class CampaignTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.cluster = cls.enterClassContext(Cluster())

    def test_a_benchmark_is_measured_where_it_is_merged(self):
        """By the script of `make evidence`: it submits, and once the cluster is done it finds the campaign complete."""
        cluster, began = self.cluster, time.monotonic()
        folder = cluster.folder / "benchmark"
        step = [EVIDENCE, PROGRAM, str(folder), "benchmark", "view-sphere", "--only", "figure", "--strategies", "random"]

        def call(status):
            done = subprocess.run(step, capture_output=True, text=True, timeout=300)
            self.assertEqual(done.returncode, status, done.stdout + done.stderr)
            return done.stdout
        call(3)
        until(cluster.is_done, 120, "the queue is empty")
        self.assertEqual(len((folder / "curves.csv").read_text().splitlines()), 1 + 10)  # by the job that merges
        self.assertIn("0 done now, 1 found", call(0))
        result = json.loads((cluster.folder / "benchmark.json").read_text())["result"]
        self.assertEqual([slice["state"] for slice in result["slices"]], ["done"])
        self.assertEqual([row["method"] for row in result["benchmark"]["table"]], ["random"] * 3 + ["MCMF"] * 3)
        print(f"a benchmark after {time.monotonic() - began:.1f} s")

    def test_a_task_whose_node_has_no_folder_says_so(self):
        out = self.cluster.folder / "not there"
        script = json.loads(run(out, "--slurm", "--dry-run", "--json", "-"))["result"]["script"]
        job = subprocess.run(["sbatch", "--parsable", "--array=0"], input=script, capture_output=True, text=True, check=True).stdout.strip()

        def told():
            shown = subprocess.run(["scontrol", "show", "job", job], capture_output=True, text=True).stdout
            return shown if "JobState=FAILED" in shown else None
        self.assertRegex(until(told, 60, "the task fails"), f"Comment=node (one|two) has no {out}")
        self.assertFalse(out.exists())

    def test_tasks_at_their_time_limit_and_preempted_ones_go_on(self):
        cluster, began = self.cluster, time.monotonic()
        out = cluster.folder / "limited"
        finer = ["--image-size", "320,240", "--max-views", "3"]  # so that tasks last
        array = json.loads(run(out, *finer, "--slurm", "--tasks", "2", "--time", "10", "--json", "-"))["result"]["array_job"]
        until(lambda: done_in(out / "shards/0-of-2/campaign.sqlite") > 0, 60, "the first slice has done a run")
        # As Slurm does a minute before the limit (--signal=B:USR2@60).
        subprocess.run(["scancel", "--batch", "--signal=USR2", f"{array}_0"], check=True)
        log = out / "logs/slice-0.log"
        until(lambda: "queued again" in log.read_text(), 30, "the slice is queued again")
        # The other one makes place for an urgent job, which takes all nodes that are left for a moment.
        up = sum(not state.startswith("down") for state in cluster.states().values())
        subprocess.run(["sbatch", "--partition=urgent", f"--nodes={up}", "--exclusive", "--output=/dev/null", "--wrap=sleep 1"],
                       check=True, stdout=subprocess.DEVNULL)
        until(cluster.is_done, 120, "the queue is empty")
        status = json.loads(run(out, *finer, "--status", "--json", "-"))["result"]
        print(f"a limit and a preemption: complete after {time.monotonic() - began:.1f} s\n{log.read_text()}")
        self.assertEqual([slice["state"] for slice in status["slices"]], ["done", "done"])
        self.assertEqual([slice["tries"] for slice in status["slices"]], [2, 2])
        self.assertEqual(status["runs"], {"planned": 24, "done": 24, "merged": 24})

    def test_a_lost_node_and_killed_tasks_change_nothing(self):
        try:
            self.check(self.cluster)
        except BaseException:
            print(self.cluster.logs())
            for log in sorted(self.cluster.folder.glob("sliced/logs/*")):
                print(f"--- {log.name}\n{log.read_text()[-2000:]}")
            raise

    def check(self, cluster):
        whole, sliced = cluster.folder / "whole", cluster.folder / "sliced"
        run(whole)
        began = time.monotonic()
        print(run(sliced, "--slurm", "--tasks", "8", "--time", "10"))
        refused = subprocess.run(comparison(sliced, "--slurm"), capture_output=True, text=True)
        self.assertEqual(refused.returncode, 3)
        self.assertIn("still queued or running", refused.stderr)

        # The two tasks of one node are killed once they have begun, and the other node is lost with all that it does.
        def busy():
            tasks = cluster.tasks()
            begun = len(list(sliced.glob("shards/*/shard.json")))
            return tasks if begun == 4 and sorted(node for _, node in tasks) == ["one", "one", "two", "two"] else None
        for process, node in until(busy, 60, "both nodes are busy"):
            if node == "two":
                os.kill(process, signal.SIGKILL)
        lost = cluster.lose_node("one")
        print(f"two tasks killed, a node lost with {lost} tasks, {time.monotonic() - began:.1f} s after the submission")
        self.assertEqual(lost, 2)
        until(cluster.is_done, 120, "the queue is empty")
        print(f"the queue is empty after {time.monotonic() - began:.1f} s")

        status = json.loads(run(sliced, "--status", "--json", "-"))["result"]
        print(run(sliced, "--status"))
        tries = [slice["tries"] for slice in status["slices"]]
        self.assertGreaterEqual(max(tries), 2, "a task of the lost node was taken again")
        self.assertLess(status["runs"]["done"], status["runs"]["planned"], "killed tasks are missing")
        self.assertGreaterEqual(sum(slice["state"] == "killed" for slice in status["slices"]), 2)

        # Failed tasks are taken again, on the node that is left, and merged by the job after it.
        print(run(sliced, "--slurm", "--tasks", "8"))
        until(cluster.is_done, 120, "the queue is empty")
        print(f"complete after {time.monotonic() - began:.1f} s")
        status = json.loads(run(sliced, "--status", "--json", "-"))["result"]
        self.assertEqual(status["runs"]["merged"], 24)
        self.assertEqual(rows(whole), rows(sliced))
        self.assertEqual(len(rows(sliced)[0]), 24)
        self.assertIn("all runs are done", run(sliced, "--slurm", "--tasks", "8"))
        again = run(sliced, "--merge")
        self.assertIn("0 merged now, 24 known", again)
        self.assertEqual(rows(whole), rows(sliced))
        self.assertTrue((sliced / "index.html").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
