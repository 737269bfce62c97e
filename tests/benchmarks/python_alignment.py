"""What Python, with the paths, adds to the time that C++ takes for slopes and alignments of 1,000
curves. Other work on the machine only adds, so the least of some runs counts.

    PYTHONPATH=build/python python_alignment.py
"""

import time

import haptrial
import numpy as np

rng = np.random.default_rng(1)
reference, *curves = np.cumsum(rng.normal(size=(1001, 1000)), axis=1)
shares = []
for _ in range(12):
    start = time.perf_counter()
    found = haptrial.align(reference, curves, threads=1)
    paths = [found.path(i) for i in range(len(found))]
    shares.append((time.perf_counter() - start) / found.seconds - 1.0)
print(f"{len(paths)} alignments in {found.seconds:.3f} s; Python adds {100 * min(shares):.2f} %")
