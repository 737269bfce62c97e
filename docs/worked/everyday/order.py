"""Which of two taps came first, by their onsets with noise that is larger if the arms are crossed."""
import json
import random
import sys

NOISE = {"uncrossed": 0.05, "crossed": 0.11}  # standard deviation [s]

for line in sys.stdin:
    trial = json.loads(line)
    stimulus = trial["stimulus"][-1]
    noise = random.Random(trial["seed"]).gauss(0.0, NOISE.get(stimulus.get("block"), 0.05))
    print(json.dumps({"answer": "left" if stimulus["onset"] + noise > 0.0 else "right"}), flush=True)
