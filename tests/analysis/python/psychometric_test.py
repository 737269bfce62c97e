"""Psychometric functions and their fit: the numbers of the report."""
import math
import unittest

import numpy as np
import pandas as pd

import haptrial
import support


def answers(participant):
    """Levels and outcomes of the trials that count."""
    folder = support.stiffness_study()
    levels = haptrial.study(folder / f"{participant}.h5", "levels")
    trials = haptrial.open(folder / f"{participant}.h5").trials.loc[levels["pass"]].reset_index()
    kept = ~trials["practice"] & (trials["status"] == "completed")
    return levels[kept.to_numpy()]


class FitTest(unittest.TestCase):
    def test_is_the_reports(self):
        written = pd.read_csv(support.stiffness_study() / "estimates.csv",
                              float_precision="round_trip")
        written = written[written["source"] == "posterior"].set_index(["participant", "name"])
        for participant in ("S01", "S02"):
            trials = answers(participant)
            fit = haptrial.fit(trials["applied"], trials["outcome"], function="weibull", guess=0.5,
                               scale="log10", origin=300.0, adaptive=True,
                               presentable=(305.0, 600.0))
            for name, value, interval in (("threshold", fit.threshold, fit.threshold_interval),
                                          ("width", fit.width, fit.width_interval)):
                row = written.loc[(participant, name)]
                self.assertEqual((value, *interval), (row["estimate"], row["low"], row["high"]))
            self.assertEqual(fit.lapse, written.loc[(participant, "lapse_rate"), "estimate"])
            self.assertEqual(fit.width_unit, "log10")

    def test_single_trials_and_their_sums_are_the_same(self):
        levels, right = [1.0, 2.0, 3.0, 4.0], [11, 13, 18, 20]
        pooled = haptrial.fit(levels, right, [20] * 4)
        trials = np.repeat(levels, 20)
        single = haptrial.fit(trials, np.concatenate([np.arange(20) < n for n in right]))
        self.assertEqual(pooled.threshold, single.threshold)
        self.assertEqual(pooled.threshold_interval, single.threshold_interval)

    def test_finds_the_function_that_the_shares_lie_on(self):
        true = haptrial.psychometric_function("norm", threshold=3.0, width=2.0, guess=0.5)
        levels = np.linspace(1.0, 5.0, 9)
        count = 200000
        fit = haptrial.fit(levels, np.rint(count * true(levels)).astype(int), [count] * 9,
                           guess=0.5)
        self.assertAlmostEqual(fit.threshold, 3.0, places=3)
        self.assertAlmostEqual(fit.width, 2.0, places=2)
        self.assertFalse(fit.undetermined)

    def test_an_open_side_is_infinite(self):
        fit = haptrial.fit([1.0, 2.0, 3.0], [10, 20, 20], [20, 20, 20], lapse=(0.0, 0.0))
        self.assertEqual(fit.width_interval[0], 0.0)  # no step is too steep

    def test_refuses_in_a_sentence(self):
        with self.assertRaisesRegex(ValueError, "3, 2 and 2 items"):
            haptrial.fit([1.0, 2.0, 3.0], [1, 1])
        with self.assertRaisesRegex(ValueError, "weibull"):
            haptrial.fit([1.0, 2.0], [1, 0], function="sine")
        with self.assertRaises(ValueError):
            haptrial.fit([1.0, 2.0], [3, 0], [2, 2])
        with self.assertRaisesRegex(ValueError, "allowed: linear, log10, ln, decibel"):
            haptrial.fit([1.0, 2.0], [1, 0], scale="log")


class FunctionTest(unittest.TestCase):
    def test_is_the_formula(self):
        function = haptrial.psychometric_function("logistic", threshold=2.0, width=3.0, guess=0.25,
                                                  lapse=0.05)
        levels = np.linspace(-3.0, 7.0, 11)
        rate = 2.0 * math.log(0.95 / 0.05) / 3.0
        given = 0.25 + 0.7 / (1.0 + np.exp(-rate * (levels - 2.0)))
        np.testing.assert_allclose(function(levels), given, rtol=1e-12)
        self.assertAlmostEqual(function(function.level_for(0.6)), 0.6, places=12)
        self.assertAlmostEqual(function.level_for_share(0.5), 2.0, places=12)
        h = 1e-5
        self.assertAlmostEqual(function.slope(1.3), (function(1.3 + h) - function(1.3 - h)) / (2 * h),
                               places=8)
        self.assertEqual(function.parameters["guess"], 0.25)


if __name__ == "__main__":
    unittest.main()
