"""The force study in Python: a dry run, its sessions as frames, the published score of every recall
computed from the samples, and what the conditions did to it. Simulated participants.

    python3 docs/worked/python/force_study.py
"""
import pathlib

import numpy as np
import pandas as pd

import haptrial

EXPERIMENTS = pathlib.Path(__file__).resolve().parents[3] / "experiments"
sessions = haptrial.dry_run(EXPERIMENTS / "force_training.toml", subjects=3, trials=9)

# What was recorded: one frame for the whole study, units beside it.
passes = haptrial.study(sessions)
samples = haptrial.study(sessions, "samples", columns=["pass", "stage", "applied_force"])
who = "simulated participants" if sessions[0].info.simulated else "participants"
print(f"{len(sessions)} {who}, {len(passes)} passes, {len(samples)} samples; "
      f"forces in {samples.attrs['units']['applied_force']}")
run = samples[samples["stage"] == "run"]
print(run.groupby("participant")["applied_force"].describe()[["mean", "std", "max"]].round(2))


def recalls(session):
    """Target and applied force of each completed test pass while the trajectory runs [N]."""
    trials = session.trials
    kept = (trials["phase"] == "test") & (trials["status"] == "completed") & ~trials["practice"]
    for row in trials.index[kept]:
        of_pass = session.samples_of(row, ["stage", "target_force", "applied_force"])
        of_run = of_pass[of_pass["stage"] == "run"]
        yield trials.loc[row], of_run["target_force"].to_numpy(), of_run["applied_force"].to_numpy()


# The score of the report, curve by curve (docs/algorithms/alignment.md).
parts = []
for session in sessions:
    trials, targets, applied = zip(*recalls(session))
    part = haptrial.score(targets, applied, rate=session.info.rate)
    part.insert(0, "subject", session.info.subject)
    part.insert(1, "condition", [trial["condition"] for trial in trials])
    parts.append(part)
scores = pd.concat(parts, ignore_index=True)
print(scores.groupby("condition")["score"].agg(["count", "mean", "std"]).round(3))

# How one recall was paired with its target: by how much the hand ran ahead or behind.
alignment = haptrial.align(targets[0][::10], applied[0][::10], rate=session.info.rate / 10)
path = alignment.path(0)
ahead = (path[:, 0].astype(int) - path[:, 1]) * 10 / session.info.rate
print(f"the first recall of {session.info.subject} is {np.abs(ahead).max():.2f} s off at most")
