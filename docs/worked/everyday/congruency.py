"""Which finger was tapped: slower and more often wrong with the light beside the other finger."""
import json
import math
import random
import sys

for line in sys.stdin:
    trial = json.loads(line)
    stimulus = trial["stimulus"][-1]
    draw = random.Random(trial["seed"])
    disturbed = stimulus["congruency"] == "incongruent"
    right = draw.random() > (0.12 if disturbed else 0.03)
    other = {"upper": "lower", "lower": "upper"}
    finger = stimulus["finger"] if right else other[stimulus["finger"]]
    time = math.exp(math.log(0.52 if disturbed else 0.44) + draw.gauss(0.0, 0.2))
    print(json.dumps({"answer": finger, "reaction_time": time}), flush=True)
