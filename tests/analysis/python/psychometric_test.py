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

    def test_is_the_reports_if_answers_scatter(self):
        right = {("P01", "off"): [12, 13, 18, 23, 21, 25], ("P01", "on"): [12, 14, 17, 21, 24, 25],
                 ("P02", "off"): [12, 14, 17, 21, 24, 25], ("P02", "on"): [13, 14, 19, 22, 23, 25]}
        rows = [(*name, level, int(trial < count)) for name, counts in right.items()
                for level, count in enumerate(counts, 1) for trial in range(25)]
        table = support.FOLDER / "scattered.csv"
        pd.DataFrame(rows, columns=["participant", "cond", "level", "correct"]).to_csv(
            table, index=False)
        folder = support.FOLDER / "scattered"
        for arguments in (["import", table, "--out", folder, "--guess", "0.5", "--factor", "cond"],
                          ["analyze", folder]):
            status, _, error = support.command(*arguments)
            self.assertEqual(status, 0, error)
        written = pd.read_csv(folder / "estimates.csv", float_precision="round_trip")
        written = written[written["source"] == "likelihood"]
        for (participant, condition), counts in right.items():
            given = dict(function="norm", guess=0.5)
            fit = haptrial.fit(range(1, 7), counts, [25] * 6, **given, participant=participant,
                               condition=condition)
            own = written[(written["participant"] == participant) &
                          (written["cond"] == condition)].set_index("name")
            for name, value, interval in (("threshold", fit.threshold, fit.threshold_interval),
                                          ("width", fit.width, fit.width_interval)):
                self.assertEqual((value, *interval),
                                 tuple(own.loc[name, ["estimate", "low", "high"]]))
            plain = haptrial.fit(range(1, 7), counts, [25] * 6, **given, resamples=0)
            self.assertEqual(plain.threshold_interval, fit.threshold_interval)  # by chi-square
            self.assertAlmostEqual(plain.deviance_p, fit.deviance_p, delta=0.15)

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
        with self.assertRaisesRegex(ValueError, "correct has 0.55; allowed: whole numbers"):
            haptrial.fit([1.0, 2.0], [0.55, 1.0], [20, 20])  # shares in place of counts
        with self.assertRaisesRegex(ValueError, "total has 20.7; allowed: whole numbers"):
            haptrial.fit([1.0, 2.0], [11, 14], [20.7, 20.7])
        with self.assertRaisesRegex(ValueError, "correct has nan"):
            haptrial.fit([1.0, 2.0], [0.0, math.nan])
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
