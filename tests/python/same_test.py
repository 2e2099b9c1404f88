# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""The module gives what the command line gives: the same JSON, the same bytes of a study."""

import csv
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import palmar


def command(*words):
    run = subprocess.run([os.environ["PALMAR"], *map(str, words)], check=True, capture_output=True,
                         text=True)
    return json.loads(run.stdout)


class Products(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.prism = self.folder / "prism.stl"
        palmar.product.make("prism", fillet_mm=3, out=self.prism)
        self.cylinder = self.folder / "cylinder.stl"
        palmar.product.make("cylinder", diameter_mm=35, out=self.cylinder)


class SameStudy(Products):
    def test_a_study_is_the_same_file_and_its_tables_are_the_exported_ones(self):
        theirs = self.folder / "theirs.palmar"
        command("study", "run", "--product", self.cylinder, "--product", self.prism, "--unit", "mm",
                "--population", "ansur2_women", "--hands", 3, "--out", theirs, "--json")
        ours = palmar.study.run(products=[self.cylinder, self.prism], unit="mm",
                                population="ansur2_women", hands=3, out=self.folder / "ours.palmar")
        self.assertEqual(pathlib.Path(ours).read_bytes(), theirs.read_bytes())

        palmar.study.export(ours, self.folder / "tables")
        grasps = palmar.study.grasps(ours)
        with open(self.folder / "tables" / "grasps.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 6)
        for key in ("force_n", "contact_area_mm2", "peak_pressure_cells_mpa"):
            self.assertEqual([float(row[key]) for row in rows], grasps[key].tolist())
        self.assertEqual([row["product"] for row in rows], grasps["product"].tolist())

        compared = command("study", "compare", theirs, "--json")
        found = palmar.study.statistics(ours)
        self.assertEqual(found["sentence"], compared["verdict"]["sentence"])
        pair = compared["conditions"][0]["quantities"][0]["pairs"][0]
        table = found["comparison"]
        row = table["quantity"].tolist().index("peak_pressure_cells_mpa")
        self.assertEqual(table["mean_first"][row], pair["mean_first"])
        self.assertEqual(palmar.study.status(ours)["stores"][0]["state"], "finished")


class SameFigures(Products):
    """Minutes together: before a release."""

    def test_an_assessment_is_the_same_json(self):
        theirs = command("assess", self.cylinder, self.prism, "--person", "woman:P5", "--toward", "up",
                         "--mass-kg", 0.5, "--unit", "mm", "--seed", 7, "--json")
        ours = palmar.assess(self.cylinder, self.prism, unit="mm", person="woman:P5", mass_kg=0.5,
                             toward="up", seed=7).record
        self.assertEqual(ours.pop("command_line") + " --json", theirs.pop("command_line"))
        self.assertEqual(ours, theirs)

    def test_the_thesis_preset_is_the_same_json(self):
        theirs = command("assess", self.prism, "--unit", "mm", "--preset", "xie2014", "--json")
        ours = palmar.assess(self.prism, unit="mm", preset="xie2014").record
        theirs.pop("command_line"), ours.pop("command_line")
        self.assertEqual(ours, theirs)

    def test_a_press_and_a_fingertip_are_the_same_numbers(self):
        theirs = command("contact", "press", "--specimen", "template:middle_distal", "--indenter",
                         "sphere:6", "--depth-mm", "1,2", "--json")["steps"]
        ours = palmar.contact.press("sphere:6", specimen="template:middle_distal", depth_mm=[1, 2])
        for key in ("depth_mm", "force_n", "contact_area_mm2", "peak_pressure_mpa"):
            self.assertEqual(ours[key].tolist(), [step[key] for step in theirs])
        self.assertEqual(
            palmar.effort.fingertip("middle", posture_deg={"mcp": 40, "pip": 55.5}, tendon="fdp"),
            command("effort", "fingertip", "--finger", "middle", "--posture", "mcp=40,pip=55.5",
                    "--tendon", "fdp", "--json"))



if __name__ == "__main__":
    unittest.main()
