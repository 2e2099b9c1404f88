# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Redesigns and the largest grip force, which take longer."""

import pathlib
import tempfile
import unittest

import numpy as np
import palmar

PRISM = "made: prism width_mm=35 depth_mm=35 length_mm=130 fillet_mm=3"


class Redesigns(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_a_pressed_shape_lies_within_the_original(self):
        pressed = palmar.redesign.press(PRISM, self.folder / "pressed", hands=4, largest_depth_mm=3,
                                        compare=False, pictures=False)
        vertices = pressed["vertices_mm"]
        original = palmar.product.make("prism", width_mm=35, depth_mm=35, length_mm=130, fillet_mm=3)
        self.assertLessEqual(np.abs(vertices[:, :2]).max(), 17.5 + 1e-6)
        read = palmar.product.read(pressed["file"], unit="mm")
        self.assertLess(read.volume_mm3, original.volume_mm3)
        self.assertIsInstance(pressed["record"], dict)

    def test_a_rounder_edge_presses_less(self):
        made = palmar.redesign.fillet(PRISM, self.folder / "fillet", radius_mm=10, hands=6)
        table = made["comparison"]
        row = table["quantity"].tolist().index("peak_pressure_cells_mpa")
        self.assertLess(table["mean_second"][row], table["mean_first"][row])
        self.assertTrue(made["sentence"])
        self.assertTrue(pathlib.Path(made["file"]).exists())
        self.assertTrue(pathlib.Path(made["report"]).exists())

    def test_an_unknown_argument_is_a_type_error(self):
        with self.assertRaises(TypeError):
            palmar.redesign.shape(PRISM, self.folder, grip_force=3)

    def test_a_stronger_person_grips_harder(self):
        handle = palmar.product.make("cylinder", diameter_mm=35)
        weak, strong = (palmar.effort.capacity(handle, strength_n=n)["grip_force_n"] for n in (200, 400))
        self.assertLess(weak, strong)
        muscles = palmar.effort.grasp(handle, grip_force_n=40)
        self.assertEqual(len(muscles["digits"]), 5)


if __name__ == "__main__":
    unittest.main()
