# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Values, arrays, errors, messages. Truth: closed forms and what the documents state."""

import gc
import json
import logging
import math
import os
import pathlib
import tempfile
import unittest

import numpy as np
import palmar


def sphere(diameter_mm=60.0):
    return palmar.product.make("sphere", diameter_mm=diameter_mm)


class Products(unittest.TestCase):
    def test_a_made_sphere_has_the_volume_and_radius_of_one(self):
        ball = sphere(60)
        self.assertAlmostEqual(ball.volume_mm3 / (math.pi / 6 * 60**3), 1.0, delta=0.005)
        radius = np.linalg.norm(ball.vertices_mm, axis=1)
        self.assertLess(np.abs(radius - 30).max(), 0.02)  # chordal error 0.01 mm
        self.assertEqual(ball.triangles.max(), len(ball.vertices_mm) - 1)
        self.assertEqual(ball.unit_source, "made")

    def test_arrays_are_views_that_keep_their_owner(self):
        vertices = sphere().vertices_mm  # the product itself is gone
        gc.collect()
        self.assertFalse(vertices.flags.owndata)
        self.assertFalse(vertices.flags.writeable)
        self.assertEqual((vertices.dtype, vertices.shape[1]), (np.float64, 3))
        self.assertAlmostEqual(np.linalg.norm(vertices, axis=1).mean(), 30, delta=0.02)
        one = sphere()
        self.assertTrue(np.shares_memory(one.vertices_mm, one.vertices_mm))

    def test_a_file_without_unit_is_read_in_the_unit_that_is_said(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "ball.stl"
            palmar.product.make("sphere", diameter_mm=60, out=file)
            with self.assertNoLogs("palmar", logging.WARNING):
                read = palmar.product.read(file, unit="mm")
            self.assertEqual((read.name, read.unit_source), ("ball", "user"))
            # A wrong unit: 6 cm, read as inches, are 1.5 m.
            large = palmar.product.read(file, unit="inch")
            self.assertAlmostEqual(np.ptp(large.vertices_mm[:, 0]), 60 * 25.4, delta=1)
            # No unit: one is proposed, and said.
            with self.assertLogs("palmar", logging.WARNING) as said:
                self.assertEqual(palmar.product.read(file).unit_source, "proposed")
            self.assertIn("mm", said.output[0])
            found = palmar.product.check(file, unit="mm")
            self.assertTrue(found["is_closed"])
            self.assertAlmostEqual(found["area_mm2"] / (math.pi * 60**2), 1, delta=0.005)

    def test_kinds_have_the_parameters_that_make_takes(self):
        prism = next(one for one in palmar.product.kinds() if one["kind"] == "prism")
        self.assertIn("fillet_mm", [one["name"] for one in prism["parameters"]])


class Hands(unittest.TestCase):
    def test_the_template_is_a_closed_surface_with_names_for_every_vertex(self):
        hand = palmar.hand.load()
        faces = hand.skin_triangles
        edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        _, uses = np.unique(edges, axis=0, return_counts=True)
        self.assertTrue((uses == 2).all())
        self.assertEqual(len(hand.segment), len(hand.skin_vertices_mm))
        self.assertEqual(set(hand.segment) >= {"palm", "thumb_distal", "little_middle"}, True)
        self.assertIn("thenar", set(hand.region))
        self.assertEqual(len(hand.joints), 16)
        self.assertAlmostEqual(hand.record["hand_length_mm"], hand.hand_length_mm)

    def test_a_left_hand_is_the_mirrored_right_one(self):
        right, left = palmar.hand.load(), palmar.hand.load(left=True)
        self.assertEqual((right.side, left.side), ("right", "left"))
        mirrored = right.skin_vertices_mm * [-1, 1, 1]
        self.assertLess(np.abs(np.sort(mirrored, axis=0)
                               - np.sort(left.skin_vertices_mm, axis=0)).max(), 1e-9)

    def test_a_person_of_a_percentile_has_the_survey_s_hand_length(self):
        # ANSUR II women (Gordon 2014): hand length, 50th percentile 181 mm, 5th 166 mm.
        self.assertAlmostEqual(palmar.hand.load(person="woman:P50").hand_length_mm, 181, delta=2)
        self.assertAlmostEqual(palmar.hand.load(person="woman:P5").hand_length_mm, 166, delta=3)

    def test_a_saved_hand_is_the_same_again(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "mine.hand.glb"
            hand = palmar.hand.load(person="man:P50")
            hand.save(file)
            np.testing.assert_array_equal(palmar.hand.load(file).skin_vertices_mm,
                                          hand.skin_vertices_mm)


class Populations(unittest.TestCase):
    def test_a_sample_has_the_population_s_mean_and_deviation(self):
        # Xie 2014, 5.4: hand length 184 +- 10.4 mm, circumference 193 +- 14.0 mm, r = 0.36.
        people = palmar.population.sample("xie2014", hands=2000, seed=3)
        length, girth = people["hand_length_mm"], people["hand_circumference_mm"]
        self.assertEqual(len(length), 2000)
        self.assertAlmostEqual(length.mean(), 184, delta=0.1)
        self.assertAlmostEqual(length.std(), 10.4, delta=0.2)
        self.assertAlmostEqual(girth.std(), 14.0, delta=0.4)
        self.assertAlmostEqual(np.corrcoef(length, girth)[0, 1], 0.36, delta=0.03)
        self.assertIn("xie2014", palmar.population.names())
        self.assertTrue(palmar.population.show("xie2014"))

    def test_a_table_of_subjects_is_described_as_numpy_does(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "people.csv"
            values = [170.0, 180.0, 185.0, 193.0]
            file.write_text("sex,hand_length_mm\n" + "".join(f"F,{v}\n" for v in values))
            table = palmar.population.describe(file)
            self.assertAlmostEqual(float(table["mean"][0]), np.mean(values))
            self.assertAlmostEqual(float(table["sd"][0]), np.std(values, ddof=1))


class Presses(unittest.TestCase):
    def test_a_sphere_on_a_plane_meets_hertz(self):
        # Hertz 1882: F = 4/3 E* sqrt(R) d^1.5 with E* = 2 G / (1 - nu), nu = 0.5.
        table = palmar.contact.press("sphere:10", depth_mm=[0.25, 0.5], shear_modulus_kpa=30)
        for depth, force in zip(table["depth_mm"], table["force_n"]):
            hertz = 4 / 3 * (2 * 0.030 / 0.5) * math.sqrt(10) * depth**1.5
            self.assertAlmostEqual(force / hertz, 1, delta=0.02)

    def test_a_fingertip_is_pressed_to_the_force_that_is_said(self):
        table = palmar.contact.press("plane", specimen="template:middle_distal", tilt_deg=30, force_n=1)
        self.assertAlmostEqual(float(table["force_n"][0]), 1, delta=0.002)


class Efforts(unittest.TestCase):
    def test_a_fingertip_s_force_grows_with_the_tendon_s(self):
        posture = {"mcp": 40, "pip": 55, "dip": 35}
        one, three = (palmar.effort.fingertip("middle", posture_deg=posture, tendon="fdp", force_n=n)
                      for n in (1, 3))
        self.assertAlmostEqual(three["fingertip_force_magnitude_n"],
                               3 * one["fingertip_force_magnitude_n"], places=9)


class Errors(unittest.TestCase):
    def test_errors_are_of_the_kinds_of_the_exit_codes(self):
        for error, base, code in ((palmar.UsageError, ValueError, 2), (palmar.InputError, ValueError, 3),
                                  (palmar.NumericalError, ArithmeticError, 4),
                                  (palmar.CheckFailed, palmar.Error, 5),
                                  (palmar.ProgramMissing, palmar.Error, 6),
                                  (palmar.OutputError, OSError, 1)):
            self.assertTrue(issubclass(error, (palmar.Error,)) and issubclass(error, base))
            self.assertEqual(error.exit_code, code)

    def test_a_file_that_is_missing_or_broken_is_named(self):
        with self.assertRaisesRegex(palmar.InputError, "nothere.stl"):
            palmar.assess("nothere.stl", unit="mm")
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "broken.stl"
            file.write_bytes(b"solid nothing\n")
            with self.assertRaisesRegex(palmar.InputError, "broken.stl"):
                palmar.product.read(file)

    def test_a_wrong_value_is_named_as_the_argument(self):
        with self.assertRaisesRegex(palmar.UsageError, "grip force is -1 N; more than 0"):
            palmar.assess(sphere(), grip_force_n=-1)
        with self.assertRaisesRegex(palmar.UsageError, "^person is \"child\""):
            palmar.assess(sphere(), person="child")
        with self.assertRaisesRegex(palmar.UsageError, "^grip: \"tripot\".*did you mean tripod"):
            palmar.assess(sphere(), grip="tripot")
        with self.assertRaisesRegex(palmar.UsageError, "either depth_mm or force_n"):
            palmar.contact.press("sphere:5")
        with self.assertRaisesRegex(palmar.UsageError, "^indenter: \"cone:3\""):
            palmar.contact.press("cone:3", depth_mm=1)
        with self.assertRaisesRegex(palmar.UsageError, "prism"):
            palmar.product.make("pram")
        with self.assertRaisesRegex(palmar.UsageError, "hands doesn't go with"):
            palmar.study.plan(pathlib.Path(os.environ["PALMAR_SOURCE"]) / "examples" / "xie2014-chapter5"
                              / "study.toml", hands=3)

    def test_a_wrong_type_is_a_type_error_that_names_the_argument(self):
        with self.assertRaisesRegex(TypeError, "grip_force_n is 'much'; a number is required"):
            palmar.assess(sphere(), grip_force_n="much")
        with self.assertRaisesRegex(TypeError, "axis is .*three numbers"):
            palmar.assess(sphere(), axis=[0, 1])
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'grip_force'"):
            palmar.assess(sphere(), grip_force=30)

    def test_what_cannot_be_written_is_an_output_error(self):
        with self.assertRaisesRegex(palmar.OutputError, "nowhere"):
            palmar.hand.load().save("/nowhere/mine.hand.glb")


class Records(unittest.TestCase):
    def test_records_are_json_and_tables_have_columns_of_one_length(self):
        result = palmar.assess(sphere(), pictures=False)
        json.dumps(result.record)
        for table in (result.regions(), result.indices()):
            self.assertEqual(len({len(column) for column in table.values()}), 1)
        one = result[0]
        self.assertEqual(one.status, "held")
        self.assertEqual(len(result), 1)
        self.assertIs(type(result[:]), list)
        with self.assertRaises(IndexError):
            result[1]
        # Laws: pressures are no tension, the whole is the sum of its parts.
        self.assertGreaterEqual(one.skin_pressure_mpa.min(), 0)
        self.assertAlmostEqual(one.peak_pressure_mpa,
                               result.record["assessments"][0]["contact"]["peak_pressure_mpa"])
        regions = result.regions()
        total = regions["region"] == "total"
        self.assertAlmostEqual(regions["force_n"][~total].sum() / one.force_n, 1, places=6)
        self.assertEqual(result.record["command_line"],
                         "palmar assess 'made: sphere diameter_mm=60' --no-pictures")


if __name__ == "__main__":
    unittest.main()
