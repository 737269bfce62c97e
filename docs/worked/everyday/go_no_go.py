"""Presses for strong taps, seldom for weak ones, and seldom forgets to press."""
import json
import math
import random
import sys

for line in sys.stdin:
    trial = json.loads(line)
    draw = random.Random(trial["seed"])
    go = trial["stimulus"][-1]["tap"] == "go"
    if draw.random() < (0.96 if go else 0.2):
        time = math.exp(math.log(0.38) + draw.gauss(0.0, 0.15))
        print(json.dumps({"answer": "go", "reaction_time": min(time, 0.9)}), flush=True)
    else:
        print(json.dumps({"answer": "no_go"}), flush=True)
