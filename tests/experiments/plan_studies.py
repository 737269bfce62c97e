"""Rehearses small studies under plans: clean ones, whose reports may name no deviation, and ones with
a planted deviation, whose reports must name it and nothing that does not follow from it.

    plan_studies.py HAPTRIAL FOLDER CLEAN PLANTED

FOLDER is new. Prints a line for each study that was judged wrongly, then counts by kind; the exit
status is 1 if there was one.
"""

import hashlib
import json
import pathlib
import random
import shutil
import subprocess
import sys

from plan_deviations import CLEAN, PLANTED

PLAIN = """[experiment]
protocol = "trials"
name = "weights"
[design]
participants = {people}
{design}
[factors]
push = [0.5, 1.5]
[fields.weight]
type = "constant"
force = [0.0, 0.0, "-$push"]
[[stages]]
name = "feel"
fields = ["weight"]
until = {{ time = 0.03 }}
[response]
name = "heavy"
question = "Is it heavy?"
choices = [{{ value = "yes" }}, {{ value = "no" }}]
correct = "$push > 1 ? 1 : 2"
[[blocks]]
name = "main"
trials = {trials}
[observer]
decides = "yes"
criterion = 0.8
force_weber = 0.3
force_floor = 0.1
reaction = 0.1
[observer.actions]
feel = {{ do = "hold" }}
{tables}
[analysis]
kind = "times"
by = ["push"]
{analysis}
[plan]
hypotheses = ["Heavy weights are answered sooner than light ones"]
exclusions = ["left early", "no consent form"]
{plan}
"""

# Groups, sessions on several days, planned tests, looks and reasons vary over the studies.
SHAPES = [
    {},
    {"analysis": 'tests = ["1.5 < 0.5"]'},
    {"design": "sessions = 2", "sessions": 2},
    {"tables": "[groups]\nfirst = {first}\nsecond = {second}", "groups": True},
    {"plan": "looks = [1]\nretain_until = \"2040-01-31\"\neffect = 0.9", "look": True},
]


class Study:
    """A definition, its plan and the folder of its sessions."""

    def __init__(self, haptrial, folder, rng):
        self.haptrial, self.folder, self.rng = haptrial, folder, rng
        folder.mkdir(parents=True)
        self.shape = rng.choice(SHAPES)
        self.people = rng.randint(3, 5)
        self.trials = 2 * rng.randint(1, 3)
        self.sessions = self.shape.get("sessions", 1)
        self.seed = rng.randint(1, 10000)
        self.out = folder / "out"
        self.write("study.toml", self.definition())

    def definition(self, **changes):
        first = self.people // 2
        words = {"people": self.people, "trials": self.trials, "design": "", "tables": "",
                 "analysis": "", "plan": ""}
        words.update({key: text for key, text in self.shape.items() if key in words})
        words["tables"] = words["tables"].format(first=first, second=self.people - first)
        words.update(changes)
        return PLAIN.format(**words)

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def run(self, *words):
        done = subprocess.run([self.haptrial, *map(str, words)], cwd=self.folder,
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"{words}: {done.stderr}")
        return done.stdout

    def plan(self, definition="study.toml", *more):
        self.run("plan", definition, *more)

    def rehearse(self, people=None, out="out", definition="study.toml", *more, seed=None):
        self.run("dry-run", definition, "--subjects", people or self.people, "--seed",
                 seed or self.seed, "--parts", out, *more)

    def analyze(self, *more):
        self.run("analyze", "out", *more)

    def deviations(self):
        self.analyze()
        return self.named()

    def named(self):
        results = json.loads((self.out / "results.json").read_text())
        found = results["own_findings"]["stated_and_done"]
        listed = found["tables"].get("deviations", [])
        report = (self.out / "report.md").read_text()
        where = report.index("## Stated and done")
        if where != report.index("## "):
            raise RuntimeError("the report does not open with what was stated and done")
        counted = found["findings"]["deviations"]["estimate"]
        if counted != len(listed):
            raise RuntimeError(f"{counted} deviations are counted, {len(listed)} are listed")
        return listed

    def file(self, number=None):
        """A session file of a participant."""
        number = number or self.rng.randint(1, self.people)
        name = f"S{number:02}" + ("-session-1" if self.sessions > 1 else "") + ".h5"
        return self.out / name

    def files_of(self, number):
        return sorted(self.out.glob(f"S{number:02}*.h5"))

    def log(self):
        return self.out / "study.plan.log"


def check_chain(study):
    """Computes the chain of a log, and the digests of its sessions, by another implementation."""
    link = hashlib.sha256((study.out / "study.plan.json").read_bytes()).hexdigest()
    for line in study.log().read_text().splitlines():
        words, own = line.rsplit("\t", 1)
        link = hashlib.sha256(f"{link}\n{words}".encode()).hexdigest()
        if link != own:
            raise RuntimeError(f"the chain breaks at {line}")
    for file in study.out.rglob("*.h5"):
        if hashlib.sha256(file.read_bytes()).hexdigest() not in study.log().read_text():
            raise RuntimeError(f"{file} is not in the log")


def judge(study, plant):
    """Empty if the report names what was planted and nothing else; else what is wrong."""
    must, may, words = (plant(study) or (set(), set(), []))
    found = study.deviations()
    if not must:
        check_chain(study)
    kinds = {each["kind"] for each in found}
    sentences = " | ".join(each["what"] for each in found if each["kind"] in must)
    if not must <= kinds:
        return f"not named: {sorted(must - kinds)}; named: {found}"
    if not kinds <= must | may:
        return f"invented: {[each for each in found if each['kind'] not in must | may]}"
    missing = [word for word in words if word not in sentences]
    return f"no sentence has {missing}: {sentences}" if missing else ""


def main():
    haptrial, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    wrong, counts = 0, {}
    for name, plants, number in (("clean", CLEAN, int(sys.argv[3])),
                                 ("planted", PLANTED, int(sys.argv[4]))):
        for i in range(number):
            plant = plants[i % len(plants)]
            study = Study(haptrial, folder / f"{name}{i:03}", random.Random(1000 * len(plants) + i))
            problem = judge(study, plant)
            key = (name, plant.__name__)
            right, all_of = counts.get(key, (0, 0))
            counts[key] = (right + (not problem), all_of + 1)
            if problem:
                wrong += 1
                print(f"{name} {i} {plant.__name__} {study.shape}: {problem}")
            shutil.rmtree(study.folder)
    for (name, plant), (right, all_of) in counts.items():
        print(f"{name}, {plant}: {right} of {all_of} right")
    print(f"{wrong} wrong")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main())
