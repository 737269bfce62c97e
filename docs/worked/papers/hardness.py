"""How hard or how soft a spring is, by a power law with noise."""
import json
import math
import random
import sys

EXPONENT = {"hardness": 0.8, "softness": -0.8}
NOISE = 0.1  # standard deviation of the logarithm of an estimate

for line in sys.stdin:
    trial = json.loads(line)
    stiffness = trial["stimulus"][-1]["stiffness"] / 400.0
    noise = math.exp(random.Random(trial["seed"]).gauss(0.0, NOISE))
    print(json.dumps({"answer": 10.0 * stiffness ** EXPONENT[trial["question"]] * noise}), flush=True)
