# SPDX-License-Identifier: Apache-2.0
"""python3 -m saccade: the program, from beside the package or from PATH."""
import os
import pathlib
import shutil
import sys


def main():
    here = pathlib.Path(__file__).resolve().parent
    beside = [here / "bin" / "saccade", here.parent.parent / "saccade"]
    program = next((str(path) for path in beside if path.is_file() and os.access(path, os.X_OK)), shutil.which("saccade"))
    if program is None:
        sys.exit("saccade: the program is neither beside the package nor in PATH")
    os.execv(program, [program, *sys.argv[1:]])


if __name__ == "__main__":
    main()
