# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Builds the wheel of palmar with CMake (PEP 517); `pip install .` and `pip wheel .` call it.

PALMAR_BUILD_DIR names a build directory that is built already; without it one is made in
build/python, which takes as long as ./demo does. Nothing else is needed than what scripts/setup.sh
installs; pip downloads nothing.
"""

from __future__ import annotations

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TARGETS = ["palmar_python", "palmar_template", "palmar-cad"]
FIRST_TIME = (1980, 1, 1, 0, 0, 0)  # of every file: same input, same bytes


def _run(*command: object) -> None:
    subprocess.run([str(word) for word in command], cwd=ROOT, check=True)


def _project() -> dict:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    version = re.search(r"project\(palmar VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    return {**project, "version": version[1]}


def _metadata() -> str:
    project = _project()
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {project['version']}",
             f"Summary: {project['description']}", f"License: {project['license']}",
             f"Requires-Python: {project['requires-python']}",
             "Description-Content-Type: text/markdown"]
    lines += [f"Requires-Dist: {one}" for one in project["dependencies"]]
    return "\n".join(lines) + "\n\n" + (ROOT / project["readme"]).read_text()


def _tag() -> str:
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _build() -> Path:
    given = os.environ.get("PALMAR_BUILD_DIR")
    if given:
        return Path(given)
    if not (ROOT / "node_modules").is_dir():
        _run("npm", "ci", "--no-audit", "--no-fund")
    folder = ROOT / "build" / "python"
    _run("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
         "-DPALMAR_PRECOMPILE=ON", "-DPALMAR_TESTS=OFF", "-DPALMAR_BENCHMARKS=OFF",
         f"-DPython_EXECUTABLE={sys.executable}")
    _run("cmake", "--build", folder, "--target", *TARGETS)
    return folder


class _Wheel:
    def __init__(self, path: Path) -> None:
        self.zip = zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED)
        self.record = []

    def add(self, name: str, data: bytes, mode: int = 0o644) -> None:
        info = zipfile.ZipInfo(name, FIRST_TIME)
        info.external_attr = (0o100000 | mode) << 16
        self.zip.writestr(info, data, zipfile.ZIP_DEFLATED)
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        self.record.append(f"{name},sha256={digest},{len(data)}")

    def close(self, info: str) -> None:
        self.record.append(f"{info}/RECORD,,")
        self.zip.writestr(zipfile.ZipInfo(f"{info}/RECORD", FIRST_TIME),
                          "\n".join(self.record) + "\n", zipfile.ZIP_DEFLATED)
        self.zip.close()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    folder = _build()
    project = _project()
    name = f"{project['name']}-{project['version']}"
    wheel = _Wheel(Path(wheel_directory) / f"{name}-{_tag()}.whl")
    with tempfile.TemporaryDirectory() as staged:
        _run("cmake", "--install", folder, "--component", "python", "--strip", "--prefix", staged)
        for path in sorted(Path(staged).rglob("*")):
            if path.is_file():
                mode = 0o755 if os.access(path, os.X_OK) else 0o644
                wheel.add(path.relative_to(staged).as_posix(), path.read_bytes(), mode)
    info = f"{name}.dist-info"
    wheel.add(f"{info}/METADATA", _metadata().encode())
    wheel.add(f"{info}/WHEEL", ("Wheel-Version: 1.0\nGenerator: palmar\nRoot-Is-Purelib: false\n"
                                f"Tag: {_tag()}\n").encode())
    wheel.add(f"{info}/LICENSE", (ROOT / "LICENSE").read_bytes())
    wheel.close(info)
    return f"{name}-{_tag()}.whl"


def build_sdist(sdist_directory, config_settings=None):
    project = _project()
    name = f"{project['name']}-{project['version']}"
    files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True)
    with tarfile.open(Path(sdist_directory) / f"{name}.tar.gz", "w:gz") as archive:
        for path in filter(None, files.stdout.decode().split("\0")):
            archive.add(ROOT / path, f"{name}/{path}")
        with tempfile.NamedTemporaryFile("w", suffix="PKG-INFO") as metadata:
            metadata.write(_metadata())
            metadata.flush()
            archive.add(metadata.name, f"{name}/PKG-INFO")
    return f"{name}.tar.gz"
