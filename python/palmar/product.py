# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Products: read, checked, made from parameters (`palmar product`)."""

from __future__ import annotations

from typing import Any, Dict, List, Optional

from . import _native
from ._native import Product
from ._task import Path, Paths, Progress, given, run_task

__all__ = ["check", "kinds", "make", "read"]


def read(
    file: Path,
    *,
    unit: Optional[str] = None,
    chordal_error_mm: Optional[float] = None,
    time_limit_s: Optional[float] = None,
    memory_limit_mb: Optional[float] = None,
    progress: Progress = None,
) -> Product:
    """The product of a file: STL, OBJ, PLY, 3MF, glTF, STEP or IGES.

    Args:
        unit: Of a file that carries none: "mm", "cm", "m", "inch"; None: one is proposed from the
            size and noted.
        chordal_error_mm: CAD: largest gap between triangles and surface, mm.
        time_limit_s, memory_limit_mb: CAD: most processor time (s) and memory (MB) for reading.
    """
    return run_task(_native.product_read, given(locals()), progress=progress)


def make(
    kind: str,
    *,
    out: Optional[Paths] = None,
    chordal_error_mm: Optional[float] = None,
    progress: Progress = None,
    **parameters: float,
) -> Product:
    """A product made from parameters (`palmar product make`).

    Args:
        kind: "cylinder", "prism", "bottle" ...; kinds() lists them with their parameters.
        out: Files to write: .step, .stl, .obj or .ply.
        chordal_error_mm: Largest gap between mesh and solid, mm.
        parameters: By their names, the unit in the name: diameter_mm=35, taper_deg=2.
    """
    return run_task(_native.product_make, given(locals()), progress=progress)


def check(
    file: Path,
    *,
    unit: Optional[str] = None,
    chordal_error_mm: Optional[float] = None,
    time_limit_s: Optional[float] = None,
    memory_limit_mb: Optional[float] = None,
    progress: Progress = None,
) -> Dict[str, Any]:
    """What is right and wrong with the mesh of a file (`palmar product check`).

    Args:
        unit, chordal_error_mm, time_limit_s, memory_limit_mb: As in read(); mm, s, MB.

    Returns:
        "verdict" ("ok", "note", "warning", "error"), "findings" (severity and sentence, the worst
        first), "product", counts, "volume_mm3", "area_mm2", "size_mm".
    """
    return run_task(_native.product_check, given(locals()), progress=progress)


def kinds() -> List[Dict[str, Any]]:
    """The kinds of products that make() makes: parameters with default, range and meaning."""
    return _native.product_kinds()
