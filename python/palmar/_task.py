# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Runs tasks of palmar._native: arguments, progress, notes, messages in Python's words."""

from __future__ import annotations

import logging
import os
import re
import shlex
import sys
import time
from typing import Any, Callable, Dict, Mapping, Optional, Sequence, Union

import numpy as np

from . import _native
from ._errors import Error

Path = Union[str, os.PathLike[str]]
Paths = Union[Path, Sequence[Path]]
Vector = Sequence[float]
"""x, y, z"""
Box = Sequence[float]
"""Two corners: x0, y0, z0, x1, y1, z1, mm"""
Progress = Union[None, bool, Callable[[float, str], object]]
"""None: silent; True: a bar on stderr; else called with the share done (0 to 1) and what is done."""
Table = Dict[str, np.ndarray]
"""Columns by name, units in the names; pandas.DataFrame(table) makes a frame of it."""
Record = Dict[str, Any]
"""What the command line's --json prints."""

notes = logging.getLogger("palmar")
"""Gets every note for the user (a proposed unit, a repaired mesh) as a warning."""

_native.set_program_folder(os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin"))

_UNIT_ENDS = ("", "_mm", "_mm2", "_deg", "_n", "_kg", "_kpa", "_mb", "_s", "_g_cm3", "_n_mm", "_g")
_OTHER_WORDS = {
    "region": "box",
    "force": "load_n",
    "torque": "torque_n_mm",
    "force_at": "load_at",
    "mass_centre": "mass_at",
    "depth_limit": "largest_depth_mm",
    "rim_width": "rim_mm",
    "edge_length": "edge_mm",
    "share": "overlap_share",
    "posture": "hold_posture",
    "conditions": "where",
    "predictors": "on",
    "level": "confidence",
    "is_balanced": "balance",
    "files": "out",
    "suits_both_hands": "both_hands",
    "spread_along": "spread_mm",
    "spread_of_the_turn": "spread_deg",
    "boundary": "boundary_share",
}


def _argument_named(setting: str, names: Sequence[str]) -> str:
    """The argument that a setting of the library is: "grip force" -> grip_force_n."""
    word = re.sub("[ -]", "_", setting)
    words = [word, word[:-1] if word.endswith("s") else word + "s", _OTHER_WORDS.get(word, "")]
    for one in words:
        for end in _UNIT_ENDS:
            if one and one + end in names:
                return one + end
    return f'setting "{setting}"'


def _in_python_words(message: str, names: Sequence[str]) -> str:
    return re.sub('setting "([^"]*)"', lambda found: _argument_named(found[1], names), message)


class _Bar:
    """One line on stderr: share, what is done, time left."""

    def __init__(self) -> None:
        self.start = time.monotonic()
        self.width = 0

    def __call__(self, share: float, activity: str) -> None:
        filled = int(24 * share)
        line = f"{100 * share:3.0f} % [{'#' * filled}{'.' * (24 - filled)}] {activity}"
        spent = time.monotonic() - self.start
        if 0.1 < share < 1.0 and spent > 1.0:
            left = spent * (1 / share - 1)
            line += f", about {left / 60:.0f} min left" if left > 90 else f", about {left:.0f} s left"
        self._write(line)

    def end(self) -> None:
        if self.width:
            self._write("")
            sys.stderr.write("\r")

    def _write(self, line: str) -> None:
        sys.stderr.write("\r" + line.ljust(self.width))
        sys.stderr.flush()
        self.width = len(line)


def run_task(task: Callable[..., Any], *arguments: Any, progress: Progress = None,
        names: Optional[Sequence[str]] = None) -> Any:
    """Calls a native task with a dict of arguments (or others, with `names`), progress and notes."""
    if names is None:
        names = list(arguments[0]) + list(arguments[0].get("parameters", ()))
    bar = _Bar() if progress is True else None
    listener = bar if bar else progress or None

    def note(text: str) -> None:
        if bar:
            bar.end()
        notes.warning("%s", _in_python_words(text, names))

    try:
        return task(*arguments, listener, note)
    except Error as error:
        raise type(error)(_in_python_words(str(error), names)) from None
    finally:
        if bar:
            bar.end()


def given(arguments: Mapping[str, Any]) -> Dict[str, Any]:
    """The arguments of a public function, but `progress`: run_task() has that apart."""
    return {name: value for name, value in arguments.items() if name != "progress"}


def _option(name: str, value: Any) -> str:
    """--grip-force-n 30, --axis 0,0,1, --left, --no-balance; "" where there is nothing to say."""
    option = "--" + name.replace("_", "-")
    value = value.name if isinstance(value, _native.Hand) else value
    if value is None or (value is False and name in ("left", "skin_on_skin", "both_hands")):
        return ""
    if isinstance(value, bool):
        return option if value else "--no-" + option[2:]
    if isinstance(value, (str, os.PathLike)) or not isinstance(value, (Sequence, np.ndarray)):
        return f"{option} {shlex.quote(str(value))}"
    if all(isinstance(one, (int, float, np.number)) for one in value):
        return f"{option} {','.join(str(one) for one in value)}"
    return " ".join(_option(name, one) for one in value)


def command_of(verb: str, products: Sequence[Any], arguments: Mapping[str, Any]) -> str:
    """The call as the command line has it, for the results: palmar assess a.step --grip-force-n 30."""
    words = [shlex.quote(str(getattr(one, "source", one))) for one in products]
    usual = {"hand": "template", "grip": "any"}
    words += [_option(name, value) for name, value in arguments.items()
              if name not in ("product", "products", "progress", "fingertips")
              and not (name in usual and value == usual[name])]
    for finger, point in (arguments.get("fingertips") or {}).items():
        words.append(f"--fingertip {finger}:{','.join(str(one) for one in point)}")
    return " ".join(["palmar", verb, *filter(None, words)])
