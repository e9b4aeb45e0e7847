#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the bill of materials of a Debian package in SPDX 2.3 (JSON): libraries that its programs link, libraries whose headers
were compiled in, and what the page in web/dist is made of.

Usage: sbom.py STAGE PACKAGE VERSION EPOCH BUILD. STAGE has the files of the package, BUILD is the folder of Ninja that made them."""
import json
import os
import pathlib
import re
import subprocess
import sys
import time
import uuid

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE_LIBRARIES = ("three", "three-mesh-bvh")  # dependencies of web/package.json


def lines_of(*command):
    return subprocess.run(command, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"}).stdout.splitlines()


def is_elf(path):
    with open(path, "rb") as file:
        return file.read(4) == b"\x7fELF"


def bits_of(path):
    """Returns the class of an ELF file: 1 for 32 bits, 2 for 64."""
    with open(path, "rb") as file:
        return file.read(5)[-1]


def owners_of(paths):
    """Returns the Debian packages that own the files, with usrmerge undone where the database has the old name."""
    wanted = sorted({*paths, *(path.removeprefix("/usr") for path in paths if path.startswith("/usr/lib"))})
    owners = set()
    for begin in range(0, len(wanted), 500):
        for line in lines_of("dpkg-query", "-S", *wanted[begin:begin + 500]):
            owners |= {name.split(":")[0] for name in line.rsplit(": ", 1)[0].split(", ")}
    return owners


def linked_packages(stage):
    """Packages of the shared libraries that the programs and modules name themselves (NEEDED)."""
    places = {}  # of this machine's width alone: those of 32 bits have the same names
    for line in lines_of("/sbin/ldconfig", "-p"):
        path = os.path.realpath(line.split()[-1])
        if "=>" in line and os.path.exists(path) and bits_of(path) == bits_of(sys.executable):
            places.setdefault(line.split()[0], path)
    needed = set()
    for path in stage.rglob("*"):
        if path.is_file() and not path.is_symlink() and is_elf(path):
            needed |= {line.split()[1] for line in lines_of("objdump", "-p", str(path)) if line.strip().startswith("NEEDED")}
    return owners_of({places[name] for name in needed if name in places})


def compiled_packages(build, folders):
    """Packages of the headers that the objects below these folders were compiled from, as Ninja keeps them."""
    headers, of_package = set(), False
    for line in lines_of("ninja", "-C", str(build), "-t", "deps"):
        if line.startswith("    "):
            if of_package and line.startswith("    /usr/include/"):
                headers.add(line.strip())
        elif line:
            of_package = line.startswith(folders)
    return owners_of(headers)


def page_libraries():
    lock = json.loads((ROOT / "web/package-lock.json").read_text())["packages"]
    return [(name, lock[f"node_modules/{name}"]["version"]) for name in PAGE_LIBRARIES]


def entry(identifier, name, version, license_text, locator):
    result = {"SPDXID": f"SPDXRef-{re.sub(r'[^A-Za-z0-9.-]', '-', identifier)}", "name": name, "versionInfo": version,
              "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": license_text,
              "licenseDeclared": license_text, "copyrightText": "NOASSERTION"}
    if locator:
        result["externalRefs"] = [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": locator}]
    return result


def bill(stage, package, version, epoch, build):
    own = entry(package, package, version, "Apache-2.0", f"pkg:deb/{package}@{version}")
    packages, relations = [own], [("SPDXRef-DOCUMENT", "DESCRIBES", own["SPDXID"])]

    def relate(found, kind):
        if found["SPDXID"] not in {known["SPDXID"] for known in packages}:
            packages.append(found)
        relations.append((own["SPDXID"], kind, found["SPDXID"]))

    folders = {"saccade": ("apps/cli", "apps/reproduce", "apps/server", "devices", "lib", "bench/thesis"), "libsaccade-dev": ("lib",),
               "python3-saccade": ("apps/python", "lib"), "saccade-ros1": ("apps/ros1", "lib"),
               "saccade-ros2": ("apps/ros2", "lib")}[package]
    embedded = {"fonts-dejavu-core"} if package in ("saccade", "libsaccade-dev") else set()  # the pictures' font
    for kind, names in (("DYNAMIC_LINK", linked_packages(stage)), ("GENERATED_FROM", compiled_packages(build, folders)),
                        ("CONTAINS", embedded)):
        for name in sorted(names):
            (found,) = lines_of("dpkg-query", "-W", "-f", "${Version}\\n", name)[:1]
            relate(entry(f"deb-{name}", name, found, "NOASSERTION", f"pkg:deb/debian/{name}@{found}"), kind)
    if package == "saccade":
        for name, found in page_libraries():
            relate(entry(f"npm-{name}", name, found, "MIT", f"pkg:npm/{name}@{found}"), "CONTAINS")
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"{package}-{version}",
            "documentNamespace": f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, f'{package}-{version}-{epoch}')}",
            "creationInfo": {"created": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(epoch)),
                             "creators": ["Tool: packaging/sbom.py"]},
            "packages": packages,
            "relationships": [{"spdxElementId": source, "relationshipType": kind, "relatedSpdxElement": target}
                              for source, kind, target in relations]}


def write_bill(stage, package, version, epoch, build):
    target = pathlib.Path(stage) / f"usr/share/doc/{package}/{package}.spdx.json"
    target.write_text(json.dumps(bill(pathlib.Path(stage), package, version, epoch, build), indent=1) + "\n")


if __name__ == "__main__":
    write_bill(sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4]), sys.argv[5])
