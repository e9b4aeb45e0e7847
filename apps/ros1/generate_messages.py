# SPDX-License-Identifier: Apache-2.0
"""Makes C++ headers and Python modules of the message definitions in msgs/, by the generators that ROS 1 ships.

generate_messages.py MSGS OUT: MSGS/PACKAGE/{msg,action,srv}/*; OUT/include/PACKAGE/*.h, OUT/python/PACKAGE/{msg,srv}.
"""
import glob
import os
import subprocess
import sys


def run(*command):
    done = subprocess.run([sys.executable, *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stdout}")


def main():
    source, out = sys.argv[1:]
    packages = sorted(os.listdir(source))
    made = {p: os.path.join(out, "definitions", p) for p in packages}
    for package in packages:
        os.makedirs(made[package], exist_ok=True)
        for action in sorted(glob.glob(f"{source}/{package}/action/*.action")):
            run("/usr/lib/actionlib_msgs/genaction.py", action, "-o", made[package])
    search = [f"-I{path.split('/')[3]}:{path}" for path in sorted(glob.glob("/usr/share/*/msg"))]
    for package in packages:
        search += [f"-I{package}:{source}/{package}/msg", f"-I{package}:{made[package]}"]
    for package in packages:
        messages = sorted(glob.glob(f"{source}/{package}/msg/*.msg") + glob.glob(f"{made[package]}/*.msg"))
        services = sorted(glob.glob(f"{source}/{package}/srv/*.srv"))
        headers = f"{out}/include/{package}"
        os.makedirs(headers, exist_ok=True)
        for file in messages + services:
            run("/usr/lib/gencpp/gen_cpp.py", file, "-p", package, "-o", headers, "-e", "/usr/share/gencpp", *search)
        for kind, files in (("msg", messages), ("srv", services)):
            if not files:
                continue
            folder = f"{out}/python/{package}/{kind}"
            os.makedirs(folder, exist_ok=True)
            generator = f"/usr/lib/genpy/gen{kind}_py.py"
            run(generator, "-p", package, "-o", folder, *search, *files)
            run(generator, "--initpy", "-p", package, "-o", folder)
        open(f"{out}/python/{package}/__init__.py", "w").close()


if __name__ == "__main__":
    main()
