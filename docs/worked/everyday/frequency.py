"""Which of two vibrations is faster, by their frequencies with a Weber fraction of noise."""
import json
import math
import random
import sys

NOISE = 0.09  # standard deviation of the logarithm of a felt frequency

for line in sys.stdin:
    trial = json.loads(line)
    draw = random.Random(trial["seed"])
    first, second = (math.log(s["frequency"]) + draw.gauss(0.0, NOISE) for s in trial["stimulus"])
    print(json.dumps({"answer": "first" if first > second else "second"}), flush=True)
