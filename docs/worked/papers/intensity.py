"""Which of two vibrations is stronger, by their levels with the same noise at every intensity."""
import json
import math
import random
import sys

NOISE = 1.5  # standard deviation of a felt level [dB]

for line in sys.stdin:
    trial = json.loads(line)
    draw = random.Random(trial["seed"])
    first, second = (
        20.0 * math.log10(s["amplitude"]) + draw.gauss(0.0, NOISE) for s in trial["stimulus"]
    )
    print(json.dumps({"answer": "first" if first > second else "second"}), flush=True)
