"""Which of two renderings is more real: the one whose forces are less wrong, as far as that is felt."""
import json
import random
import sys

NOISE = 0.06  # standard deviation of a felt error [N]: 7 % of the force of the recording, 0.8 N

for line in sys.stdin:
    trial = json.loads(line)
    draw = random.Random(trial["seed"])
    first, second = (s["error"] + draw.gauss(0.0, NOISE) for s in trial["stimulus"])
    print(json.dumps({"answer": "first" if first < second else "second"}), flush=True)
