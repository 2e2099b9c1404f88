# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Contact of skin with simple bodies (`palmar contact`)."""

from __future__ import annotations

from typing import Optional, Sequence, Union

from . import _native
from ._task import Path, Table, given, run_task

__all__ = ["press"]


def press(
    indenter: str,
    *,
    specimen: str = "plane",
    depth_mm: Union[None, float, Sequence[float]] = None,
    force_n: Union[None, float, Sequence[float]] = None,
    tilt_deg: Optional[float] = None,
    spacing_mm: Optional[float] = None,
    cell_mm: Optional[float] = None,
    shear_modulus_kpa: Optional[float] = None,
    preset: Optional[str] = None,
    kernel: Optional[str] = None,
    tissue_model: Optional[str] = None,
    tissue: Optional[Path] = None,
    tissue_level: Optional[str] = None,
    layer_mm: Optional[float] = None,
    poisson: Optional[float] = None,
    coating: Optional[str] = None,
    out: Optional[Path] = None,
) -> Table:
    """The indentation test of a laboratory (`palmar contact press`; Hertz 1882, Johnson 1985).

    Args:
        indenter: "sphere:R", "punch:A", "punches:A,DISTANCE", "cylinder:R" (mm) or "plane".
        specimen: "plane", "ellipsoid:RX,RY" (radii of curvature, mm) or "HAND:REGION"
            ("template:middle_distal").
        depth_mm, force_n: Depths from first touch (mm), or forces to reach (N); one of the two.
        tilt_deg: Tilt of the indenter, deg.
        spacing_mm: Between vertices of a plane or ellipsoid, mm.
        cell_mm: Side of a square sensor cell, mm.
        shear_modulus_kpa: One shear modulus instead of the tissue's own, kPa.
        preset, kernel, tissue_model: The equations; tissue: a tissue file (TOML), tissue_level:
            "low", "nominal", "high".
        layer_mm, poisson: Thickness of the layer over bone (mm) and Poisson's ratio of a plane or
            ellipsoid.
        coating: Cover of the indenter: "THICKNESS_MM,SHEAR_MODULUS_KPA[,POISSON]".
        out: File to write: .json, .csv, or .svg (the curve).

    Returns:
        A row per depth or force: depth_mm, force_n, contact_area_mm2, pressures in MPa ...
    """
    return run_task(_native.contact_press, given(locals()))
