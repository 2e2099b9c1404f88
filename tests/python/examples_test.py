# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Examples, the documents' code blocks and the notebook run as they stand."""

import contextlib
import importlib.util
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import palmar

SOURCE = pathlib.Path(os.environ["PALMAR_SOURCE"])
EXAMPLES = SOURCE / "examples" / "python"


def is_there(module):
    return importlib.util.find_spec(module) is not None


def run(*words, cwd):
    done = subprocess.run([sys.executable, *map(str, words)], cwd=cwd, capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{words}: {done.stderr}")
    return done.stdout


class Examples(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_the_first_one(self):
        # The sharp edges of a square handle press harder at the same grip force (Xie 2014, 5.5.3).
        text = run(EXAMPLES / "first.py", cwd=self.folder)
        peaks = [float(one) for one in re.findall(r"hardest ([0-9.]+) MPa", text)]
        self.assertEqual(len(peaks), 2)
        self.assertLess(peaks[0], peaks[1])

    @unittest.skipUnless(is_there("matplotlib"), "matplotlib isn't installed")
    def test_chapter_5_has_at_most_40_lines_of_code_and_its_order_of_peaks(self):
        text = (EXAMPLES / "chapter5.py").read_text()
        code = text[text.index('"""', 3) + 3:]
        self.assertLessEqual(len([line for line in code.splitlines() if line.strip()]), 40)
        print(run(EXAMPLES / "chapter5.py", self.folder / "out", 8, cwd=self.folder))
        self.assertTrue((self.folder / "out" / "chapter5.png").read_bytes().startswith(b"\x89PNG"))
        # Thesis, fig. 5-15: sharp edges press hardest, the redesign least, in the same posture.
        peaks = []
        for folder in ("fillet10", "redesign1"):
            grasps = palmar.study.grasps(self.folder / "out" / folder / "redesign.palmar")
            is_first = grasps["product"] == grasps["product"][0]
            peaks += [grasps["peak_pressure_cells_mpa"][is_first].mean(),
                      grasps["peak_pressure_cells_mpa"][~is_first].mean()]
        self.assertGreater(peaks[0], peaks[1])
        self.assertGreater(peaks[1], peaks[3])

    @unittest.skipUnless(is_there("nbclient") and is_there("ipykernel"),
                         "nbclient or ipykernel isn't installed")
    def test_the_notebook(self):
        import nbclient
        import nbformat

        notebook = nbformat.read(EXAMPLES / "palmar.ipynb", as_version=4)
        self.assertTrue(all(not cell.get("outputs") for cell in notebook.cells))
        nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3",
                                resources={"metadata": {"path": str(self.folder)}}).execute()

    def test_the_documents_code_runs(self):
        # Indented blocks of the page are one session, in a folder with a handle.
        page = (SOURCE / "docs" / "using" / "python.md").read_text()
        blocks = re.findall(r"```python\n(.*?)```", page, flags=re.S)
        self.assertGreater(len(blocks), 8)
        palmar.product.make("prism", fillet_mm=3, out=self.folder / "handle.stl")
        palmar.product.make("cylinder", diameter_mm=35, out=self.folder / "other.stl")
        session = {}
        before = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)
        for block in blocks:
            if "pandas" in block and not is_there("pandas"):
                continue
            if "matplotlib" in block and not is_there("matplotlib"):
                continue
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
                exec(compile(block, "python.md", "exec"), session)  # noqa: S102


if __name__ == "__main__":
    unittest.main()
