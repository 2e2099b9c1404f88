# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Hands (`palmar hand`)."""

from __future__ import annotations

from typing import Optional, Union

from . import _native
from ._native import Hand
from ._task import Path, given, run_task

__all__ = ["load"]


def load(
    hand: Union[Path, Hand] = "template",
    *,
    person: Optional[str] = None,
    left: bool = False,
    tissue: Optional[Path] = None,
) -> Hand:
    """The template hand, that of a file, or that of a person by size.

    Args:
        hand: "template", a .hand.glb file, or a Hand.
        person: To whose size it is scaled: "woman:P5", "man:P50" (percentile of ANSUR II).
        left: Mirrors a right hand.
        tissue: Tissue file (TOML) over the hand's own; moduli in it are kPa.
    """
    return run_task(_native.hand_load, given(locals()))
