# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Runs test files of the Python package with unittest: run.py FILE ...; exit code 77: skipped.

PYTHONPATH holds the package, PALMAR the program, PALMAR_SOURCE the repository.
"""

import importlib.util
import os
import sys
import unittest

# The package must not look at what the environment says of the program's own.
os.environ.pop("PALMAR_SHARE", None)
for needed in ("numpy",):
    if importlib.util.find_spec(needed) is None:
        print(f"skipped: {needed} isn't installed for {sys.executable}")
        sys.exit(77)

here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, here)
suite = unittest.TestSuite(
    unittest.defaultTestLoader.loadTestsFromName(name) for name in sys.argv[1:])
result = unittest.TextTestRunner(verbosity=2).run(suite)
sys.exit(0 if result.wasSuccessful() else 1)
