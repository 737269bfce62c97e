"""Sessions of haptrial in Python: recorded tables as pandas frames, the C++ analysis on numpy
arrays, procedures, psychometric functions and objects that are touched, for experiments of one's own.

    import haptrial

    session = haptrial.open("P01.h5")
    session.info.rate                     # of the servo loop [Hz]
    session.trials                        # a frame with one row a pass
    session.trials.attrs["units"]         # {"trial": "1", "condition": "", ...}

    samples = haptrial.study("study", table="samples", columns=["pass", "applied_force"])
    scores = haptrial.force_scores("study")

All quantities are in SI units (m, s, N, Hz); a column or key says where one is not. What is wrong
with an input is told in one sentence of a ValueError, the one that the command `haptrial` prints.
"""
from ._procedures import Procedure, procedure, procedures
from ._psychometric import Fit, PsychometricFunction, fit, psychometric_function
from ._run import dry_run
from ._scores import Alignments, align, force_scores, score, score_keys
from ._session import Info, Session, open, study
from ._touch import Contact, SoftBody, TouchedMesh

__all__ = ["Alignments", "Contact", "Fit", "Info", "Procedure", "PsychometricFunction", "Session",
           "SoftBody", "TouchedMesh", "align", "dry_run", "fit", "force_scores", "open",
           "procedure", "procedures", "psychometric_function", "score", "score_keys", "study"]
