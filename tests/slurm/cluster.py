# SPDX-License-Identifier: Apache-2.0
"""Slurm with two nodes on this machine: munged, slurmctld and two slurmd in a folder of their own."""
import getpass
import os
import pathlib
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
TOOLS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "sinfo", "scontrol")


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def find(tool):
    return shutil.which(tool, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")


def free_ports(count):
    probes = [socket.socket() for _ in range(count)]
    for probe in probes:
        probe.bind(("127.0.0.1", 0))
    ports = [probe.getsockname()[1] for probe in probes]
    for probe in probes:
        probe.close()
    return ports


def until(condition, seconds, what):
    """Waits for the condition, and returns what it gives."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        result = condition()
        if result:
            return result
        time.sleep(0.2)
    raise AssertionError(f"{what} within {seconds} s")


def children_of(process_id):
    """The processes below one, deepest last."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and (entry / "stat").read_text().rpartition(")")[2].split()[1] == str(process_id):
                found += [int(entry.name), *children_of(int(entry.name))]
        except (FileNotFoundError, ProcessLookupError):
            pass  # it has ended meanwhile
    return found


class Cluster:
    """A context: everything that it starts has ended when it is left."""

    def __init__(self):
        for tool in TOOLS:
            if find(tool) is None:
                skip(f"{tool} is not there (packages.txt, slurm)")
        if os.geteuid() != 0:
            skip("slurmd starts tasks as root only")
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="saccade-slurm-"))
        self.folder.chmod(0o755)  # munged refuses a socket that others cannot reach
        self.daemons = {}

    def __enter__(self):
        try:
            self.start_all()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        # Jobs first: their step daemons outlive their slurmd.
        for process_id in self.steps():
            self.kill(process_id)
        for process in reversed(self.daemons.values()):
            process.terminate()
        for process in reversed(self.daemons.values()):
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        for process_id in self.steps():
            self.kill(process_id)
        shutil.rmtree(self.folder, ignore_errors=True)

    def start_all(self):
        for name in ("munge", "state", "spool-one", "spool-two"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(secrets.token_bytes(32))
        key.chmod(0o600)
        control, one, two = free_ports(3)
        values = {"FOLDER": self.folder, "USER": getpass.getuser(), "CONTROL_PORT": control, "PORT_ONE": one, "PORT_TWO": two}
        text = (pathlib.Path(__file__).parent / "slurm.conf.in").read_text()
        for name, value in values.items():
            text = text.replace(f"@{name}@", str(value))
        (self.folder / "slurm.conf").write_text(text)
        os.environ["SLURM_CONF"] = str(self.folder / "slurm.conf")
        munge = self.folder / "munge"
        self.start("munged", "--foreground", f"--key-file={key}", f"--socket={munge}/socket", f"--pid-file={munge}/pid",
                   f"--log-file={munge}/log", f"--seed-file={munge}/seed", "--force")
        until((munge / "socket").exists, 10, "munged starts")
        self.start("slurmctld", "-D")
        self.start_node("one")
        self.start_node("two")
        until(lambda: self.states() == {"one": "idle", "two": "idle"}, 30, "both nodes are idle")

    def start(self, tool, *arguments, name=None):
        with open(self.folder / f"{name or tool}.out", "ab") as log:
            self.daemons[name or tool] = subprocess.Popen([find(tool), *arguments], stdout=log, stderr=log,
                                                          stdin=subprocess.DEVNULL, start_new_session=True)

    def start_node(self, node):
        self.start("slurmd", "-D", "-N", node, name=node)

    def kill(self, process_id):
        try:
            os.kill(process_id, signal.SIGKILL)
        except ProcessLookupError:
            pass

    def steps(self):
        """Step daemons of this cluster, with the tasks below them."""
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            try:
                command = (entry / "cmdline").read_bytes()
                environment = (entry / "environ").read_bytes()
            except (FileNotFoundError, ProcessLookupError, PermissionError):
                continue
            if str(self.folder).encode() in environment and (b"slurmstepd" in command or b"SLURM_JOB_ID=" in environment):
                found.append(int(entry.name))
        return found

    def lose_node(self, node):
        """As a power cut: its daemon, and all that it had started, are gone. Returns how many tasks it had."""
        daemon = self.daemons.pop(node)
        daemon.kill()
        daemon.wait()
        lost = [process_id for process_id, where in self.tasks() if where == node]
        steps = [step for step in self.steps() if set(children_of(step)) & set(lost)]
        for process_id in [*steps, *lost]:  # a step daemon would say that its task has failed
            self.kill(process_id)
        return len(lost)

    @staticmethod
    def node_of(process_id):
        """The node that a task runs on, as its environment says."""
        try:
            environment = pathlib.Path(f"/proc/{process_id}/environ").read_bytes().split(b"\0")
        except (FileNotFoundError, ProcessLookupError):
            return None
        return next((entry.partition(b"=")[2].decode() for entry in environment if entry.startswith(b"SLURMD_NODENAME=")), None)

    def tasks(self):
        """The processes of tasks, without the scripts that wait for them: (process, node)."""
        return [(process_id, self.node_of(process_id)) for process_id in self.steps()
                if self.node_of(process_id) and not self.is_script(process_id)]

    @staticmethod
    def is_script(process_id):
        try:
            return os.path.basename(os.readlink(f"/proc/{process_id}/exe")) == "bash"
        except FileNotFoundError:
            return True  # it has ended

    def states(self):
        output = subprocess.run([find("sinfo"), "--noheader", "--Node", "--format", "%N %T"], capture_output=True, text=True)
        return dict(line.split() for line in output.stdout.splitlines())

    def is_done(self):
        """Whether nothing is queued or running. Slurm lets a task that it queues again wait for two minutes; here it need not."""
        output = subprocess.run([find("squeue"), "--noheader", "--array", "--format", "%i %T %r"], capture_output=True, text=True)
        lines = [line.split(maxsplit=2) for line in output.stdout.splitlines()]  # a reason may have blanks
        for job, _, reason in lines:
            if reason == "BeginTime":
                subprocess.run([find("scontrol"), "update", f"JobId={job}", "StartTime=now"], capture_output=True)
        return output.returncode == 0 and not lines

    def logs(self):
        queue = subprocess.run([find("squeue"), "--array", "--format", "%i %T %N %r %S"], capture_output=True, text=True).stdout
        return queue + "\n".join(f"--- {path.name}\n{path.read_text()[-3000:]}" for path in sorted(self.folder.glob("*.out")))
