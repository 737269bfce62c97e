"""Procedures as objects: what a session of the same definition did."""
import unittest

import numpy as np
import pandas as pd

import haptrial
import support

STAIRCASE = {"kind": "staircase", "range": [0.0, 10.0], "start": 8.0, "steps": [2.0, 1.0],
             "down": 2, "stop": {"reversals": 8, "trials": 60}}


class ReplayTest(unittest.TestCase):
    def test_asks_for_the_levels_of_the_session(self):
        written = pd.read_csv(support.stiffness_study() / "estimates.csv",
                              float_precision="round_trip")
        written = written[written["source"] == "procedure"].set_index(["participant", "track"])
        for name in ("S01", "S02"):
            session = haptrial.open(support.stiffness_study() / f"{name}.h5")
            trials = session.trials
            tracks = haptrial.procedures(session.info.definition)
            self.assertEqual(set(tracks), {"from far above", "from near above"})
            levels = session.table("levels")
            levels = levels[~trials["practice"].to_numpy()[levels["pass"]]]
            for row in levels.itertuples():
                track = tracks[row.track]
                self.assertFalse(track.finished)
                self.assertEqual(track.next(), row.asked)
                track.answer(row.outcome, row.applied)
            for track in tracks.values():
                self.assertTrue(track.finished)
                self.assertEqual(track.estimates[0]["value"],
                                 written.loc[(name, track.name), "estimate"])


class ProcedureTest(unittest.TestCase):
    def test_a_staircase_by_hand(self):
        track = haptrial.procedure(STAIRCASE)
        self.assertEqual((track.kind, track.variables, track.estimates), ("staircase", ["level"], []))
        asked = []
        for right in (True, True, True, True, False, True):
            asked.append(track.next())
            track.answer(right)
        self.assertEqual(asked, [8.0, 8.0, 6.0, 6.0, 4.0, 5.0])
        self.assertEqual(track.outcomes[:2], [(8.0, 1.0), (8.0, 1.0)])

    def test_quest_plus_finds_a_simulated_threshold(self):
        true = haptrial.psychometric_function("logistic", threshold=4.0, width=2.0, guess=0.5)
        rng = np.random.default_rng(5)
        found = []
        for run in range(20):
            track = haptrial.procedure({
                "kind": "quest_plus", "stop": {"trials": 60},
                "stimulus": {"level": {"from": 0.5, "to": 10.0, "count": 20}},
                "parameters": {"threshold": {"from": 1.0, "to": 9.0, "count": 33},
                               "width": [1.0, 2.0, 4.0]},
                "function": "logistic"})
            while not track.finished:
                track.answer(rng.random() < true(track.next()))
            found.append(next(e["value"] for e in track.estimates if "threshold" in e["name"]))
        error = np.std(found) / np.sqrt(len(found))
        self.assertLess(abs(np.mean(found) - 4.0), 4.0 * error + 0.1)

    def test_listed_levels_follow_the_seed(self):
        keys = {"kind": "constant", "levels": [1, 2, 3], "repetitions": 4}

        def order(seed):
            track = haptrial.procedure(keys, seed)
            levels = []
            while not track.finished:
                levels.append(track.next())
                track.answer(True)
            return levels

        self.assertEqual(order(1), order(1))
        self.assertNotEqual(order(1), order(2))
        self.assertEqual(sorted(order(3)), [1.0] * 4 + [2.0] * 4 + [3.0] * 4)

    def test_says_what_it_will_find(self):
        track = haptrial.procedure({**STAIRCASE, "expect": {"threshold": 4.0, "width": 3.0}})
        self.assertIn("for a participant as expected, the estimate is", track.prediction)
        self.assertIsNone(haptrial.procedure(STAIRCASE).prediction)

    def test_refuses_in_a_sentence(self):
        for wrong, sentence in (({"start": 12.0}, r"procedure.start is 12; allowed: .*10"),
                                ({"kind": "stairs"}, "procedure.kind is 'stairs'; allowed: "),
                                ({"stepps": 1}, "stepps")):
            with self.assertRaisesRegex(ValueError, sentence):
                haptrial.procedure({**STAIRCASE, **wrong})
        track = haptrial.procedure(STAIRCASE)
        with self.assertRaises(ValueError):
            track.answer(3)
        self.assertEqual(track.next(), 8.0)


if __name__ == "__main__":
    unittest.main()
