#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A campaign of evidence, on Slurm where a cluster answers, else here: evidence_campaign.py PROGRAM FOLDER COMMAND….

COMMAND is `compare …` or `benchmark …` without --out, which becomes FOLDER; the result goes to FOLDER.json. Where a cluster
answers (`sinfo`), each call merges what tasks have done and submits what is missing; FOLDER.submitted.json keeps how many runs were
there then, and the jobs. Where these have ended, no run was added, and a slice failed, was killed, interrupted or lost, the call
fails instead; the call after it submits again. Where no cluster answers any more, nothing runs, since the array may still be queued.
Exit status 0: complete; 1: the program or a slice failed; 3: not complete, the same call goes on; 129, 130, 140, 143: interrupted.
SACCADE_SLURM=off: runs here although a cluster answers.
SACCADE_SLURM_OPTIONS: further options of --slurm, as "--partition long --time 2:00:00"."""
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

FAILED = 1
NOT_COMPLETE = 3
INTERRUPTED = (129, 130, 140, 143)  # exit statuses of saccade: SIGHUP, SIGINT, SIGUSR2, SIGTERM
STILL_QUEUED = "still queued or running"
ENDED = {"failed": "failed", "killed": "was killed", "interrupted": "was interrupted", "lost": "was lost"}  # states of slices
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


def jobs_in(said):
    """Numbers of the jobs that --slurm has submitted, by its standard output."""
    return re.findall(r"^(?:array|merge) +job (\d+)", said, re.MULTILINE)


def note_submission(folder, merged, jobs):
    """Keeps for failed_slices how many runs were there at a submission, and its jobs."""
    submitted_file(folder).write_text(json.dumps({"merged": merged, "jobs": jobs}) + "\n")


def queued_jobs():
    """Numbers of all jobs that are queued or running, of arrays that of the whole; None where squeue does not say."""
    try:
        answer = subprocess.run(["squeue", "--me", "--noheader", "--format", "%F"], capture_output=True, text=True, check=False,
                                timeout=ANSWER_S)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return set(answer.stdout.split()) if answer.returncode == 0 else None


def failed_slices(folder, status, recorded=0):
    """Slices that ended before they were done, where no run was added since the submission and none goes on; empty otherwise.

    @param status    result of --status
    @param recorded  number of runs that are not in the plan any more since they are recorded; note_submission counts them too"""
    try:
        note = json.loads(submitted_file(folder).read_text())
        before, jobs = note["merged"], note.get("jobs", [])
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return []
    slices = [one for one in status["slices"] if one["done"] < one["planned"]]
    failed = [one for one in slices if one["state"] in ENDED]
    if recorded + status["runs"]["merged"] > before or any(one["state"] == "running" for one in slices) or not failed:
        return []
    queued = queued_jobs()
    if queued is None or queued.intersection(jobs):
        return []  # slices have the states of earlier tries while a job waits
    failed = [one for one in failed if one["job"].partition("_")[0] not in queued]
    if failed:
        submitted_file(folder).unlink()  # what was wrong may be mended before the next call
    return failed


def print_failed(failed):
    for one in failed:
        why = one["error"] or f"job {one['job'] or 'unknown'} on {one['machine'] or 'an unknown machine'}"
        print(f"  slice {one['slice']} of {one['of']} {ENDED[one['state']]} without any progress: {why}", flush=True)


def may_be_submitted(folder):
    """Whether a cluster that does not answer now may be at work on the campaign."""
    return os.environ.get("SACCADE_SLURM") != "off" and (submitted_file(folder).exists() or has_shards(folder))


def awaits_cluster(folder, runs):
    """Whether a campaign that may be submitted has to wait until the cluster answers again.

    @param runs  of the result of --status; None where the campaign has not begun"""
    if runs and runs["merged"] >= runs["planned"]:
        return False
    return submitted_file(folder).exists() or bool(runs and runs["done"] > runs["merged"])


def print_awaiting(folder):
    print(f"  {folder}: no cluster answers now, but jobs of this campaign may be queued or running on one, or its shards hold runs "
          "that are not merged; nothing runs here (with SACCADE_SLURM=off it does)", flush=True)


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

    on_cluster = cluster_answers()
    doubtful = not on_cluster and may_be_submitted(folder)
    if not doubtful and has_shards(folder) and call("--merge").returncode:
        return FAILED
    result, runs = None, None
    if has_begun(folder) and (on_cluster or doubtful):
        status = call("--status", "--json", "-")
        if status.returncode:
            return FAILED
        result = json.loads(status.stdout)["result"]
        runs = result["runs"]
    if doubtful and awaits_cluster(folder, runs):
        print_awaiting(folder)
        return NOT_COMPLETE
    if on_cluster:
        if result and (failed := failed_slices(folder, result)):
            print_failed(failed)
            return FAILED
        if runs is None or runs["merged"] < runs["planned"]:
            submitted = call("--slurm", *slurm_options())
            if submitted.returncode:
                return NOT_COMPLETE if STILL_QUEUED in submitted.stderr else FAILED
            note_submission(folder, runs["merged"] if runs else 0, jobs_in(submitted.stdout))
            return NOT_COMPLETE
    if call("--json", f"{folder}.json").returncode:
        return FAILED
    submitted_file(folder).unlink(missing_ok=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
