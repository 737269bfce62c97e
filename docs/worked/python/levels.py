"""Levels of one's own, for [level_script] in a definition: the next one lies where a function fitted
to the answers so far has its threshold, by the greatest likelihood over a grid.

One line of JSON comes before each trial, and one goes back. Whatever else is printed is ignored;
"level": null leaves the choice to the definition's own procedure, as an error does.
"""
import json
import math
import sys

GUESS, LAPSE, WIDTH = 0.5, 0.02, 0.3  # of two intervals; width in log10 of the level's difference
STEPS = 60


def probability(level, threshold, reference):
    """Of a right answer, by a logistic function of the logarithm of the difference."""
    x = math.log10((level - reference) / (threshold - reference)) / WIDTH
    return GUESS + (1 - GUESS - LAPSE) / (1 + math.exp(-4 * x))


def likeliest(history, low, high, reference):
    ratio = (high - reference) / (low - reference)
    grid = [reference + (low - reference) * ratio ** (k / STEPS) for k in range(STEPS + 1)]

    def log_likelihood(threshold):
        total = 0.0
        for trial in history:
            p = probability(trial["level"], threshold, reference)
            total += math.log(p if trial["answer"] == 1 else 1 - p)
        return total

    return max(grid, key=log_likelihood)


for line in sys.stdin:
    trial = json.loads(line)
    history = trial["history"]  # of this track: levels that were presented, 1 for a right answer
    first = len(history) < 4    # an easy beginning
    level = trial["proposed"] if first else likeliest(history, trial["low"], trial["high"], 300.0)
    print(json.dumps({"level": level}))
