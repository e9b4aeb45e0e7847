# SPDX-License-Identifier: Apache-2.0
"""A roscore on a free port with folders of its own, nodes under test, and the stock Python clients beside them."""
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

SKIPPED = 77


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Session:
    """Starts a master; `program` is saccade-ros1, `python` the folder of its generated messages."""

    def __init__(self, program, python):
        for tool in ("rosmaster", "rostopic", "rosservice"):
            if shutil.which(tool) is None:
                skip(f"{tool} is not there (packages.txt, ros)")
        self.program = program
        self.folder = tempfile.mkdtemp(prefix="saccade-ros1-")
        self.port = free_port()
        os.environ.update(ROS_MASTER_URI=f"http://127.0.0.1:{self.port}", ROS_IP="127.0.0.1", ROS_HOME=self.folder,
                          ROS_LOG_DIR=self.folder, PYTHONPATH=python, ROSCONSOLE_FORMAT="${severity}: ${message}")
        os.environ.pop("ROS_HOSTNAME", None)
        sys.path.insert(0, python)
        self.processes = []
        self.start_master()

    def start_master(self):
        """Processes started by roscore: its children would outlive it."""
        self.core = self.start(["rosmaster", "--core", "-p", str(self.port)], "rosmaster")
        self.until(self.has_master, 20, "rosmaster did not start")

    def has_master(self):
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    def start(self, command, name):
        with open(os.path.join(self.folder, name + ".out"), "ab") as log:
            process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
        self.processes.append(process)
        return process

    def node(self, name, *arguments):
        return self.start([self.program, name, *arguments], name)

    def log(self, name):
        with open(os.path.join(self.folder, name + ".out"), errors="replace") as file:
            return file.read()

    def run(self, *command):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=20)
        return done.stdout

    @staticmethod
    def until(true, seconds, otherwise):
        end = time.time() + seconds
        while not true():
            if time.time() > end:
                raise AssertionError(otherwise)
            time.sleep(0.01)

    def close(self):
        for process in reversed(self.processes):
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


def run_tests(test_class, node):
    """Runs this program's tests with a session of their own; shows what the node said where one fails. Does not return."""
    import rospy
    test_class.session = Session(*sys.argv[1:3])
    good = False
    try:
        done = unittest.main(argv=sys.argv[:1] + sys.argv[3:], exit=False, warnings="ignore")
        good = done.result.wasSuccessful()
        if not good:
            print(test_class.session.log(node)[-4000:])
    finally:
        rospy.signal_shutdown("done")
        test_class.session.close()
    os._exit(0 if good else 1)
