# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""`pip install .` and `pip wheel .` of the built tree: what the wheel holds, and that it runs alone."""

import hashlib
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

SOURCE = pathlib.Path(os.environ["PALMAR_SOURCE"])


def run(*words, **more):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    if done.returncode != 0:
        raise AssertionError(f"{words}: {done.stdout}\n{done.stderr}")
    return done.stdout


class Wheel(unittest.TestCase):
    def test_it_installs_into_a_venv_and_runs_without_the_build_directory(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            try:
                run(sys.executable, "-m", "venv", "--system-site-packages", folder / "venv")
            except AssertionError:
                self.skipTest("python3-venv isn't installed")
            python = folder / "venv" / "bin" / "python"
            alone = {name: value for name, value in os.environ.items()
                     if not name.startswith("PALMAR") and name != "PYTHONPATH"}
            offline = {**alone, "PALMAR_BUILD_DIR": os.environ["PALMAR_BUILD_DIR"],
                       "PIP_NO_INDEX": "1", "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
            for number in (1, 2):
                run(python, "-m", "pip", "wheel", "--no-deps", "-w", folder / str(number), SOURCE,
                    env=offline, cwd=folder)
            first, second = (next((folder / str(number)).glob("*.whl")) for number in (1, 2))
            self.assertEqual(hashlib.sha256(first.read_bytes()).digest(),
                             hashlib.sha256(second.read_bytes()).digest())
            names = zipfile.ZipFile(first).namelist()
            for needed in ("palmar/share/palmar/template.hand.glb", "palmar/bin/palmar-cad",
                           "palmar/share/palmar/template.compliance", "palmar/py.typed",
                           "palmar/_native.pyi", "palmar/licences/LICENSE",
                           "palmar/licences/third-party.md",
                           "palmar/share/palmar/generic-hand-LICENSE"):
                self.assertIn(needed, names)
            run(python, "-m", "pip", "install", "--no-build-isolation", SOURCE, env=offline, cwd=folder)
            # Of other packages of the system pip may have something to say.
            checked = subprocess.run([python, "-m", "pip", "check"], capture_output=True, text=True,
                                     env=offline)
            self.assertNotIn("palmar", checked.stdout + checked.stderr)
            script = ("import palmar; print(palmar.__file__);"
                      # A bottle is made by the child program palmar-cad.
                      "bottle = palmar.product.make('bottle', out='bottle.step');"
                      "print(palmar.assess('bottle.step').sentence)")
            text = run(python, "-c", script, cwd=folder, env=alone)
            self.assertTrue(text.startswith(str(folder)), text)
            run(python, "-m", "pip", "uninstall", "-y", "palmar", env=offline)
            left = list((folder / "venv").rglob("palmar*"))
            self.assertEqual(left, [])


if __name__ == "__main__":
    unittest.main()
