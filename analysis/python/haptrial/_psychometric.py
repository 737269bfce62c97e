"""Psychometric functions and their fit."""
from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from . import _haptrial

PsychometricFunction = _haptrial.PsychometricFunction


@dataclasses.dataclass(frozen=True)
class Fit:
    """A psychometric function that was fitted. Intervals hold the truth in 95 % of cases, or are
    NaN, and `no_interval` says why; a side that is infinite (of a width also 0, of a logarithmic axis its origin) means that the
    answers do not tell how far it goes."""
    function: PsychometricFunction               #: probability of answer 1 at a level
    threshold: float                             #: level at which the function, free of guesses and
                                                 #: lapses, is `share` [unit of the level]
    threshold_interval: tuple[float, float]      #: [unit of the level]
    width: float                                 #: from tail to 1 - tail [width_unit]
    width_interval: tuple[float, float]          #: [width_unit]
    width_unit: str                              #: "" on a linear axis: the unit of the level
    lapse: float                                 #: 1 - upper asymptote [1]
    guess: float                                 #: lower asymptote [1]
    log_likelihood: float                        #: without binomial coefficients
    deviance: float                              #: 2 (log-likelihood of the shares - its own)
    deviance_p: float                            #: share of simulated observers with this function
                                                 #: whose deviance is as large, or that of
                                                 #: chi-square; NaN: adaptive, or too few answers
    undetermined: bool                           #: the answers do not tell threshold and width
    no_interval: str                             #: why there are no intervals; "": there are


def psychometric_function(function: str = "logistic", *, threshold: float, width: float,
                          guess: float = 0.0, lapse: float = 0.0, scale: str = "",
                          origin: float = 0.0, share: float = 0.5,
                          tail: float = 0.05) -> PsychometricFunction:
    """psi(level) = guess + (1 - guess - lapse) S(x).

    function   a sigmoid by its name in psignifit 4 or QUEST+: logistic, norm, gumbel, rgumbel,
               weibull, logn, tdist …; "neg_" before it makes it fall
    threshold  the level at which S is `share` [unit of the level]
    width      from S = tail to S = 1 - tail [unit of x]
    scale      of x: linear, log10, ln or decibel, of the level less `origin`; empty: ln for
               weibull and logn, else linear"""
    return _haptrial.psychometric_function(function, threshold, width, guess, lapse, scale, origin,
                                           share, tail)


def _counts(values: npt.ArrayLike, name: str) -> npt.NDArray[np.int64]:
    """Counts as integers; a cast alone would cut shares and other fractions off."""
    given = np.asarray(values, dtype=float)
    fractions = given[~(np.isfinite(given) & (given == np.rint(given)))]
    if fractions.size:
        raise ValueError(f"{name} has {fractions[0]:g}; allowed: whole numbers, of answers")
    return given.astype(int)


def fit(levels: npt.ArrayLike, correct: npt.ArrayLike, total: npt.ArrayLike | None = None, *,
        function: str = "norm", guess: float | None = 0.5,
        lapse: tuple[float, float] = (0.0, 0.2), scale: str = "", origin: float = 0.0,
        share: float = 0.5, tail: float = 0.05, adaptive: bool = False,
        presentable: tuple[float, float] | None = None, resamples: int = 1999,
        participant: str = "", condition: str = "") -> Fit:
    """Fits a psychometric function as reports do: estimates and 95 % intervals of one method.
    Intervals of listed levels are longer if answers scatter more than chance (deviance_p < 0.2).

    levels    (blocks) [unit of the level]
    correct   (blocks) answers 1 ("correct", "yes") at each level
    total     (blocks) answers at each level; without it every item is one trial, correct 0 or 1
    guess     known lower asymptote of a forced choice, 1 / alternatives; None: it is fitted
              (yes/no tasks), 0: known to be 0
    lapse     lowest and highest lapse rate that is allowed; a guess rate that is fitted
              has the same highest [1]
    adaptive  the levels depended on the answers (staircase, QUEST+): medians and intervals of the
              posterior (docs/algorithms/procedure-coverage.md), else of the likelihood
    presentable   lowest and highest level that a trial could have had, if no trial had them
              [unit of the level]
    resamples   simulated observers from whom deviance_p follows; 0: none, and deviance_p is that of
              chi-square
    participant, condition   of a report, "P01" and "soft, left": deviance_p is then drawn as there
    function, scale, origin, share, tail   as psychometric_function()"""
    right = _counts(correct, "correct")
    asked = np.ones_like(right) if total is None else _counts(total, "total")
    return Fit(**_haptrial.fit(np.asarray(levels, dtype=float), right.tolist(), asked.tolist(),
                               function, guess, lapse, scale, origin, share, tail, adaptive,
                               presentable, resamples, participant, condition))
