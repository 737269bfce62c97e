"""Whether a tap is felt, against a threshold that is higher while the arm moves."""
import json
import random
import sys

THRESHOLD = {"rest": 0.25, "active": 0.45, "passive": 0.45}  # [N]
NOISE = 0.12  # standard deviation [N]

for line in sys.stdin:
    trial = json.loads(line)
    shown = trial["stimulus"][-1]
    felt = shown["level"] + random.Random(trial["seed"]).gauss(0.0, NOISE)
    print(json.dumps({"answer": "yes" if felt > THRESHOLD[shown["block"]] else "no"}), flush=True)
