"""Which of three is different: the one whose percept is farthest from the mean of the other two."""
import json
import math
import sys

for line in sys.stdin:
    trial = json.loads(line)
    felt = [math.log(max(percept, 1e-9)) for percept in trial["percepts"]]
    apart = [abs(one - (sum(felt) - one) / 2.0) for one in felt]
    print(json.dumps({"answer": trial["choices"][apart.index(max(apart))]}), flush=True)
