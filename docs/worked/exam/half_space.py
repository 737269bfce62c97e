"""The smallest program that sits the exam: it takes every body for the half-space y < 0.

haptrial exam run out/exam --out out/half-space --program python3 docs/worked/exam/half_space.py
"""
import sys

stiffness = 0.0
for line in sys.stdin:
    words = line.split()
    if words[0] == "body":  # body stiffness N/m friction MU rate HZ FILE
        stiffness = float(words[2])
        print("ready", flush=True)
    elif words[0] == "start":  # start X Y Z
        print("ready", flush=True)
    else:  # tick TIME X Y Z
        y = float(words[3])
        print(0.0, stiffness * max(0.0, -y), 0.0, flush=True)
