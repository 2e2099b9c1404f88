# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
"""Whose hands: populations and tables of subjects (`palmar population`)."""

from __future__ import annotations

from typing import Dict, Optional, Sequence, Union

from . import _native
from ._task import Path, Record, Table, given, run_task

__all__ = ["correlate", "describe", "names", "regress", "sample", "show"]


def names() -> Dict[str, str]:
    """Populations that come with Palmar, with their titles."""
    return _native.population_names()


def show(population: Path) -> Record:
    """Dimensions of a population: mean and deviation (mm), how each is known, source, cautions."""
    return run_task(lambda one, *_: _native.population_show(one), str(population), names=["population"])


def sample(
    population: Path,
    *,
    hands: int = 30,
    design: Optional[str] = None,
    seed: Optional[int] = None,
    residuals: Optional[bool] = None,
    boundary_share: Optional[float] = None,
    boundary_points: Optional[int] = None,
    percentiles: Optional[Sequence[float]] = None,
    out: Optional[Path] = None,
) -> Table:
    """Hands of a population (`palmar population sample`).

    Args:
        population: Built-in name, or a population file (.toml).
        hands: Number, of the designs "random" and "latin_hypercube" (McKay 1979; the default).
        design: Also "boundary" (share of people in the ellipse and points on it) or "percentiles".
        residuals: Variation round the regressions.
        out: File to write: .csv or .json.

    Returns:
        A row per hand: sex, age_years, grip_strength_n, dimensions in mm.
    """
    return run_task(_native.population_sample, given(locals()))


def describe(
    file: Path,
    *,
    by: Optional[str] = None,
    where: Union[None, str, Sequence[str]] = None,
    dimension: Union[None, str, Sequence[str]] = None,
    unit: Optional[str] = None,
    out: Optional[Path] = None,
) -> Table:
    """Mean, deviation and percentiles of a table of subjects (`palmar population describe`).

    Args:
        file: CSV, one line per person, units in the headings.
        by: Column whose values group the subjects.
        where: Only subjects that meet it: "sex=F", "age>=40".
        dimension: Only these columns.
        unit: Of dimensions whose heading names none: "mm", "cm", "m", "in".
        out: Folder for tables and pictures.

    Returns:
        A row per group and dimension, in mm.
    """
    return run_task(_native.population_describe, given(locals()))


def correlate(
    file: Path,
    *,
    by: Optional[str] = None,
    where: Union[None, str, Sequence[str]] = None,
    dimension: Union[None, str, Sequence[str]] = None,
    unit: Optional[str] = None,
    confidence: Optional[float] = None,
    out: Optional[Path] = None,
) -> Table:
    """Correlations between the dimensions of a table (`palmar population correlate`).

    Args:
        file, by, where, dimension, unit, out: As in describe().
        confidence: Of the intervals; 0.95.

    Returns:
        A row per pair: r, interval, p value (Holm 1979 over the pairs).
    """
    return run_task(_native.population_correlate, given(locals()))


def regress(
    file: Path,
    *,
    on: Union[None, str, Sequence[str]] = None,
    by: Optional[str] = None,
    where: Union[None, str, Sequence[str]] = None,
    dimension: Union[None, str, Sequence[str]] = None,
    unit: Optional[str] = None,
    confidence: Optional[float] = None,
    population_out: Optional[Path] = None,
    name: Optional[str] = None,
    title: Optional[str] = None,
    out: Optional[Path] = None,
) -> Table:
    """Every dimension of a table on a few of them (`palmar population regress`).

    Args:
        on: Predictors; None: hand_length and hand_circumference.
        population_out: Population file (TOML) to write for studies, its name and title.
        file, by, where, dimension, unit, confidence, out: As in correlate().

    Returns:
        A row per regression: intercept_mm, slopes in mm per mm, residual deviation in mm.
    """
    return run_task(_native.population_regress, given(locals()))
