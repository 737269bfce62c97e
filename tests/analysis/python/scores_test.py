"""Scores and alignments: the numbers of the command, to the bit."""
import json
import unittest

import numpy as np
import pandas as pd

import haptrial
import support

SCORES = ["score", "alignment_cost", "rms_force", "rms_slope", "rms_unaligned"]


def written_scores():
    return pd.read_csv(support.force_study() / "scores.csv", float_precision="round_trip")


class ForceScoresTest(unittest.TestCase):
    def test_of_session_files_are_those_of_the_command(self):
        pd.testing.assert_frame_equal(haptrial.force_scores(support.force_study()),
                                      written_scores(), check_exact=True, check_dtype=False)

    def test_of_curves_from_frames_are_those_of_the_command(self):
        """The documented way by hand: the samples of a test pass while the trajectory runs."""
        found = []
        for path in sorted(support.force_study().glob("*.h5")):
            session = haptrial.open(path)
            trials = session.trials
            kept = (trials["phase"] == "test") & (trials["status"] == "completed") & ~trials["practice"]
            targets, applied = [], []
            for row in trials.index[kept]:
                samples = session.samples_of(row, ["stage", "target_force", "applied_force"])
                run = samples[samples["stage"] == "run"]
                targets.append(run["target_force"].to_numpy())
                applied.append(run["applied_force"].to_numpy())
            found.append(haptrial.score(targets, applied, rate=session.info.rate))
        found = pd.concat(found, ignore_index=True)
        pd.testing.assert_frame_equal(found, written_scores()[SCORES], check_exact=True)

    def test_the_means_of_the_report(self):
        statistics = json.loads((support.force_study() / "statistics.json").read_text())
        means = haptrial.force_scores(support.force_study()).groupby("condition")["score"].mean()
        for condition in statistics["conditions"]:
            self.assertAlmostEqual(means[condition["condition"]],
                                   condition["pooled_trials"]["mean"], places=12)

    def test_keys_are_those_of_a_definition(self):
        ramp = np.linspace(0.0, 2.0, 500)
        with self.assertRaisesRegex(ValueError, "analysis.samples is 1; allowed: "):
            haptrial.score(ramp, ramp, samples=1)
        with self.assertRaisesRegex(ValueError, "a curve has 2 dimensions"):
            haptrial.score(ramp, [np.zeros((2, 2))])
        self.assertEqual(haptrial.score(ramp, ramp, filter_width=0.0)["score"][0], 0.0)


class AlignTest(unittest.TestCase):
    def curves(self, count, samples):
        rng = np.random.default_rng(3)
        steps = rng.normal(0.0, 0.02, (count, samples))
        return np.cumsum(steps, axis=1)

    def plain_cost(self, reference, curve, rate):
        """The published recursion, cell by cell, in double precision."""
        slopes = [np.gradient(each, 1.0 / rate) for each in (reference, curve)]
        error = (np.abs(reference[:, None] - curve[None, :]) +
                 0.5 * np.abs(slopes[0][:, None] - slopes[1][None, :]))
        cost = np.full(error.shape, np.inf)
        cost[0, 0] = error[0, 0]
        for i in range(error.shape[0]):
            for j in range(error.shape[1]):
                before = [cost[i, j]] if i == j == 0 else []
                if i and j:
                    before.append(cost[i - 1, j - 1] + error[i, j])
                if i:
                    before.append(cost[i - 1, j] + error[i, j] + 0.5)
                if j:
                    before.append(cost[i, j - 1] + error[i, j] + 0.5)
                cost[i, j] = min(before)
        return cost[-1, -1]

    def test_costs_are_those_of_the_plain_recursion(self):
        reference, *curves = self.curves(4, 60)
        found = haptrial.align(reference, curves, rate=50.0)
        for i, curve in enumerate(curves):
            self.assertAlmostEqual(found.costs[i], self.plain_cost(reference, curve, 50.0), places=4)
            path = found.path(i)
            self.assertEqual(path[0].tolist(), [0, 0])
            self.assertEqual(path[-1].tolist(), [59, 59])
            self.assertEqual(found.weights[i], len(path))

    def test_a_batch_is_each_alone_to_the_bit(self):
        reference, *curves = self.curves(9, 200)
        together = haptrial.align(reference, curves, threads=2)
        for i, curve in enumerate(curves):
            alone = haptrial.align(reference, curve)
            self.assertEqual(alone.costs[0], together.costs[i])
            np.testing.assert_array_equal(alone.path(0), together.path(i))

    def test_paths_outlive_their_batch(self):
        curve = np.sin(np.arange(50.0))
        path = haptrial.align(curve, curve).path(0)
        np.testing.assert_array_equal(path, np.repeat(np.arange(50)[:, None], 2, axis=1))

    def test_refuses_in_a_sentence(self):
        curve = np.zeros(10)
        with self.assertRaisesRegex(ValueError, "step_pattern is 'x'; allowed: published, "):
            haptrial.align(curve, curve, step_pattern="x")
        with self.assertRaisesRegex(ValueError, "2 references for 3 curves"):
            haptrial.align([curve] * 2, [curve] * 3)
        with self.assertRaises(ValueError):
            haptrial.align(curve, [np.full(10, np.nan)])
        with self.assertRaises(IndexError):
            haptrial.align(curve, curve).path(1)


if __name__ == "__main__":
    unittest.main()
