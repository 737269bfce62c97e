"""Which of the forces it was: the nearest to what is felt, on a logarithmic scale with noise."""
import json
import math
import random
import sys

FORCES = {"weak": 0.3, "light": 0.6, "medium": 1.2, "strong": 2.4, "strongest": 4.0}  # [N]
NOISE = 0.3  # standard deviation of the logarithm of a felt force

for line in sys.stdin:
    trial = json.loads(line)
    force = math.log(trial["stimulus"][-1]["newtons"])
    felt = force + random.Random(trial["seed"]).gauss(0.0, NOISE)
    answer = min(FORCES, key=lambda name: abs(math.log(FORCES[name]) - felt))
    print(json.dumps({"answer": answer}), flush=True)
