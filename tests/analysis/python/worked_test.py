"""The worked example, the blocks of the guide, dry runs, and help() as it reads."""
import contextlib
import inspect
import io
import linecache
import os
import re
import runpy
import unittest

import haptrial
import support


class WorkedTest(unittest.TestCase):
    def setUp(self):
        os.environ["HAPTRIAL_COMMAND"] = support.COMMAND
        self.before = os.getcwd()
        os.chdir(support.FOLDER)

    def tearDown(self):
        os.chdir(self.before)

    def test_the_example_finds_what_the_command_does(self):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            names = runpy.run_path(str(support.SOURCE / "docs/worked/python/force_study.py"))
        self.assertIn("simulated", out.getvalue())
        again = haptrial.force_scores(names["sessions"])
        self.assertEqual(names["scores"]["score"].tolist(), again["score"].tolist())

    def test_the_guide_runs_as_it_stands(self):
        text = (support.SOURCE / "docs/guide-python.md").read_text()
        blocks = re.findall(r"```python\n(.*?)```", text, re.S)
        self.assertGreater(len(blocks), 4)
        names = {"SOURCE": support.SOURCE}
        with contextlib.redirect_stdout(io.StringIO()):
            for number, block in enumerate(blocks):
                file = f"guide-python.md, block {number}"
                linecache.cache[file] = (len(block), None, block.splitlines(True), file)
                exec(compile(block, file, "exec"), names)


class DryRunTest(unittest.TestCase):
    def setUp(self):
        os.environ["HAPTRIAL_COMMAND"] = support.COMMAND

    def test_is_a_function_of_its_seed(self):
        file = support.SOURCE / "experiments" / "stiffness_discrimination.toml"
        first, second = (haptrial.dry_run(file, subjects=1, trials=3, seed=7) for _ in range(2))
        self.assertEqual([s.info.subject for s in first], ["S01"])
        self.assertTrue(first[0].samples.equals(second[0].samples))
        self.assertTrue(haptrial.study(first, "responses")["participant"].eq("S01").all())

    def test_a_function_answers_and_another_chooses_levels(self):
        def second(trial):
            assert trial["question"] == "stiffer"
            return {"answer": trial["choices"][1], "reaction_time": 0.25}

        def ladder(trial):
            return trial["low"] + 10.0 * (1 + len(trial["history"]))

        file = support.SOURCE / "experiments" / "stiffness_discrimination.toml"
        session, = haptrial.dry_run(file, subjects=1, trials=6, decision=second, levels=ladder)
        responses = session.responses
        self.assertEqual(set(responses["text"]), {"second"})
        self.assertTrue((abs(responses["reaction_time"] - 0.25) < 0.0021).all())
        for _, track in session.table("levels").groupby("track"):
            self.assertEqual(track["asked"].tolist(),
                             [305.0 + 10.0 * (1 + i) for i in range(len(track))])
        kept = session.events.set_index("kind")["text"]
        self.assertIn("def second(trial):", kept["decision_script"])
        self.assertIn("def ladder(trial):", kept["level_script"])

    def test_a_function_that_fails_is_told(self):
        def wrong(trial):
            raise KeyError("nothing")

        file = support.SOURCE / "experiments" / "stiffness_discrimination.toml"
        with self.assertRaisesRegex(ValueError, "ended with no answer: KeyError: 'nothing'"):
            haptrial.dry_run(file, subjects=1, trials=1, decision=wrong)
        for none in (lambda trial: None, file.exists, lambda_around(file)):
            with self.assertRaisesRegex(ValueError, "no function that stands alone"):
                haptrial.dry_run(file, subjects=1, trials=1, decision=none)

    def test_the_worked_script_is_drawn_to_what_is_usual(self):
        file = support.SOURCE / "experiments" / "stiffness_discrimination.toml"
        script = support.SOURCE / "docs" / "worked" / "python" / "decide.py"
        sessions = haptrial.dry_run(file, subjects=12, decision=script)
        answers = haptrial.study(sessions, "responses")
        right = answers["correct"].astype(bool)
        # Right with "second": the comparison came second.
        came_second = (answers["text"] == "second") == right
        share = right.groupby(came_second).mean()
        counts = right.groupby(came_second).size()
        spread = (sum(p * (1 - p) / n for p, n in zip(share, counts))) ** 0.5
        self.assertGreater(share[True] - share[False], 3 * spread)

    def test_a_definition_as_text_and_its_mistakes(self):
        text = (support.SOURCE / "experiments" / "stiffness_discrimination.toml").read_text()
        self.assertEqual(len(haptrial.dry_run(text, subjects=1, trials=1)), 1)
        with self.assertRaisesRegex(ValueError, "procedure.down is 0; allowed: "):
            haptrial.dry_run(text.replace("down = 2 ", "down = 0 "), subjects=1)


def lambda_around(file):
    def around(trial):
        return str(file)
    return around


class HelpTest(unittest.TestCase):
    def test_everything_has_a_text(self):
        for name in haptrial.__all__:
            each = getattr(haptrial, name)
            self.assertTrue(inspect.getdoc(each), name)
            members = vars(each) if inspect.isclass(each) else {}
            for member, value in members.items():
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    self.assertTrue(inspect.getdoc(value), f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
