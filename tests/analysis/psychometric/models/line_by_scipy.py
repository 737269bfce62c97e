"""A line through points with errors in both directions, by SciPy's orthogonal distance regression.

The file has a line for each point: x, y and their standard errors. Prints slope, intercept and the
standard error of the slope, which scales with the scatter around the line.
"""

import sys

import numpy
from scipy import odr

x, y, error_x, error_y = numpy.loadtxt(sys.argv[1]).T
data = odr.RealData(x, y, sx=error_x, sy=error_y)
fit = odr.ODR(data, odr.unilinear, beta0=[1.0, 0.0], sstol=1e-15, partol=1e-15).run()
print(fit.beta[0], fit.beta[1], fit.sd_beta[0])
