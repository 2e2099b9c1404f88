# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from collections.abc import Sequence as _Sequence
from typing import Any, List, Mapping, Optional, Union, overload

from . import _native
from ._native import Assessment, Hand, Product
from ._task import (Box, Path, Progress, Record, Table, Vector, command_of, given, notes,
                    run_task)


class Assessments(_Sequence):
    """What palmar.assess() found: one Assessment per product, and what is said of all."""

    def __init__(self, outcome: _native.AssessOutcome) -> None:
        self._outcome = outcome

    def __len__(self) -> int:
        return len(self._outcome)

    @overload
    def __getitem__(self, index: int) -> Assessment: ...
    @overload
    def __getitem__(self, index: slice) -> List[Assessment]: ...
    def __getitem__(self, index: Union[int, slice]) -> Union[Assessment, List[Assessment]]:
        wanted = range(len(self))[index]
        if isinstance(wanted, range):
            return [self._outcome.one(i) for i in wanted]
        return self._outcome.one(wanted)

    @property
    def sentence(self) -> str:
        """The answer, as it stands over the report."""
        return self._outcome.sentence

    @property
    def reasons(self) -> List[str]:
        """Why, and what restricts the answer."""
        return self._outcome.reasons

    @property
    def record(self) -> Record:
        """Everything, as `palmar assess --json` prints it; units in the keys."""
        return self._outcome.record

    @property
    def folder(self) -> str:
        """Folder of the report; "" if none was written."""
        return self._outcome.folder

    @property
    def has_converged(self) -> bool:
        """Whether every contact has a solution."""
        return self._outcome.has_converged

    def regions(self) -> Table:
        """A row per product and region of the hand in contact: N, mm2, MPa, mm."""
        return self._outcome.regions()

    def indices(self) -> Table:
        """A row per product and index of the grasp: key, value, unit, which direction is better."""
        return self._outcome.indices()

    def faces(self) -> Table:
        """A row per CAD face under pressure: N, mm2, MPa."""
        return self._outcome.faces()

    def sensors(self) -> Table:
        """A row per sensor cell, with `sensors`."""
        return self._outcome.sensors()

    def __repr__(self) -> str:
        return f"<palmar.Assessments of {len(self)}: {self.sentence}>"


def assess(
    *products: Union[Path, Product],
    hand: Union[Path, Hand] = "template",
    person: Optional[str] = None,
    left: bool = False,
    grip: str = "any",
    hold: Union[None, int, Path] = None,
    part: Union[None, int, str] = None,
    along: Optional[float] = None,
    toward: Union[None, str, Vector] = None,
    up: Union[None, str, Vector] = None,
    purpose: Optional[str] = None,
    at: Optional[Vector] = None,
    axis: Optional[Vector] = None,
    box: Optional[Box] = None,
    turn_deg: Optional[float] = None,
    place_per_hand: Optional[bool] = None,
    fingertips: Optional[Mapping[str, Vector]] = None,
    fingertip_depth_mm: Optional[float] = None,
    palm_limit_depth_mm: Optional[float] = None,
    finger_limit_depth_mm: Optional[float] = None,
    grip_force_n: Optional[float] = None,
    strength_share: Optional[float] = None,
    strength_n: Optional[float] = None,
    limit_depths: Optional[bool] = None,
    task: Optional[str] = None,
    turn_n_m: Optional[float] = None,
    balance: Optional[bool] = None,
    friction: Optional[float] = None,
    mass_kg: Optional[float] = None,
    weight_n: Optional[float] = None,
    density_g_cm3: Optional[float] = None,
    acceleration_g: Optional[float] = None,
    gravity: Optional[Vector] = None,
    mass_at: Optional[Vector] = None,
    load_n: Optional[Vector] = None,
    torque_n_mm: Optional[Vector] = None,
    load_at: Optional[Vector] = None,
    preset: Optional[str] = None,
    kernel: Optional[str] = None,
    tissue_model: Optional[str] = None,
    coupling: Optional[str] = None,
    tissue: Optional[Path] = None,
    coating: Union[None, str, List[str]] = None,
    shear_modulus_kpa: Optional[float] = None,
    swelling: Optional[bool] = None,
    skin_on_skin: Optional[bool] = None,
    refine: Optional[bool] = None,
    error_band: Optional[bool] = None,
    natural_postures: Optional[Path] = None,
    sensors: Optional[Path] = None,
    measured: Optional[Path] = None,
    error_budget: Optional[bool] = None,
    unit: Optional[str] = None,
    chordal_error_mm: Optional[float] = None,
    time_limit_s: Optional[float] = None,
    memory_limit_mb: Optional[float] = None,
    out: Optional[Path] = None,
    pictures: Optional[bool] = None,
    language: Optional[str] = None,
    project: Optional[Path] = None,
    excel: Optional[bool] = None,
    seed: Optional[int] = None,
    progress: Progress = None,
) -> Assessments:
    """How products feel in one hand: grasp, contact, indices (`palmar assess`).

    What isn't given is as on the command line. Method: docs/method; Xie 2014, chapters 3 and 5.

    Args:
        products: Files (STL, OBJ, PLY, 3MF, glTF, STEP, IGES) or Products.
        hand: "template", a .hand.glb file, or a Hand.
        person: Whose size and strength: "woman:P5", "man:P50,age=60" (ANSUR II; Steiber 2016).
        left: A left hand.
        grip: "any", "power", or a grip of the GRASP taxonomy ("medium_wrap", "tripod" ...).
        hold: A hold's file, or its number in the ranked list.
        part: Part of the product by its name or number; `along`: where along it, 0 to 1.
        toward, up: Where the thumb's side points and what is up: "+z", "up", or x, y, z.
        purpose: "use" or "hand-over".
        at, axis, turn_deg: Point of the grip axis in mid-palm, mm; its direction; turn about it,
            deg. Product frame.
        box: Hold by the surface in this box: two corners, mm.
        place_per_hand: This hand searches where to hold.
        fingertips: Points for fingertips of a precision grip, mm: {"thumb": (0, 0, 10), ...};
            fingertip_depth_mm: how deep they press in, mm.
        palm_limit_depth_mm, finger_limit_depth_mm: Deepest penetration, mm (7 and 4; Xie 2014).
        grip_force_n: Grip force as a dynamometer reads it, N; strength_share: of the strength of
            `person` or `strength_n` (N); limit_depths: as closing to the depths made it.
        task: "usual" for the products, "squeeze", "hold", "carry" (hold, in walking) or "turn"
            (turn_n_m, about the grip axis, N m).
        balance: False leaves forces out of balance (Xie 2014).
        friction: Coefficient; 0.5 while it settles and under a load (Derler & Gerhardt 2012).
        mass_kg, weight_n, density_g_cm3: One of them, of the product, kg, N or g/cm3; acceleration_g: upwards, in
            multiples of 9.81 m/s2; gravity: its direction; mass_at: centre of mass, mm.
        load_n, torque_n_mm, load_at: Further force (N) and torque (N mm), and where, mm.
        preset: "palmar" or "xie2014"; kernel, tissue_model, coupling: single equations.
        tissue: Tissue file (TOML); coating: sleeve "THICKNESS_MM,SHEAR_MODULUS_KPA[,POISSON]".
        shear_modulus_kpa: One shear modulus everywhere, kPa.
        swelling, skin_on_skin, refine, error_band: Parts of the contact; on but skin_on_skin.
        natural_postures, sensors, measured: Files, as on the command line.
        error_budget: Hold each product again with one thing changed at a time.
        unit: Of files that carry none: "mm", "cm", "m", "inch".
        chordal_error_mm, time_limit_s, memory_limit_mb: Of CAD files.
        out: Folder of a report; None: none is written. pictures, language ("en", "de"), project
            (TOML), excel: what it has.
        seed: Kept in the results.
        progress: None, True (a bar) or a callable of (share, activity).

    Raises:
        UsageError, InputError, NumericalError, OutputError; KeyboardInterrupt after Ctrl-C.
    """
    arguments = given(locals())
    arguments["command_line"] = command_of("assess", products, arguments)
    outcome = run_task(_native.assess, arguments, progress=progress)
    if not outcome.has_converged:
        notes.warning("a contact has no solution; see the results")
    return Assessments(outcome)
