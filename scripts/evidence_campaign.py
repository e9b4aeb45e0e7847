#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A campaign of evidence, on Slurm where a cluster answers, else here: evidence_campaign.py PROGRAM FOLDER COMMAND….

COMMAND is `compare …` or `benchmark …` without --out, which becomes FOLDER; the result goes to FOLDER.json. Where a cluster
answers (`sinfo`), each call merges what tasks have done and submits what is missing; FOLDER.submitted.json keeps how many runs were
there then. Where a slice has failed since and no run was added, the call fails instead; the call after it submits again.
Exit status 0: complete; 1: the program or a slice failed; 3: not complete, the same call goes on; 129, 130, 143: interrupted.
SACCADE_SLURM=off: runs here although a cluster answers.
SACCADE_SLURM_OPTIONS: further options of --slurm, as "--partition long --time 2:00:00"."""
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys

FAILED = 1
NOT_COMPLETE = 3
INTERRUPTED = (129, 130, 143)  # exit statuses of saccade
STILL_QUEUED = "still queued or running"
ANSWER_S = 20


def cluster_answers():
    if os.environ.get("SACCADE_SLURM") == "off" or not shutil.which("sbatch"):
        return False
    try:
        answer = subprocess.run(["sinfo", "--noheader"], capture_output=True, text=True, check=False, timeout=ANSWER_S)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return answer.returncode == 0 and bool(answer.stdout.strip())


def slurm_options():
    return shlex.split(os.environ.get("SACCADE_SLURM_OPTIONS", ""))


def has_shards(folder):
    return any(pathlib.Path(folder).glob("shards/*/campaign.sqlite"))


def has_begun(folder):
    """Whether --status has something to say."""
    return (pathlib.Path(folder) / "campaign.sqlite").exists() or (pathlib.Path(folder) / "shards").is_dir()


def submitted_file(folder):
    return pathlib.Path(f"{folder}.submitted.json")


def note_submission(folder, merged):
    submitted_file(folder).write_text(json.dumps({"merged": merged}) + "\n")


def failed_slices(folder, status):
    """Slices that failed, where no run was added since the submission and none goes on; empty otherwise.

    @param status  result of --status"""
    try:
        before = json.loads(submitted_file(folder).read_text())["merged"]
    except (OSError, ValueError, KeyError, TypeError):
        return []
    slices = [one for one in status["slices"] if one["done"] < one["planned"]]
    failed = [one for one in slices if one["state"] == "failed"]
    if status["runs"]["merged"] > before or any(one["state"] == "running" for one in slices) or not failed:
        return []
    submitted_file(folder).unlink()  # what was wrong may be mended before the next call
    return failed


def print_failed(failed):
    for one in failed:
        print(f"  slice {one['slice']} of {one['of']} failed without any progress: {one['error']}", flush=True)


def main():
    program, folder, *command = sys.argv[1:]

    def call(*more):
        words = [program, "--quiet", *command, "--out", folder, *more]
        print(shlex.join(words), flush=True)
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        print(done.stdout + done.stderr, flush=True)
        if done.returncode in INTERRUPTED:
            sys.exit(done.returncode)
        return done

    if cluster_answers():
        if has_shards(folder) and call("--merge").returncode:
            return FAILED
        runs = None
        if has_begun(folder):
            status = call("--status", "--json", "-")
            if status.returncode:
                return FAILED
            result = json.loads(status.stdout)["result"]
            runs = result["runs"]
            if failed := failed_slices(folder, result):
                print_failed(failed)
                return FAILED
        if runs is None or runs["merged"] < runs["planned"]:
            submitted = call("--slurm", *slurm_options())
            if submitted.returncode:
                return NOT_COMPLETE if STILL_QUEUED in submitted.stderr else FAILED
            note_submission(folder, runs["merged"] if runs else 0)
            return NOT_COMPLETE
    return FAILED if call("--json", f"{folder}.json").returncode else 0


if __name__ == "__main__":
    sys.exit(main())
