#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A campaign of evidence, on Slurm where a cluster answers, else here: evidence_campaign.py PROGRAM FOLDER COMMAND….

COMMAND is `compare …` or `benchmark …` without --out, which becomes FOLDER; the result goes to FOLDER.json. Where a cluster
answers (`sinfo`), each call merges what tasks have done and submits what is missing.
Exit status 0: complete; 1: the program failed; 3: not complete, the same call goes on; 129, 130, 143: interrupted.
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


def cluster_answers():
    if os.environ.get("SACCADE_SLURM") == "off" or not shutil.which("sbatch"):
        return False
    return subprocess.run(["sinfo", "--noheader"], capture_output=True, check=False).returncode == 0


def slurm_options():
    return shlex.split(os.environ.get("SACCADE_SLURM_OPTIONS", ""))


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
        if (pathlib.Path(folder) / "shards").is_dir() and call("--merge").returncode:
            return FAILED
        status = call("--status", "--json", "-")
        if status.returncode:
            return FAILED
        runs = json.loads(status.stdout)["result"]["runs"]
        if runs["merged"] < runs["planned"]:
            submitted = call("--slurm", *slurm_options())
            return FAILED if submitted.returncode and STILL_QUEUED not in submitted.stderr else NOT_COMPLETE
    return FAILED if call("--json", f"{folder}.json").returncode else 0


if __name__ == "__main__":
    sys.exit(main())
