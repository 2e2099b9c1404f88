# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Palmar shows how a handheld product will feel in people's hands before it exists.

    import palmar

    result = palmar.assess("handle.stl", unit="mm", grip_force_n=30)
    print(result.sentence)
    print(result[0].peak_pressure_cells_mpa, "MPa")

The functions are those of the command line, with the same defaults: `palmar study run` is
palmar.study.run(), `--grip-force-n 30` is grip_force_n=30. Lengths are mm, forces N, pressures MPa,
angles degrees; every name ends with its unit. docs/using/python.md has an example of each.
"""

from . import contact, effort, hand, population, product, redesign, study
from ._assess import Assessments, assess
from ._errors import (
    Cancelled,
    CheckFailed,
    Error,
    InputError,
    NumericalError,
    OutputError,
    ProgramMissing,
    UsageError,
)
from ._native import Assessment, Hand, Product, build_description, set_thread_count
from ._native import version as _version

__version__: str = _version()

__all__ = [
    "Assessment",
    "Assessments",
    "Cancelled",
    "CheckFailed",
    "Error",
    "Hand",
    "InputError",
    "NumericalError",
    "OutputError",
    "Product",
    "ProgramMissing",
    "UsageError",
    "assess",
    "build_description",
    "contact",
    "effort",
    "hand",
    "population",
    "product",
    "redesign",
    "set_thread_count",
    "study",
]
