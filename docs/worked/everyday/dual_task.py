"""Low or high tones, mistaken if they are near; which spring was stiffer is left to the hand."""
import json
import random
import sys

for line in sys.stdin:
    trial = json.loads(line)
    answer = None
    if trial["question"] == "heard":
        stimulus = trial["stimulus"][-1]
        mistaken = random.Random(trial["seed"]).random() < (0.25 if stimulus["high"] < 1500 else 0.02)
        answer = {"low": "high", "high": "low"}[stimulus["tone"]] if mistaken else stimulus["tone"]
    print(json.dumps({"answer": answer}), flush=True)
