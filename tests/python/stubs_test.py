# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Stubs and docstrings are those of the module: names, arguments, types, units."""

import ast
import inspect
import pathlib
import re
import typing
import unittest

import palmar
from palmar import _native

FOLDER = pathlib.Path(palmar.__file__).parent
MODULES = {"contact", "effort", "hand", "population", "product", "redesign", "study"}


def public_functions():
    yield "palmar.assess", palmar.assess
    for name in sorted(MODULES):
        module = getattr(palmar, name)
        for one in module.__all__:
            if inspect.isfunction(getattr(module, one)):
                yield f"palmar.{name}.{one}", getattr(module, one)


class Stubs(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.stub = ast.parse((FOLDER / "_native.pyi").read_text())

    def test_functions_are_those_of_the_extension_with_its_arguments(self):
        stated = {one.name: [a.arg for a in one.args.args] for one in self.stub.body
                  if isinstance(one, ast.FunctionDef)}
        real = {}
        for name in dir(_native):
            one = getattr(_native, name)
            if callable(one) and not inspect.isclass(one):
                head = one.__doc__.splitlines()[0]
                real[name] = re.findall(r"(\w+): ", head[head.index("("):head.rindex(")")])
        self.assertEqual(stated, real)

    def test_classes_have_the_attributes_that_the_stub_states(self):
        for one in self.stub.body:
            if not isinstance(one, ast.ClassDef):
                continue
            stated = {f.name: any(isinstance(d, ast.Name) and d.id == "property" for d in f.decorator_list)
                      for f in one.body if isinstance(f, ast.FunctionDef)}
            real = {name: isinstance(value, property)
                    for name, value in vars(getattr(_native, one.name)).items()
                    if not name.startswith("_") or name == "__len__"}
            self.assertEqual(stated, real, one.name)

    def test_every_class_of_the_extension_is_stated(self):
        stated = {one.name for one in self.stub.body if isinstance(one, ast.ClassDef)}
        self.assertEqual(stated, {name for name in dir(_native) if inspect.isclass(getattr(_native, name))})

    def test_the_package_says_that_it_is_typed(self):
        self.assertTrue((FOLDER / "py.typed").exists())

    def test_every_argument_of_public_functions_has_a_type_that_can_be_read(self):
        for name, function in public_functions():
            types = typing.get_type_hints(function)
            for argument in [*inspect.signature(function).parameters, "return"]:
                self.assertIn(argument, types, name)


class Docstrings(unittest.TestCase):
    def test_every_public_function_and_attribute_says_what_it_is(self):
        for name, function in public_functions():
            self.assertTrue((function.__doc__ or "").strip(), name)
        for cls in (palmar.Product, palmar.Hand, palmar.Assessment, palmar.Assessments):
            for name, value in vars(cls).items():
                if isinstance(value, property):
                    self.assertTrue((value.__doc__ or "").strip(), f"{cls.__name__}.{name}")

    def test_quantities_state_the_unit_that_their_name_has(self):
        words = {"_mm": "mm", "_mm2": "mm2", "_mm3": "mm3", "_n": "N", "_mpa": "MPa"}
        for cls in (palmar.Product, palmar.Hand, palmar.Assessment):
            for name, value in vars(cls).items():
                for end, unit in words.items():
                    if name.endswith(end) and isinstance(value, property):
                        self.assertRegex(value.__doc__, rf"\b{unit}\b", f"{cls.__name__}.{name}")

    def test_arguments_with_a_unit_say_it(self):
        words = {"_mm": "mm", "_n": "N", "_deg": "deg", "_kpa": "kPa", "_kg": "kg"}
        for name, function in public_functions():
            module = inspect.getmodule(function).__doc__ or ""
            for argument in inspect.signature(function).parameters:
                for end, unit in words.items():
                    if argument.endswith(end):
                        self.assertRegex(function.__doc__ + module, rf"\b{unit}\b", f"{name}: {argument}")

    def test_names_that_are_exported_are_there(self):
        for name in palmar.__all__:
            self.assertTrue(hasattr(palmar, name), name)
        self.assertTrue(MODULES <= set(palmar.__all__))


if __name__ == "__main__":
    unittest.main()
