# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Better shapes (`palmar redesign`): each function searches or makes one, writes it to `out`, and has
other hands compare it with the original at the same grip force.

All take whose hands hold it and how:

    product: A file, a Product, or words ("made: prism width_mm=35 fillet_mm=3").
    out: Folder: new or empty, or of an earlier redesign.
    population, hands: Whose hands, and how many to draw from each population (30 of "xie2014").
    hand, left: Hand that is scaled, a left one.
    grip, hold, part, along: As in palmar.assess(); at, axis: where it is held (mm) and the direction
        of the handle there, product frame.
    hold_posture: "new": redesigns are grasped anew at the same grip force; "kept": in the posture of
        the original (Xie 2014, 5.5.3).
    grip_force_n: N, for all; None: the usual one.
    goal: What is made better: "peak", "mean", "discomfort", "torque", "strength", "effort",
        "stability" or a quantity's key; "peak:p95" for the worst hands.
    keep_face, keep_box: CAD faces (number or name) and boxes (two corners, mm) that stay.
    compare, pictures: Whether other hands compare, and pictures are drawn.
    seed, unit, language, progress: As in palmar.assess().

and return a dict: "record" (the command line's JSON), "notes", "file" (of the shape) and, where hands
compared, "sentence", "reasons", "comparison" (a table), "study" and "report" (paths).
"""

from __future__ import annotations

from typing import Any, Dict, Optional, Sequence, Tuple, Union

from . import _native
from ._native import Product
from ._task import Box, Path, Progress, Vector, command_of, given, run_task
from .study import _source

__all__ = ["features", "fillet", "press", "region", "shape"]


def _asked(task: str, arguments: Dict[str, Any]) -> Dict[str, Any]:
    asked = given(arguments)
    asked["product"] = _source(asked["product"])
    return {**asked, "command_line": command_of("redesign " + task, [asked["product"]], asked)}


def shape(
    product: Union[Path, Product],
    out: Path,
    *,
    vary: Union[None, str, Sequence[str]] = None,
    features: Optional[Path] = None,
    goal: Optional[str] = None,
    spread_mm: Optional[float] = None,
    spread_deg: Optional[float] = None,
    places: Optional[int] = None,
    use: Union[None, str, Sequence[str]] = None,
    largest_change_mm: Optional[float] = None,
    smallest_wall_mm: Optional[float] = None,
    smallest_volume: Optional[float] = None,
    largest_volume: Optional[float] = None,
    smallest_radius_mm: Optional[float] = None,
    pull: Optional[Vector] = None,
    draft_deg: Optional[float] = None,
    draft_land_mm: Optional[float] = None,
    lost_hands: Optional[float] = None,
    both_hands: Optional[bool] = None,
    keep_ends_mm: Optional[float] = None,
    keep_face: Union[None, int, str, Sequence[Union[int, str]]] = None,
    keep_box: Optional[Sequence[Box]] = None,
    end_radius_mm: Optional[float] = None,
    evaluations: Optional[int] = None,
    pick: Optional[int] = None,
    pictures: Optional[bool] = None,
    population: Union[None, Path, Sequence[Path]] = None,
    hands: Optional[int] = None,
    unit: Optional[str] = None,
    hand: Optional[Path] = None,
    left: Optional[bool] = None,
    grip: Union[None, str, Sequence[str]] = None,
    hold: Union[None, int, Path] = None,
    part: Union[None, int, str] = None,
    along: Optional[float] = None,
    at: Optional[Vector] = None,
    axis: Optional[Vector] = None,
    hold_posture: Optional[str] = None,
    grip_force_n: Optional[float] = None,
    seed: Optional[int] = None,
    language: Optional[str] = None,
    compare: Optional[bool] = None,
    progress: Progress = None,
) -> Dict[str, Any]:
    """Shapes the handle anew by few named features (`palmar redesign shape`).

    Args:
        vary: Features that vary ("width"), their ranges ("width=28:40") or values ("width=34").
        features: A handle.toml that is made as it is, without a search.
        spread_mm, spread_deg, places: How far hands lie from their place along the handle (mm) and
            about it (deg), and how many places stand for that.
        use: Several uses: "hand=left weight=0.1".
        largest_change_mm, smallest_wall_mm, smallest_radius_mm: Limits, mm; smallest_volume,
            largest_volume: shares of the original's; lost_hands: share of hands.
        pull, draft_deg, draft_land_mm: Mould: direction, angle of the walls (deg), land (mm).
        both_hands: Nothing one-sided. keep_ends_mm: length at the ends that stays, mm.
        end_radius_mm: Of the edges of flat ends, mm.
        evaluations: Most candidates; pick: make this one of the search.
    """
    return run_task(_native.redesign_shape, _asked("shape", locals()), progress=progress)


def press(
    product: Union[Path, Product],
    out: Path,
    *,
    overlap_share: Optional[float] = None,
    over: Optional[str] = None,
    align: Optional[bool] = None,
    largest_depth_mm: Optional[float] = None,
    wall_mm: Optional[float] = None,
    keep_face: Union[None, int, str, Sequence[Union[int, str]]] = None,
    keep_box: Optional[Sequence[Box]] = None,
    keep_blend_mm: Optional[float] = None,
    smoothing_mm: Optional[float] = None,
    rim_mm: Optional[float] = None,
    edge_mm: Optional[float] = None,
    format: Union[None, str, Sequence[str]] = None,
    pictures: Optional[bool] = None,
    population: Union[None, Path, Sequence[Path]] = None,
    hands: Optional[int] = None,
    unit: Optional[str] = None,
    hand: Optional[Path] = None,
    left: Optional[bool] = None,
    grip: Union[None, str, Sequence[str]] = None,
    hold: Union[None, int, Path] = None,
    part: Union[None, int, str] = None,
    along: Optional[float] = None,
    at: Optional[Vector] = None,
    axis: Optional[Vector] = None,
    hold_posture: Optional[str] = None,
    grip_force_n: Optional[float] = None,
    seed: Optional[int] = None,
    language: Optional[str] = None,
    compare: Optional[bool] = None,
    progress: Progress = None,
) -> Dict[str, Any]:
    """Presses the surface in where hands reach into it (`palmar redesign press`; Xie 2014, ch. 5).

    Args:
        overlap_share: Share of the overlap of undeformed skin and product that is removed, 0 to 1.
        over: Overlap over hands: "mean", a percentile ("75"), "mean-of-touching".
        align: Shift every hand along the handle before they are combined.
        largest_depth_mm, wall_mm: Largest depth and least wall, mm.
        keep_blend_mm, smoothing_mm, rim_mm, edge_mm: Widths and edge length, mm.
        format: "stl", "obj", "ply".

    Returns:
        Also "vertices_mm" and "triangles" of the pressed surface.
    """
    return run_task(_native.redesign_press, _asked("press", locals()), progress=progress)


def region(
    product: Union[Path, Product],
    out: Path,
    *,
    hands_share: Union[None, str, float] = None,
    threshold_kpa: Optional[float] = None,
    smoothing_mm: Optional[float] = None,
    smallest_area_mm2: Optional[float] = None,
    pressed_share: Optional[float] = None,
    relief: Optional[bool] = None,
    relief_share: Union[None, str, float] = None,
    fit_share: Optional[float] = None,
    largest_depth_mm: Optional[float] = None,
    smallest_radius_mm: Optional[float] = None,
    run_out_mm: Optional[float] = None,
    junction_radius_mm: Optional[float] = None,
    pictures: Optional[bool] = None,
    population: Union[None, Path, Sequence[Path]] = None,
    hands: Optional[int] = None,
    unit: Optional[str] = None,
    hand: Optional[Path] = None,
    left: Optional[bool] = None,
    grip: Union[None, str, Sequence[str]] = None,
    hold: Union[None, int, Path] = None,
    part: Union[None, int, str] = None,
    along: Optional[float] = None,
    at: Optional[Vector] = None,
    axis: Optional[Vector] = None,
    hold_posture: Optional[str] = None,
    grip_force_n: Optional[float] = None,
    seed: Optional[int] = None,
    language: Optional[str] = None,
    compare: Optional[bool] = None,
    progress: Progress = None,
) -> Dict[str, Any]:
    """Where hands touch, for CAD; rounds the ridges there (`palmar redesign region`).

    Args:
        hands_share: Share of hands that must touch: "any", "half", or 0 to 1; relief_share: the
            same for ridges.
        threshold_kpa: Pressure above which a hand counts as touching, kPa.
        smoothing_mm, smallest_area_mm2: Of the outlines, mm; of patches, mm2.
        pressed_share, fit_share: Shares of the mean imprint.
        relief: Round ridges; False: only export the region.
        largest_depth_mm, smallest_radius_mm, run_out_mm, junction_radius_mm: Of the cutter, mm.
    """
    return run_task(_native.redesign_region, _asked("region", locals()), progress=progress)


def features(
    product: Union[Path, Product],
    out: Path,
    *,
    vary: Union[None, str, Sequence[str]] = None,
    propose: Optional[bool] = None,
    groove_radius_mm: Optional[float] = None,
    groove_rim_mm: Optional[float] = None,
    smallest_groove_radius_mm: Optional[float] = None,
    goal: Optional[str] = None,
    largest_offset_mm: Optional[float] = None,
    keep_face: Union[None, str, Sequence[str]] = None,
    smallest_radius_mm: Optional[float] = None,
    smallest_volume: Optional[float] = None,
    largest_volume: Optional[float] = None,
    least_grip_force: Optional[float] = None,
    lost_hands: Optional[float] = None,
    evaluations: Optional[int] = None,
    step_mm: Optional[float] = None,
    optimiser: Optional[str] = None,
    population: Union[None, Path, Sequence[Path]] = None,
    hands: Optional[int] = None,
    unit: Optional[str] = None,
    hand: Optional[Path] = None,
    left: Optional[bool] = None,
    grip: Union[None, str, Sequence[str]] = None,
    hold: Union[None, int, Path] = None,
    part: Union[None, int, str] = None,
    along: Optional[float] = None,
    at: Optional[Vector] = None,
    axis: Optional[Vector] = None,
    hold_posture: Optional[str] = None,
    grip_force_n: Optional[float] = None,
    seed: Optional[int] = None,
    language: Optional[str] = None,
    compare: Optional[bool] = None,
    progress: Progress = None,
) -> Dict[str, Any]:
    """Sizes of CAD features with the best goal over hands (`palmar redesign features`).

    Args:
        vary: Features with range or value: "fillet:long=1:15", "offset:FACES=-2:2",
            "taper:FACES=0:4" (deg), "groove:at=40=0:2", "diameter_mm=25:45" of a made product.
        propose: No search: tries a change of every feature that carries peaks.
        groove_radius_mm, groove_rim_mm, smallest_groove_radius_mm: Of grooves and cutters, mm.
        largest_offset_mm, smallest_radius_mm, step_mm: Limits and rounding of sizes, mm.
        smallest_volume, largest_volume, least_grip_force: Shares of the original's; lost_hands:
            share of hands.
        keep_face: "face=3+5", "name=grip", "ends".
        evaluations, optimiser: Of the search: "auto", "cobyla", "bobyqa", "direct".
    """
    return run_task(_native.redesign_features, _asked("features", locals()), progress=progress)


def fillet(
    product: Union[Path, Product],
    out: Path,
    *,
    edges: str = "long",
    radius_mm: Union[float, Tuple[float, float]] = (1, 15),
    goal: Optional[str] = None,
    largest_offset_mm: Optional[float] = None,
    keep_face: Union[None, str, Sequence[str]] = None,
    smallest_radius_mm: Optional[float] = None,
    smallest_volume: Optional[float] = None,
    largest_volume: Optional[float] = None,
    least_grip_force: Optional[float] = None,
    lost_hands: Optional[float] = None,
    evaluations: Optional[int] = None,
    step_mm: Optional[float] = None,
    optimiser: Optional[str] = None,
    population: Union[None, Path, Sequence[Path]] = None,
    hands: Optional[int] = None,
    unit: Optional[str] = None,
    hand: Optional[Path] = None,
    left: Optional[bool] = None,
    grip: Union[None, str, Sequence[str]] = None,
    hold: Union[None, int, Path] = None,
    part: Union[None, int, str] = None,
    along: Optional[float] = None,
    at: Optional[Vector] = None,
    axis: Optional[Vector] = None,
    hold_posture: Optional[str] = None,
    grip_force_n: Optional[float] = None,
    seed: Optional[int] = None,
    language: Optional[str] = None,
    compare: Optional[bool] = None,
    progress: Progress = None,
) -> Dict[str, Any]:
    """The radius of edges with the best goal over hands (`palmar redesign fillet`).

    Args:
        edges: "long", "convex", "concave", "edge=3+5", "face=7", "name=grip", joined by "+".
        radius_mm: Range (from, to), or one radius that is made without a search, mm.
        largest_offset_mm, smallest_radius_mm, step_mm: Limits and rounding of sizes, mm.
        smallest_volume, largest_volume, least_grip_force: Shares of the original's; lost_hands:
            share of hands.
        keep_face: "face=3+5", "name=grip", "ends".
        evaluations, optimiser: Of the search: "auto", "cobyla", "bobyqa", "direct".
    """
    asked = _asked("fillet", locals())
    edges, radius = asked.pop("edges"), asked.pop("radius_mm")
    words = ":".join(f"{one:.12g}" for one in (radius if isinstance(radius, tuple) else (radius,)))
    asked["vary"] = f"fillet:{edges}={words}"
    return run_task(_native.redesign_features, asked, progress=progress)
