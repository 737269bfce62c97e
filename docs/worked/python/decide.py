"""Answers of one's own for virtual participants, for [observer.script] in a definition: which of two
intervals was greater, by a memory of the first one that is drawn towards what is usual (the central
tendency of judgement, Hollingworth 1910). Who decides so is right more often if the unusual one comes
second.

One line of JSON comes for each question, and one goes back. Whatever else is printed is ignored;
"answer": null leaves the answer to the participant. An error ends the dry run with a sentence.
"""
import json
import math
import random
import sys

USUAL = 300.0  # percept, here a stiffness [N/m]
PULL = 0.6     # share of the way towards it, in the logarithm; 0: none
LAPSE = 0.02   # probability of an answer at random


def decide(trial):
    draw = random.Random(trial["seed"])  # the same in every run of the session
    if draw.random() < LAPSE:
        return draw.choice(trial["choices"])
    first, second = (math.log(max(felt, 1e-9)) for felt in trial["percepts"])
    remembered = (1 - PULL) * first + PULL * math.log(USUAL)
    return trial["choices"][1 if second > remembered else 0]


for line in sys.stdin:
    print(json.dumps({"answer": decide(json.loads(line))}))
