#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Records of the headline figures: what is written, what is refused, what is checked, and what is run or submitted beside them; the
program, sinfo, squeue and sbatch are stand-ins.
Usage: evidence_records_test.py SCRIPTS"""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from evidence_test import SCRIPTS, settings_of, write_tables  # which finds the scripts
import evidence_headline
import evidence_records

# As the program does, it keeps the runs that are there.
STAND_IN = """#!/bin/sh
folder=$(dirname "$0")
all="$*"
out="${all##*--out }"
echo "$all" >>"$folder/calls"
case " $all " in
  *" --status "*) cat "$folder/status.json" ;;
  *" --slurm "*) printf 'array     job 12: 3 runs in 3 slices\\nmerge     job 13, when it has ended\\n' ;;
  *) mkdir -p "$out"
     if [ -d "$folder/tables" ] && [ ! -e "$out/runs.csv" ]; then cp "$folder/tables/"* "$out"; fi ;;
esac
"""
STRATEGIES = evidence_headline.STRATEGIES


def other_settings(strategy):
    """Settings that differ in what one strategy alone has."""
    return {**settings_of(strategy), **({"least_share": 0.01} if strategy == "surface" else {})}


def several_settings():
    """Settings of runs one after the other, those of the last strategy not alike."""
    count = iter(range(10**6))
    return lambda strategy: {**settings_of(strategy), **({"rival_share": next(count)} if strategy == "attention" else {})}


class HeadlineFolder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.records = self.folder / "document"
        self.calls = self.folder / "calls"
        self.environment = {**os.environ, "PATH": f"{self.folder}:/usr/bin:/bin", "SACCADE_SLURM": "off"}
        self.stand_in("saccade", STAND_IN)

    def stand_in(self, name, text):
        (self.folder / name).write_text(text)
        (self.folder / name).chmod(0o755)

    def campaign(self, kind):
        return self.folder / kind / "campaign"

    def begin_shard(self, kind):
        shard = self.campaign(kind) / "shards/0-of-3"
        shard.mkdir(parents=True)
        (shard / "campaign.sqlite").touch()

    def record(self, kind, **more):
        """Makes records of whole seeds, as on another machine."""
        write_tables(self.folder / "elsewhere", **more)
        evidence_records.Records(self.records, kind, STRATEGIES, 100).add_whole_seeds(self.folder / "elsewhere")

    def headline(self, *rest, seeds=1):
        """Exit status, and what was said."""
        self.calls.unlink(missing_ok=True)
        command = [SCRIPTS / "evidence_headline.py", self.folder / "saccade", self.folder, self.folder / "document.md", *rest]
        done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=60,
                              env={**self.environment, "SACCADE_HEADLINE_SEEDS": str(seeds)})
        self.assertNotIn("Traceback", done.stderr)
        return done.returncode, done.stdout + done.stderr

    def called(self):
        return self.calls.read_text().splitlines() if self.calls.exists() else []

    def text(self):
        return (self.folder / "document.md").read_text()


class WhatIsRecorded(HeadlineFolder):
    def test_whole_seeds_are_recorded_and_not_run_again(self):
        for kind in evidence_headline.CAMPAIGNS:
            write_tables(self.campaign(kind))
        self.assertEqual(self.headline("table")[0], 0)
        text, records = self.text(), sorted(self.records.iterdir())
        self.assertEqual([record.name for record in records], ["arm-seed-01.csv", "flying-seed-01.csv"])
        self.assertEqual(len(records[0].read_text().splitlines()), 2 + 500)
        self.assertIn("kept run by run in [document/](document)", text)
        for kind in evidence_headline.CAMPAIGNS:
            shutil.rmtree(self.folder / kind)  # another machine
        self.assertEqual(self.headline()[0], 0)
        self.assertEqual((self.called(), self.text()), ([], text))

    def test_records_have_all_settings_and_say_where_they_are_from(self):
        self.record("arm")
        header, *lines = (self.records / "arm-seed-01.csv").read_text().splitlines()
        self.assertEqual(header, "# " + json.dumps({strategy: settings_of(strategy) for strategy in STRATEGIES}, sort_keys=True))
        self.assertIn('"least_share": 0.005', header)
        self.assertIn('"rival_share": 0.5', header)
        first = next(csv.DictReader(lines))
        self.assertEqual((first["scene_hash"], first["program_version"]), ("e8201", "0.2.0"))

    def test_only_runs_that_belong_together_are_recorded(self):
        write_tables(self.campaign("arm"), settings=several_settings())
        status, said = self.headline("table")
        self.assertEqual(status, 2, said)
        self.assertIn("attention with several settings (rival_share)", said)
        write_tables(self.campaign("arm"))
        table = self.campaign("arm") / "runs.csv"
        table.write_text(table.read_text().replace("e8201", "f9201", 1))
        status, said = self.headline("table")
        self.assertEqual(status, 2, said)
        self.assertIn("clutter:201 with several hashes (e8201, f9201)", said)
        self.assertFalse(self.records.exists())

    def test_another_seed_has_settings_and_scenes_of_the_records(self):
        self.record("arm")
        for more, why in (({"settings": other_settings}, "surface with several settings (least_share)"),
                          ({"hashes": "f9{}"}, "clutter:300 with several hashes (e8300, f9300)")):
            for scenes in (range(201, 301), range(299, 301)):  # whole, and not
                with self.subTest(why, scenes=len(scenes)):
                    write_tables(self.campaign("arm"), seeds=[2], scenes=scenes, **more)
                    status, said = self.headline("table")
                    self.assertEqual(status, 2, said)
                    self.assertIn(why, said)
                    self.assertEqual(len(list(self.records.iterdir())), 1)
                    with self.assertRaises(evidence_records.RecordError):
                        evidence_records.Records(self.records, "arm", STRATEGIES, 100).with_runs_of(self.campaign("arm"))

    def test_another_version_of_the_program_is_no_error(self):
        self.record("arm")
        write_tables(self.campaign("arm"), seeds=[2], version="0.3.0")
        self.assertEqual(self.headline("table", seeds=2)[0], 3)
        self.assertIn("1,000 of 1,000 runs: 100 scenes, 2.0 seeds each. Seeds: 1, 2.", self.text())
        self.assertIn(",0.3.0,", (self.records / "arm-seed-02.csv").read_text())

    def test_records_that_are_damaged_are_named(self):
        self.record("arm")
        path = self.records / "arm-seed-01.csv"
        whole = path.read_text()
        lines = whole.splitlines(keepends=True)
        for name, damaged in (("last line", "".join(lines[:-1])), ("half a line", whole[:-40]), ("empty", ""), ("no header", "".join(lines[1:])),
                              ("a line twice", "".join([*lines[:-1], lines[-2]])), ("settings of one", "# {}\n" + "".join(lines[1:])),
                              ("settings of all in common", '# {"robot": "free"}\n' + "".join(lines[1:])),
                              ("a hash", whole.replace("e8201", "e8", 1))):
            with self.subTest(name):
                path.write_text(damaged)
                status, said = self.headline("table")
                self.assertEqual(status, 2, said)
                self.assertIn(str(path), said)

    def test_records_of_other_settings_are_refused(self):
        self.record("arm")
        record = (self.records / "arm-seed-01.csv").read_text()
        other = self.records / "arm-seed-02.csv"
        other.write_text(record.replace(",1,", ",2,").replace('"least_share": 0.005', '"least_share": 0.01'))
        status, said = self.headline("table")
        self.assertEqual(status, 2, said)
        self.assertIn(f"{other}: does not belong to the records before it: surface with several settings (least_share)", said)

    def test_tables_that_cannot_be_used_are_named(self):
        write_tables(self.campaign("arm"))
        table = self.campaign("arm") / "runs.csv"
        table.write_text(table.read_text().replace("scene_hash", "scene_number", 1))
        self.assertIn(f"{table}: lacks scene_hash", self.headline("table")[1])
        (self.campaign("arm") / "views.csv").unlink()
        status, said = self.headline("table")
        self.assertEqual(status, 2, said)
        self.assertIn("tables cannot be read", said)

    def test_seeds_that_are_not_asked_for_are_not_counted(self):
        self.record("arm", seeds=range(1, 4))
        write_tables(self.campaign("arm"), seeds=[4], scenes=range(201, 211))
        self.assertEqual(self.headline("table")[0], 3)
        self.assertIn("500 of 500 runs: 100 scenes, 1.0 seeds each. Seeds: 1.\n", self.text())
        self.assertNotIn("so far:", self.text())


class WhatIsRunBesideRecords(HeadlineFolder):
    def test_runs_of_other_settings_end_the_call_after_the_first(self):
        self.record("arm")
        write_tables(self.folder / "tables", seeds=[2], scenes=range(201, 205), settings=other_settings)
        status, said = self.headline(seeds=3)
        self.assertEqual(status, 2, said)
        self.assertIn("surface with several settings (least_share)", said)
        self.assertEqual(len(self.called()), 1)
        self.assertIn("--seeds 2 ", self.called()[0])

    def test_so_does_a_merge(self):
        self.record("arm")
        self.begin_shard("arm")
        write_tables(self.folder / "tables", seeds=[2], scenes=range(201, 205), hashes="f9{}")
        for environment in ({}, self.cluster()):
            self.environment.update(environment)
            status, said = self.headline(seeds=3)
            self.assertEqual(status, 2, said)
            self.assertIn("clutter:201 with several hashes (e8201, f9201)", said)
            self.assertEqual(len(self.called()), 1)
            self.assertIn("--seeds 1-10 --max-views 5 --robot comau --merge ", self.called()[0])
            (self.campaign("arm") / "runs.csv").unlink()

    def cluster(self):
        """Environment in which a cluster answers."""
        for name, text in (("sbatch", "exit 1"), ("sinfo", "echo main up"), ("squeue", "exit 0")):
            self.stand_in(name, f"#!/bin/sh\n{text}\n")
        return {"SACCADE_SLURM": "on"}

    def status_says(self, merged):
        one = {"slice": 0, "of": 3, "state": "failed", "planned": 1, "done": 0, "tries": 1, "machine": "one", "job": "12_0", "error": ""}
        (self.folder / "status.json").write_text(json.dumps({"result": {"runs": {"planned": 500, "done": merged, "merged": merged},
                                                                        "slices": [one]}}))

    def test_runs_that_are_recorded_meanwhile_are_progress(self):
        self.environment.update(self.cluster())
        self.record("flying", seeds=[1, 2])
        self.begin_shard("arm")
        note = self.folder / "arm/campaign.submitted.json"
        note.write_text('{"merged": 100, "jobs": ["12", "13"]}')  # runs of the first seed, which is whole now
        write_tables(self.folder / "tables")
        self.status_says(merged=0)
        status, said = self.headline(seeds=2)
        self.assertEqual(status, 3, said)
        merge, told, submitted = self.called()
        self.assertIn("--seeds 1-10 --max-views 5 --robot comau --merge ", merge)  # a shard with recorded seeds alone is refused otherwise
        self.assertIn("--seeds 2 --max-views 5 --robot comau --status ", told)
        self.assertIn("--seeds 2 --max-views 5 --robot comau --slurm ", submitted)
        self.assertEqual(json.loads(note.read_text()), {"merged": 500, "jobs": ["12", "13"]})
        status, said = self.headline(seeds=2)
        self.assertEqual(status, 2, said)
        self.assertIn("slice 0 of 3 failed without any progress", said)
        note.write_text('{"merged": 500, "jobs": ["12", "13"]}')
        self.status_says(merged=1)
        self.assertEqual(self.headline(seeds=2)[0], 3)

    def test_nothing_is_submitted_where_a_merge_makes_all_seeds_whole(self):
        self.environment.update(self.cluster())
        self.record("flying")
        self.begin_shard("arm")
        note = self.folder / "arm/campaign.submitted.json"
        note.write_text('{"merged": 0, "jobs": ["12", "13"]}')
        write_tables(self.folder / "tables")
        status, said = self.headline()
        self.assertEqual(status, 0, said)
        self.assertEqual(len(self.called()), 1)
        self.assertFalse(note.exists())

    def test_more_seeds_do_not_wait_for_a_submission_that_is_complete(self):
        for kind in evidence_headline.CAMPAIGNS:
            self.record(kind)
            (self.folder / kind).mkdir()
            (self.folder / kind / "campaign.submitted.json").write_text('{"merged": 0, "jobs": ["12", "13"]}')
        del self.environment["SACCADE_SLURM"]
        self.stand_in("sbatch", "#!/bin/sh\nexit 1\n")
        self.stand_in("sinfo", "#!/bin/sh\nexit 1\n")  # no cluster answers
        self.assertEqual(self.headline(seeds=2)[0], 3)
        self.assertEqual(self.called(), [])  # its jobs may be queued
        self.assertEqual(self.headline(seeds=1)[0], 0)
        self.assertEqual(self.headline(seeds=2)[0], 3)
        self.assertEqual([call.partition("--seeds ")[2].split()[0] for call in self.called()], ["2", "2"])


class WhatIsChecked(HeadlineFolder):
    def check(self, **more):
        """Runs the check with a program that has these runs of the first and the last scene."""
        shutil.rmtree(self.folder / "tables", ignore_errors=True)
        write_tables(self.folder / "tables", **{"scenes": (201, 300), **more})
        return self.headline("check")

    def test_the_first_and_the_last_scene_are_run_again(self):
        self.record("arm")
        status, said = self.check(version="0.3.0")
        self.assertEqual(status, 0, said)
        self.assertIn("arm, seed 1: as recorded", said)
        self.assertEqual(len(self.called()), 1)
        self.assertIn("compare --scenes clutter:201,clutter:300 --strategies surface,oracle,sphere,standard,attention --seeds 1 ",
                      self.called()[0])

    def test_another_figure_is_told_each_time(self):
        self.record("arm")
        for worst, status in (("attention", 0), ("sphere", 2), ("sphere", 2), ("attention", 0), ("sphere", 2)):
            found, said = self.check(worst=worst)
            self.assertEqual(found, status, said)
            self.assertEqual("clutter:300, sphere: coverage " in said, status == 2, said)
            self.assertEqual((self.folder / "check-arm-1").exists(), status == 2)  # to be looked at

    def test_other_settings_and_scenes_are_told(self):
        self.record("arm")
        for more, why in (({"settings": other_settings}, "surface with several settings (least_share)"),
                          ({"hashes": "f9{}"}, "clutter:201 with several hashes"),
                          ({"scenes": (201,)}, "clutter:300, surface: was not run"),
                          ({"scenes": ()}, "clutter:201, attention: was not run"),
                          ({"seeds": [2]}, "clutter:201, attention: was not run"),
                          ({"scenes": (201, 300, 301)}, "clutter:301, oracle: is not recorded")):
            with self.subTest(why):
                status, said = self.check(**more)
                self.assertEqual(status, 2, said)
                self.assertIn(why, said)

    def test_a_program_that_fails_or_runs_nothing_is_told(self):
        self.record("arm")
        self.record("flying")
        for text in ("exit 1", "exit 0"):
            self.stand_in("saccade", f"#!/bin/sh\n{text}\n")
            status, said = self.headline("check")
            self.assertEqual(status, 2, said)
            self.assertIn("arm, seed 1: differs", said)

    def test_no_record_is_nothing_checked(self):
        status, said = self.check()
        self.assertEqual(status, 2, said)
        self.assertIn("there is no record to check", said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
