# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""What tendons and muscles do, and what a hand can do at most (`palmar effort`)."""

from __future__ import annotations

from typing import List, Mapping, Optional, Union

from . import _native
from ._native import Hand, Product
from ._task import Box, Path, Progress, Record, Vector, given, run_task

__all__ = ["capacity", "fingertip", "grasp"]


def grasp(
    product: Union[Path, Product],
    *,
    hand: Union[Path, Hand] = "template",
    person: Optional[str] = None,
    left: bool = False,
    grasp: Optional[Path] = None,
    grip: str = "any",
    hold: Union[None, int, Path] = None,
    part: Union[None, int, str] = None,
    along: Optional[float] = None,
    at: Optional[Vector] = None,
    axis: Optional[Vector] = None,
    grip_force_n: Optional[float] = None,
    strength_share: Optional[float] = None,
    strength_n: Optional[float] = None,
    limit_depths: Optional[bool] = None,
    task: Optional[str] = None,
    turn_n_m: Optional[float] = None,
    friction: Optional[float] = None,
    mass_kg: Optional[float] = None,
    wrist_flexion_deg: float = -30.0,
    wrist_deviation_deg: float = 0.0,
    exponent: Optional[float] = None,
    muscle_strength: Optional[float] = None,
    tendon_points: str = "synek2019",
    hood: str = "synek2019",
    unit: Optional[str] = None,
    progress: Progress = None,
) -> Record:
    """Forces of the muscles of fingers and thumb that hold a product (`palmar effort grasp`).

    Args:
        grasp: Grasp to take instead of finding one: JSON of `palmar grasp close`.
        grip_force_n, strength_share, strength_n, limit_depths, task, turn_n_m: As in palmar.assess(); N,
            N m.
        at, axis: Point of the grip axis in mid-palm (mm) and its direction, product frame.
        mass_kg: Of the product, kg.
        wrist_flexion_deg, wrist_deviation_deg: Posture of the wrist, deg; extension is negative.
        exponent: n of the smallest sum (force / cross-section)^n: 2 or 3.
        muscle_strength: Strength of the person's muscles over that of the model's.
        tendon_points: "synek2019" or "an1979"; hood: "synek2019" or "chao1989".

    Returns:
        What `palmar effort grasp --json` prints: force_n, moment_n_mm ... per digit and tendon.
    """
    return run_task(_native.effort_grasp, given(locals()), progress=progress)


def capacity(
    product: Union[Path, Product],
    *,
    hand: Union[Path, Hand] = "template",
    person: Optional[str] = None,
    strength_n: Optional[float] = None,
    grip: str = "any",
    hold: Union[None, int, Path] = None,
    part: Union[None, int, str] = None,
    along: Optional[float] = None,
    at: Optional[Vector] = None,
    axis: Optional[Vector] = None,
    friction: Optional[float] = None,
    about: Optional[Vector] = None,
    wrist_flexion_deg: float = -30.0,
    wrist_deviation_deg: float = 0.0,
    unit: Optional[str] = None,
    progress: Progress = None,
) -> Record:
    """Largest grip force, torque, push and pull on a product (`palmar effort capacity`).

    Args:
        person: Whose strength: "woman", "man:age=60" (Steiber 2016); or strength_n, N.
        about: Axis of the torque, product frame; None: the grip axis.
        wrist_flexion_deg, wrist_deviation_deg: Posture of the wrist, deg.

    Returns:
        grip_force_n, torque_n_mm, push_n, pull_n, limited_by ...
    """
    return run_task(_native.effort_capacity, given(locals()), progress=progress)


def fingertip(
    finger: str = "index",
    *,
    posture_deg: Optional[Mapping[str, float]] = None,
    tendon: str = "all",
    force_n: float = 1.0,
    hand: Union[Path, Hand] = "template",
    tendon_points: str = "synek2019",
    hood: str = "synek2019",
) -> Record:
    """Force at a fingertip held still when one tendon is loaded (`palmar effort fingertip`).

    Args:
        finger: "thumb", "index", "middle", "ring" or "little".
        posture_deg: Angles, deg: {"mcp": 40, "pip": 55, "dip": 35, "abduction": 0}; of the thumb
            "cmc-flexion", "cmc-abduction", "mp", "ip". What isn't named is 0.
        tendon: "fdp", "fds", "edc", "lum", "ri", "ui" ..., or "all".
        force_n: In the tendon, N.
        tendon_points: "synek2019" (Synek 2019) or "an1979" (An 1979); hood: "synek2019" or
            "chao1989" (Chao 1989).

    Returns:
        What `palmar effort fingertip --json` prints: fingertip_force_n, moment_arm_mm ...
    """
    return run_task(_native.effort_fingertip, given(locals()))
