"""Session files as frames, held against h5py, which shares no code with haptrial."""
import os
import pathlib
import shutil
import unittest

import h5py
import numpy as np
import pandas as pd

import haptrial
import support

OLD = support.SOURCE / "tests" / "core" / "record" / "data"
CODES = {"stage": ["idle", "approach", "wait", "run", "return"]}


def plain(name, column):
    """A frame's column as the file has it."""
    if isinstance(column.dtype, pd.CategoricalDtype):
        return column.cat.codes.to_numpy()
    return column.to_numpy()


class TakenBack(unittest.TestCase):
    def test_an_answer_that_was_taken_back_is_of_an_aborted_pass(self):
        path = support.FOLDER / "taken-back.h5"
        shutil.copy(support.stiffness_study() / "S01.h5", path)
        with h5py.File(path, "a") as file:
            table = file["taken_back"]
            table.resize((1,))
            row = table[:]
            row["pass"] = 3
            table[:] = row
        before = haptrial.open(support.stiffness_study() / "S01.h5").trials["status"].astype(str)
        for after in (haptrial.open(path).trials, haptrial.study(path)):
            after = after["status"].astype(str)
            self.assertEqual(before[3], "completed")
            self.assertEqual(after[3], "aborted")
            self.assertEqual((before == "aborted").sum() + 1, (after == "aborted").sum())


class EveryTable(unittest.TestCase):
    def compare(self, path):
        """Every value and unit of every table; columns that an old file lacks are left to
        NeutralValues."""
        session = haptrial.open(path)
        with h5py.File(path) as file:
            self.assertEqual(set(session.tables), set(file))
            for name, dataset in file.items():
                frame = session.table(name)
                rows = dataset[:]
                self.assertEqual(len(frame), len(rows), name)
                units = dict(zip(dataset.attrs["columns"], dataset.attrs["units"]))
                for column in rows.dtype.names:
                    found, given = plain(column, frame[column]), rows[column]
                    if given.dtype.kind == "S":
                        given = np.array([text.decode() for text in given], dtype=object)
                    np.testing.assert_array_equal(found, given, f"{path} {name} {column}")
                    self.assertEqual(frame.attrs["units"][column], units[column])
                    if found.dtype.kind not in "Ob" and column not in CODES:
                        self.assertEqual(found.dtype, given.dtype, column)

    def test_says_what_it_is(self):
        with h5py.File(support.force_study() / "S01.h5") as file:
            for name, dataset in file.items():
                attrs = haptrial.open(file.filename).table(name).attrs
                self.assertEqual(attrs["description"], dataset.attrs["description"])
                self.assertEqual(list(attrs["descriptions"].values()),
                                 list(dataset.attrs["column_descriptions"]))

    def test_of_a_force_study(self):
        self.compare(str(support.force_study() / "S01.h5"))

    def test_of_a_study_with_questions(self):
        self.compare(str(support.stiffness_study() / "S02.h5"))

    def test_of_files_of_older_versions(self):
        for file in sorted(OLD.glob("version*.hdf5")):
            with self.subTest(file.name):
                self.compare(str(file))


class NeutralValues(unittest.TestCase):
    def test_stand_for_what_an_old_file_cannot_say(self):
        trials = haptrial.open(OLD / "version1.hdf5").trials
        self.assertFalse(trials["practice"].any())
        self.assertTrue((trials["attempt"] == 1).all())
        self.assertEqual(len(haptrial.open(OLD / "version1.hdf5").responses), 0)


class SessionTest(unittest.TestCase):
    def setUp(self):
        self.session = haptrial.open(support.force_study() / "S01.h5")

    def test_info(self):
        info = self.session.info
        self.assertEqual((info.subject, info.simulated, info.clock), ("S01", True, "simulated"))
        self.assertEqual(info.rate, 1000.0)
        self.assertIn("[experiment]", info.definition)
        self.assertEqual(info.rows, len(self.session.samples))

    def test_words_and_flags(self):
        samples = self.session.samples
        self.assertEqual(list(samples["stage"].cat.categories), CODES["stage"])
        self.assertEqual(samples["saturated"].dtype, bool)
        run = samples[samples["stage"] == "run"]
        self.assertTrue((run["pass"] >= 0).all())

    def test_long_events_are_whole(self):
        events = self.session.events
        self.assertNotIn("part", events)
        with h5py.File(self.session.info.path) as file:
            texts = [text.decode() for text in file["events"]["text"]]
        self.assertEqual("".join(events["text"]), "".join(texts))

    def test_some_rows_and_columns(self):
        part = self.session.table("samples", ["time_ns", "force_y"], first=5000, count=70000)
        self.assertEqual(list(part), ["time_ns", "force_y"])
        whole = self.session.samples[["time_ns", "force_y"]].iloc[5000:75000].reset_index(drop=True)
        pd.testing.assert_frame_equal(part, whole)
        self.assertEqual(len(self.session.table("samples", first=10**9)), 0)

    def test_samples_of_a_pass(self):
        samples = self.session.samples
        for row in (0, 3):
            pd.testing.assert_frame_equal(self.session.samples_of(row),
                                          samples[samples["pass"] == row].reset_index(drop=True))
        self.assertEqual(list(self.session.samples_of(1, ["applied_force"])), ["applied_force"])

    def test_no_file_stays_open(self):
        self.session.samples
        open_files = [os.readlink(f"/proc/self/fd/{fd}") for fd in os.listdir("/proc/self/fd")
                      if os.path.exists(f"/proc/self/fd/{fd}")]
        self.assertFalse([file for file in open_files if file.endswith(".h5")])


class StudyTest(unittest.TestCase):
    def test_is_its_sessions_one_after_the_other(self):
        folder = support.force_study()
        frame = haptrial.study(folder, "samples", ["sequence", "position_x", "stage"])
        self.assertEqual(list(frame)[:2], ["participant", "session"])
        parts = [haptrial.open(folder / f"{name}.h5") for name in ("S01", "S02")]
        for part in parts:
            own = frame[frame["participant"] == part.info.subject].reset_index(drop=True)
            pd.testing.assert_frame_equal(own[["sequence", "position_x", "stage"]],
                                          part.samples[["sequence", "position_x", "stage"]])
        self.assertEqual(len(frame), sum(part.info.rows for part in parts))
        self.assertEqual(frame.attrs["units"]["position_x"], "m")

    def test_takes_files_and_events_too(self):
        file = support.force_study() / "S02.h5"
        events = haptrial.study([file], "events")
        self.assertEqual(events["text"].tolist(), haptrial.open(file).events["text"].tolist())

    def test_an_own_table_of_a_protocol(self):
        levels = haptrial.study(support.stiffness_study(), "levels")
        self.assertEqual(set(levels["participant"]), {"S01", "S02"})


class RefusedTest(unittest.TestCase):
    """The sentence of the command, as ValueError."""

    def refusal(self, call, *arguments):
        with self.assertRaises(ValueError) as caught:
            call(*arguments)
        return str(caught.exception)

    def test_the_same_sentence_as_the_command(self):
        damaged = support.FOLDER / "damaged.h5"
        damaged.write_bytes((support.force_study() / "S01.h5").read_bytes()[:100000])
        for path in ("/nowhere/P01.h5", support.SOURCE / "README.md", damaged):
            status, _, error = support.command("info", path)
            self.assertEqual(status, 2)
            self.assertIn(self.refusal(haptrial.open, path), error)

    def test_names_say_what_is_allowed(self):
        session = haptrial.open(support.force_study() / "S01.h5")
        self.assertIn("allowed: attributes,", self.refusal(session.table, "nowhere"))
        self.assertIn("allowed: sequence, time_ns", self.refusal(session.table, "samples", ["x"]))
        self.assertIn("no session file", self.refusal(haptrial.study, support.SOURCE / "docs"))
        self.assertIn("no session file", self.refusal(haptrial.study, []))


if __name__ == "__main__":
    unittest.main()
