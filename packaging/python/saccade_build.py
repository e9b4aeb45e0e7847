# SPDX-License-Identifier: Apache-2.0
"""The back end of pip install . (PEP 517): CMake builds the module and the program, and a wheel is packed of both.

The standard library is all that it needs. Its one setting is `build-dir`, the folder that CMake builds in (build/wheel); a
folder that was configured before keeps its options:  pip install . --config-settings build-dir=build/release"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from wheel_file import Metadata, WheelFile, wheel_tag
from source_archive import write_source_archive

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DEBIAN = "scripts/install_packages.sh program; apt-get install python3-dev pybind11-dev"
DEFAULT_BUILD = "build/wheel"


class BuildError(Exception):
    """Says what is missing, and what to install."""


def get_requires_for_build_wheel(config_settings=None):
    return []


def get_requires_for_build_sdist(config_settings=None):
    return []


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    metadata = Metadata.read(ROOT)
    folder = pathlib.Path(metadata_directory) / metadata.info_folder
    folder.mkdir()
    for name, text in metadata.files().items():
        (folder / name).write_text(text)
    return metadata.info_folder


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    try:
        check_tools()
        build = build_programs((config_settings or {}).get("build-dir") or DEFAULT_BUILD)
        with tempfile.TemporaryDirectory() as folder:
            return pack(build, pathlib.Path(folder), pathlib.Path(wheel_directory))
    except BuildError as error:
        sys.exit(f"\nsaccade: {error}\n")


def build_sdist(sdist_directory, config_settings=None):
    return write_source_archive(ROOT, Metadata.read(ROOT), pathlib.Path(sdist_directory))


def check_tools():
    cmake = shutil.which("cmake")
    if cmake is None:
        raise BuildError(f"CMake 3.25 or later is not in PATH. Install it; on Debian: apt-get install cmake, or all at once: {DEBIAN}")
    found = re.search(r"(\d+)\.(\d+)", subprocess.run([cmake, "--version"], capture_output=True, text=True).stdout)
    if found is None or (int(found[1]), int(found[2])) < (3, 25):
        raise BuildError(f"CMake 3.25 or later is needed; {cmake} is {found[0] if found else 'no CMake'}")
    compiler = os.environ.get("CXX", "").split()
    if not any(shutil.which(name) for name in (compiler[:1] or ["c++", "g++", "clang++"])):
        raise BuildError(f"no C++20 compiler: {compiler[0] if compiler else 'c++, g++ and clang++'} not in PATH. "
                         f"Install one; on Debian: apt-get install g++, or all at once: {DEBIAN}")


def run(command, what):
    """Runs a command whose output pip shows with -v; of a failure, the lines that say why."""
    print("+", " ".join(map(str, command)), flush=True)
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(done.stdout, flush=True)
    if done.returncode != 0:
        raise BuildError(f"{what} failed:\n{reason_of(done.stdout)}")


def reason_of(output):
    """The first error of CMake or the compiler, and what to install where a package was not found."""
    errors = re.search(r"CMake Error.*?(?=\n\n\S|\nCall Stack|\Z)", output, re.DOTALL) or re.search(r".*error:.*", output)
    text = errors[0].strip() if errors else "\n".join(output.splitlines()[-15:])
    missing = [line for line in output.splitlines() if "is left out, for lack of" in line]
    return "\n".join([text, *missing, f"What is needed stands in packages.txt; on Debian: {DEBIAN}"])


def build_programs(folder):
    """Configures the folder, unless it was, and builds; returns its path."""
    build = ROOT / folder
    if not (build / "CMakeCache.txt").exists():
        ninja = ["-G", "Ninja"] if shutil.which("ninja") else []
        run(["cmake", "-S", ROOT, "-B", build, *ninja, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON",
             "-DCMAKE_UNITY_BUILD_BATCH_SIZE=16", "-DSACCADE_BUILD_TESTS=OFF", "-DSACCADE_BUILD_EXAMPLES=OFF",
             "-DSACCADE_ROS1=OFF", "-DSACCADE_ROS2=OFF", "-DSACCADE_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}"],
            "configuring")
    run(["cmake", "--build", build, "--target", "saccade", "saccade-reproduce", "saccade_python", "-j", str(jobs())], "building")
    return build


def jobs():
    """One compiler takes up to 1.5 GB: cores that have as much memory."""
    memory = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return max(1, min(len(os.sched_getaffinity(0)), int(memory / 1.5e9)))


def pack(build, stage, wheel_directory):
    run(["cmake", "--install", build, "--component", "python", "--prefix", stage, "--strip"], "installing the module")
    package = stage / "lib/python3/dist-packages/saccade"
    if not list(package.glob("_saccade*.so")):
        raise BuildError(f"{build} has no Python module; it was configured without")
    module = next(package.glob("_saccade*.so"))
    suffixes = __import__("importlib.machinery").machinery.EXTENSION_SUFFIXES
    if not any(module.name == f"_saccade{suffix}" for suffix in suffixes):
        raise BuildError(f"{build} has {module.name}, the module for another Python than {sys.executable}")
    (package / "bin").mkdir()
    for program in ("saccade", "saccade-reproduce"):  # the first starts the second
        shutil.copy2(build / program, package / "bin" / program)
        if shutil.which("strip"):
            run(["strip", package / "bin" / program], f"stripping {program}")
    metadata = Metadata.read(ROOT)
    wheel_directory.mkdir(parents=True, exist_ok=True)
    name = f"{metadata.name}-{metadata.version}-{wheel_tag()}.whl"
    with WheelFile(wheel_directory / name, metadata) as wheel:
        for path in sorted(package.rglob("*")):
            if path.is_file():
                wheel.add(f"saccade/{path.relative_to(package).as_posix()}", path.read_bytes(), runs=os.access(path, os.X_OK))
    return name
