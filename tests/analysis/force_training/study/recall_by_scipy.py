"""Gain, phase and coherence of recalled against taught force by scipy.

The file has a line for each instant of all trials, one after the other: taught and recalled force.
Each trial has 1024 instants. Prints the numbers of 1 to 12 cycles a trial, a line each.
"""

import sys

import numpy
from scipy import signal

taught, recalled = numpy.loadtxt(sys.argv[1]).T
welch = {"window": "hann", "nperseg": 1024, "noverlap": 0, "detrend": "constant"}
_, cross = signal.csd(taught, recalled, **welch)
_, power = signal.welch(taught, **welch)
_, coherence = signal.coherence(taught, recalled, **welch)
response = cross / power
for cycle in range(1, 13):
    print(abs(response[cycle]), numpy.angle(response[cycle]), coherence[cycle])
