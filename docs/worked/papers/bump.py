"""Which surface had the bump: found the more often, the higher it is over a power of its width."""
import json
import math
import random
import sys

EXPONENT = 1.3
AT_5_MM = math.log(0.0001)  # logarithm of the height [m] that is found half of the time, 5 mm wide
SPREAD = 0.5  # of the logarithm

for line in sys.stdin:
    trial = json.loads(line)
    draw = random.Random(trial["seed"])
    bumpy = next(i for i, shown in enumerate(trial["stimulus"]) if shown["bump"] == 1)
    shown = trial["stimulus"][bumpy]
    least = AT_5_MM + EXPONENT * (shown["ln_width"] - math.log(0.005))
    found = shown["ln_height"] + draw.gauss(0.0, SPREAD) > least
    answer = bumpy if found else draw.randrange(2)
    print(json.dumps({"answer": trial["choices"][answer]}), flush=True)
