"""How heavy a load is: its mass, divided by a power of the size that is seen."""
import json
import math
import random
import sys

EXPONENT = {"seen": 0.3, "unseen": 0.0}  # of the size
NOISE = 0.1  # standard deviation of the logarithm of an estimate

for line in sys.stdin:
    trial = json.loads(line)
    shown = trial["stimulus"][-1]
    size = (shown["size"] / 0.04) ** EXPONENT[shown["block"]]
    noise = math.exp(random.Random(trial["seed"]).gauss(0.0, NOISE))
    print(json.dumps({"answer": 50.0 * shown["mass"] / size * noise}), flush=True)
