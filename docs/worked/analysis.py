"""The report's main numbers from scores.csv, with pandas and SciPy.

    python3 analysis.py scores.csv
"""
import sys

import numpy as np
import pandas as pd
from scipy import stats


def show(name, *values):
    print(name, *(f"{value:.15g}" for value in values))


scores = pd.read_csv(sys.argv[1])
groups = {name: group.score for name, group in scores.groupby("condition")}

# Means of the conditions over trials.
for name, values in groups.items():
    show(f"mean {name}", values.mean())

# As published: every trial counts as independent.
f, p = stats.f_oneway(*groups.values())
show("anova_F", f)
show("anova_p", p)
for better, worse in (("visual", "haptic"), ("visuohaptic", "visual")):
    if better in groups and worse in groups:
        t, p = stats.ttest_ind(groups[better], groups[worse], alternative="less")
        show(f"t {better}<{worse}", t)
        show(f"p {better}<{worse}", p)

# Repeated measures: one mean for each participant and condition.
means = scores.groupby(["subject", "condition"]).score.mean().unstack().dropna()
n, k = means.shape
residual = means.sub(means.mean(axis=1), axis=0) - means.mean() + means.to_numpy().mean()
squares_condition = n * ((means.mean() - means.to_numpy().mean()) ** 2).sum()
squares_error = (residual**2).to_numpy().sum()
df_condition, df_error = k - 1, (n - 1) * (k - 1)
f = (squares_condition / df_condition) / (squares_error / df_error)
show("repeated_F", f)
show("repeated_p", stats.f.sf(f, df_condition, df_error))

# Greenhouse and Geisser: how far the differences between conditions are from equal variances.
centre = np.eye(k) - 1 / k
covariance = centre @ means.cov().to_numpy() @ centre
epsilon = np.trace(covariance) ** 2 / (df_condition * (covariance**2).sum())
show("repeated_epsilon", epsilon)
show("repeated_p_corrected", stats.f.sf(f, epsilon * df_condition, epsilon * df_error))
