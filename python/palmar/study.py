# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Many hands, several products (`palmar study`)."""

from __future__ import annotations

import os
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

from . import _native
from ._native import Product
from ._task import Path, Paths, Progress, Record, Table, Vector, given, run_task

__all__ = ["Study", "export", "grasps", "merge", "plan", "report", "resume", "run",
           "statistics", "status"]


class Study:
    """A study that ran: its store, which every function here takes as path, and how it went."""

    def __init__(self, summary: Dict[str, Any]) -> None:
        self.store: str = summary["store"]
        self.summary: Record = summary

    def __fspath__(self) -> str:
        return self.store

    def __repr__(self) -> str:
        return f"<palmar.study.Study {self.store}: {self.summary['grasps']} grasps>"


def _source(product: Union[Path, Product]) -> str:
    """The file or the generating words of a product: what a study keeps of it."""
    return product.source if isinstance(product, Product) else os.fspath(product)


def _asked(arguments: Dict[str, Any]) -> Dict[str, Any]:
    products = arguments["products"]
    if isinstance(products, (str, os.PathLike, Product)):
        products = [products]
    return {**given(arguments), "products": [_source(one) for one in products]}


def run(
    file: Optional[Path] = None,
    *,
    products: Union[Path, Product, Sequence[Union[Path, Product]]] = (),
    population: Union[None, Path, Sequence[Path]] = None,
    hands: Optional[int] = None,
    out: Optional[Path] = None,
    unit: Optional[str] = None,
    profile: Union[None, str, Sequence[str]] = None,
    grip: Union[None, str, Sequence[str]] = None,
    hold: Union[None, int, Path] = None,
    part: Union[None, int, str] = None,
    along: Optional[float] = None,
    toward: Union[None, str, Vector] = None,
    up: Union[None, str, Vector] = None,
    purpose: Optional[str] = None,
    hand: Optional[Path] = None,
    mass_kg: Optional[float] = None,
    task: Optional[str] = None,
    turn_n_m: Optional[float] = None,
    grip_force_n: Optional[float] = None,
    strength_share: Optional[float] = None,
    limit_depths: Optional[bool] = None,
    seed: Optional[int] = None,
    shard: Optional[Tuple[int, int]] = None,
    progress: Progress = None,
) -> Study:
    """Runs a study, or goes on with it where its store is there (`palmar study run`).

    Every finished grasp is kept at once: after Ctrl-C (KeyboardInterrupt), resume() goes on.

    Args:
        file: Study file (.toml), which says all that follows but out, seed and shard.
        products: Files, Products, or words ("made: prism width_mm=35").
        population: Built-in ones (palmar.population.names()), files (.toml) or tables of given hands
            (.csv); None: "xie2014". hands: to draw from each; 30.
        out: Store to write, *.palmar.
        unit: Of files that carry none: "mm", "cm", "m", "inch".
        profile: "none", "thick_gloves" ...; grip: "any", "tripod" ...
        hold, part, along, toward, up, purpose: As in palmar.assess().
        hand: Hand that is scaled: "template" or a .hand.glb file.
        mass_kg: Of every product, kg.
        task, turn_n_m: As in palmar.assess(); N m.
        grip_force_n: N; strength_share: of each person's own strength; limit_depths: as closing to
            the limit depths made it. None: the usual grip force, the same for all.
        shard: (k, n): only every n-th hand, from the k-th; merge() joins the shards.
    """
    return Study(run_task(_native.study_run, _asked(locals()), progress=progress))


def resume(store: Path, *, progress: Progress = None) -> Study:
    """Goes on with a study that was stopped (`palmar study resume`)."""
    return Study(run_task(_native.study_resume, os.fspath(store), progress=progress,
                          names=["store"]))


def plan(
    file: Optional[Path] = None,
    *,
    products: Union[Path, Product, Sequence[Union[Path, Product]]] = (),
    population: Union[None, Path, Sequence[Path]] = None,
    hands: Optional[int] = None,
    unit: Optional[str] = None,
    profile: Union[None, str, Sequence[str]] = None,
    grip: Union[None, str, Sequence[str]] = None,
    seed: Optional[int] = None,
    sample: bool = True,
    progress: Progress = None,
) -> Record:
    """What would run, how long (s) and in how much memory (MB) (`palmar study plan`).

    Args:
        sample: Measure a few grasps for the estimate. The others: as in run().
    """
    return run_task(_native.study_plan, _asked(locals()), progress=progress)


def merge(shards: Sequence[Path], out: Path, *, progress: Progress = None) -> Study:
    """Joins finished shards, files or folders, to the store of the whole (`palmar study merge`)."""
    summary = run_task(
        lambda bar, _: _native.study_merge([os.fspath(one) for one in shards], os.fspath(out), bar),
        progress=progress, names=["shards", "out"])
    return Study(summary)


def status(*stores: Path) -> Record:
    """How far a study is, over stores and folders; seconds_left in s (`palmar study status`)."""
    return run_task(lambda *_: _native.study_status([os.fspath(one) for one in stores]),
                    names=["stores"])


def report(
    store: Path,
    out: Path,
    *,
    threshold_kpa: Optional[float] = None,
    significance: Optional[float] = None,
    most_grasps: Optional[int] = None,
    language: Optional[str] = None,
    pictures: Optional[bool] = None,
    figures: Optional[bool] = None,
    excel: Optional[bool] = None,
    project: Optional[Path] = None,
    progress: Progress = None,
) -> str:
    """The report of a study, one page (`palmar study report`); returns its path.

    Args:
        out: Folder for page, tables and figures.
        threshold_kpa: Maps show the share of hands above it, kPa; 50: blood flow in the skin stops.
        significance: Corrected p value below which a difference is named; 0.05.
        most_grasps: In the 3-D view; 0: none.
        language: "en" or "de"; project: TOML file of the project.
    """
    return run_task(lambda given, bar, _: _native.study_report(given, bar), given(locals()),
                    progress=progress)


def export(store: Path, folder: Path, *, fields: bool = False, progress: Progress = None
           ) -> List[str]:
    """Every table of a study as CSV, units in the headings (`palmar study export`).

    Args:
        fields: Also the pressure (MPa) of every loaded vertex: large files.
    """
    return run_task(
        lambda bar, _: _native.study_export(os.fspath(store), os.fspath(folder), fields, bar),
        progress=progress, names=["store", "folder"])


def grasps(store: Path) -> Table:
    """A row per finished grasp: hand, product, outcome, force_n, contact_area_mm2, pressures in MPa,
    every index. What a grasp doesn't have is nan."""
    return run_task(lambda *_: _native.study_grasps(os.fspath(store)), names=["store"])


def statistics(
    store: Path,
    *,
    significance: Optional[float] = None,
    language: Optional[str] = None,
) -> Dict[str, Any]:
    """What a study comes to: the numbers of `palmar study compare` and of the report's tables.

    Args:
        significance: Corrected p value (Holm 1979) below which a difference is named; 0.05.

    Returns:
        "sentence" and "reasons"; tables: "statistics", "comparison" (per pair: paired t test,
        Wilcoxon, Cohen's dz), "accommodation", "outcomes", "holds", "regions" ...; units are in the
        headings or in a column.
    """
    return run_task(lambda given, *_: _native.study_statistics(given), given(locals()))
