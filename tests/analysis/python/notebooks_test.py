"""The worked notebooks: each is kept without outputs and runs; by Jupyter too where it is installed."""
import contextlib
import io
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import support

NOTEBOOKS = support.SOURCE / "docs/worked/notebooks"


def cells(name):
    notebook = json.loads((NOTEBOOKS / f"{name}.ipynb").read_text())
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


def run(name):
    """Runs a notebook cell by cell, in its own folder as Jupyter does; its names."""
    names = {"__name__": "__main__"}
    before = os.getcwd()
    os.chdir(NOTEBOOKS)
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            for number, cell in enumerate(cells(name), 1):
                exec(compile("".join(cell["source"]), f"{name}.ipynb, code cell {number}", "exec"), names)
    finally:
        os.chdir(before)
    return names


class NotebooksTest(unittest.TestCase):
    def setUp(self):
        os.environ["HAPTRIAL_COMMAND"] = str(pathlib.Path(support.COMMAND).resolve())

    def test_are_kept_without_outputs(self):
        files = sorted(NOTEBOOKS.glob("*.ipynb"))
        self.assertEqual([file.stem for file in files], ["force_study", "own_method", "stiffness_power"])
        for file in files:
            for cell in cells(file.stem):
                self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None), file.name)

    def test_force_study_has_the_scores_of_the_command(self):
        names = run("force_study")
        folder = pathlib.Path(names["sessions"][0].info.path).parent
        self.assertEqual(support.command("analyze", folder)[0], 0)
        import pandas
        kept = pandas.read_csv(folder / "scores.csv", float_precision="round_trip")
        self.assertEqual(names["scores"]["score"].tolist(), kept["score"].tolist())
        self.assertEqual(names["path"][0].tolist(), [0, 0])

    def test_stiffness_power_agrees_with_itself(self):
        names = run("stiffness_power")
        self.assertGreater(names["participants"], 2)
        self.assertAlmostEqual(names["simulated_power"], 0.8, delta=0.1)  # the next whole number
        self.assertGreaterEqual(names["simulated_power"], 0.78)
        self.assertEqual(names["power"]["design.participants"].tolist(), [12, 24, 12, 24])

    def test_own_method_finds_the_level(self):
        names = run("own_method")
        self.assertEqual(names["staircase_target"], 0.75)
        errors = names["comparison"].loc["mean error"]
        spreads = names["comparison"].loc["standard deviation"]
        self.assertLess(abs(errors["accelerated"]), 0.2)
        self.assertLess(abs(errors["staircase"]), 0.5)
        self.assertLess(spreads.max(), 1.0)
        low, high = names["fit"].threshold_interval
        self.assertLess(low, 3.0)
        self.assertGreater(high, 3.0)

    def test_run_in_jupyter(self):
        with tempfile.TemporaryDirectory() as folder:
            for notebook in sorted(NOTEBOOKS.glob("*.ipynb")):
                done = subprocess.run(
                    ["/usr/bin/jupyter-nbconvert", "--to", "notebook", "--execute",
                     "--output-dir", folder, notebook],
                    capture_output=True, text=True, env={**os.environ, "HOME": folder})
                self.assertEqual(done.returncode, 0, done.stderr[-3000:])
                made = json.loads((pathlib.Path(folder) / notebook.name).read_text())
                self.assertTrue(any(cell.get("outputs") for cell in made["cells"]), notebook.name)


if __name__ == "__main__":
    unittest.main()
