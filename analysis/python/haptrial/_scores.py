"""Alignment and scores of force curves, by the C++ analysis."""
from __future__ import annotations

import io
from typing import Iterable, Sequence

import numpy as np
import numpy.typing as npt
import pandas as pd

from . import _haptrial, _toml
from ._session import Path, _files, _hdf5

Alignments = _haptrial.Alignments
Curves = Sequence[npt.ArrayLike]


def align(reference: npt.ArrayLike | Curves, curves: npt.ArrayLike | Curves, *,
          rate: float = 1000.0, force_weight: float = 1.0, slope_weight: float = 0.5,
          penalty: float = 0.5, power: float = 1.0, step_pattern: str = "published",
          window: int | None = None, open_begin: bool = False, open_end: bool = False,
          threads: int = 1) -> Alignments:
    """Aligns force curves with a reference at minimum cost, by dynamic programming.

    reference   (samples) force [N], for all curves; or one for each, as a list
    curves      (curves x samples) forces [N], or a list of curves of any lengths
    rate        of all samples; slopes come from it by central differences [Hz]

    The error of a pair is force_weight |F - G|^power + slope_weight |F' - G'|^power [1]; each step
    that does not advance in both curves costs `penalty` more [1]. step_pattern is published,
    symmetric1, symmetric2, asymmetric or symmetricP1; window a band around the diagonal [samples];
    open_begin and open_end let a path leave out samples of the curve at its ends.

    Other Python threads run meanwhile. The result does not depend on `threads` (0: one for each
    processor), nor on the number of curves, bit for bit (docs/algorithms/alignment.md)."""
    found = _haptrial.align(_listed(reference), _listed(curves), rate, force_weight, slope_weight,
                            penalty, power, step_pattern, window, open_begin, open_end, threads)
    return found


def score(target: npt.ArrayLike | Curves, applied: npt.ArrayLike | Curves, *,
          rate: float = 1000.0, threads: int = 1, **keys) -> pd.DataFrame:
    """Scores recalled force curves as reports of force training do.

    target    (samples) force to recall [N], for all curves; or one for each, as a list
    applied   (curves x samples) forces applied [N], or a list of curves of any lengths
    rate      of all samples [Hz]
    keys      of [analysis] in a definition, in place of score_keys()

    One row a curve: score (0 is perfect recall), alignment_cost [1], rms_force [N] and rms_slope
    [N/s] after the alignment, rms_unaligned [N] before it."""
    text = "[guidance]\n" + _toml.table("analysis", {**score_keys(), **keys})
    numbers = _haptrial.scores(_listed(target), _listed(applied), rate, text, threads)
    names = ["score", "alignment_cost", "rms_force", "rms_slope", "rms_unaligned"]
    frame = pd.DataFrame(numbers, columns=names)
    frame.attrs["units"] = dict(zip(names, ["1", "1", "N", "N/s", "N"]))
    return frame


def score_keys() -> dict:
    """The keys of [analysis] that score() takes for granted, with their values."""
    return _haptrial.score_defaults()


def force_scores(where: Path | Iterable[Path], threads: int = 0) -> pd.DataFrame:
    """The scored trials of a study of force training, computed from its session files: the columns
    of scores.csv, each session scored as its own definition states.

    where    session files, a folder of them, or a list of both
    threads  0: as many as there are processors"""
    with _hdf5():
        table = _haptrial.study_scores(_files(where), threads)
    return pd.read_csv(io.StringIO(table), float_precision="round_trip",
                       dtype={"subject": str, "condition": str, "flags": str})


def _listed(curves: npt.ArrayLike | Curves) -> list:
    """One curve is a list of one; the rows of a matrix are curves."""
    if isinstance(curves, np.ndarray):
        return [curves] if curves.ndim < 2 else list(curves)
    curves = list(curves)
    return [np.asarray(curves, dtype=float)] if curves and np.ndim(curves[0]) == 0 else curves
