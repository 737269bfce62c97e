"""What studies under a plan (plan_studies.py) do: deviations, and what a plan allows."""

import json
import shutil
import subprocess
import time


def edit(file, code):
    """Another program's change of a session file."""
    subprocess.run(["/usr/bin/python3", "-c", f"import h5py, sys\nf = h5py.File(sys.argv[1], 'r+')\n"
                    f"{code}\nf.close()", str(file)], check=True)


# Planted deviations: each does a study and returns the kinds that must be named, those that may be
# named beside them because they follow, and words that a sentence of a first kind has.

def fewer_people(s):
    s.plan()
    s.rehearse(s.people - 1)
    return {"people_missing"}, {"looked_at_data"}, [str(s.people - 1 if "groups" not in s.shape else "took part")]


def more_people(s):
    if "groups" in s.shape:  # nobody can be rehearsed beyond the last group
        return fewer_people(s)
    s.plan()
    s.rehearse(s.people + s.rng.randint(1, 2))
    return {"people_extra"}, set(), [f"{s.people} were stated"]


def fewer_sessions(s):
    s.plan()
    s.rehearse()
    file = s.rng.choice(s.files_of(s.rng.randint(1, s.people)))
    file.unlink()
    kind = "sessions_missing" if s.sessions > 1 else "people_missing"
    return {"file_missing", kind}, {"looked_at_data"}, ["not there"]


def fewer_trials(s):
    s.plan()
    s.rehearse(s.people, "out", "study.toml", "--trials", s.rng.randint(1, s.trials - 1))
    return {"trials_dropped"}, set(), ["S01"]


def dropped_trial(s):
    s.plan()
    s.rehearse()
    file = s.file()
    edit(file, "r = f['responses']; r.resize(len(r) - 1, axis=0)")
    return {"file_changed"}, {"trials_dropped"}, [file.name]


def edited_file(s):
    s.plan()
    s.rehearse()
    file = s.file()
    edit(file, "r = f['responses']; row = r[-1].copy(); row['value'] = 3 - row['value']; r[-1] = row")
    return {"file_changed"}, set(), [file.name]


def appended_file(s):
    s.plan()
    s.rehearse()
    file = s.file()
    with file.open("ab") as stream:
        stream.write(b"x")
    return {"file_changed"}, set(), [file.name]


def replaced_file(s):
    s.plan()
    s.rehearse()
    time.sleep(1.1)  # its session begins at another second
    s.rehearse(s.people, "other", seed=s.seed + 1)
    file = s.file()
    shutil.copy(s.folder / "other" / file.name, file)
    return {"file_unknown", "file_missing"}, {"log_cut"}, [file.name]


def copied_file(s):
    s.plan()
    s.rehearse()
    shutil.copy(s.file(1), s.out / "S99.h5")
    return {"file_unknown"}, set(), ["S99.h5"]


def missing_person(s):
    s.plan()
    s.rehearse()
    for file in s.files_of(s.rng.randint(1, s.people)):
        file.unlink()
    return {"file_missing", "people_missing"}, {"looked_at_data"}, ["not there"]


def changed_level(s):
    s.plan()
    s.write("study.toml", s.definition().replace("1.5]", "1.4]").replace('"1.5 <', '"1.4 <'))
    s.rehearse()
    return {"definition_changed"}, set(), ["factors.push"]


def changed_criterion(s):
    s.plan()
    s.write("study.toml", s.definition().replace("time = 0.03", "time = 0.04"))
    s.rehearse()
    return {"definition_changed"}, set(), ["0.04"]


def changed_analysis(s):
    s.plan()
    s.write("study.toml", s.definition(analysis='tests = ["0.5 < 1.5"]'))
    s.rehearse()
    return {"definition_changed"}, set(), ["analysis.tests"]


def changed_hypothesis(s):
    s.plan()
    s.write("study.toml", s.definition().replace("sooner", "later"))
    s.rehearse()
    return {"definition_changed"}, set(), ["plan.hypotheses"]


def given_test(s):
    s.plan()
    s.rehearse()
    s.analyze("--planned", "1.5 > 0.5")
    return {"tests_changed"}, set(), ["1.5 > 0.5"]


def peeked(s):
    s.plan()
    early = s.people - 1
    s.rehearse(early)
    s.analyze()
    s.rehearse()
    return {"looked_at_data"}, set(), [f"of {early} of {s.people} "]


def before_plan(s):
    s.rehearse()
    time.sleep(1.1)
    s.plan("study.toml", "--out", "out")
    return {"before_plan"}, set(), ["S01"]


def partly_before_plan(s):
    s.rehearse(1)
    time.sleep(1.1)
    s.plan()
    s.rehearse()
    return {"before_plan"}, set(), ["S01"]


def without_plan(s):
    s.write("other.toml", s.definition())
    s.plan()
    s.rehearse(s.people - 1)
    s.rehearse(s.people, "other", "other.toml")
    for file in (s.folder / "other").glob(f"S{s.people:02}*.h5"):
        shutil.copy(file, s.out)
    return {"without_plan", "file_unknown"}, set(), [f"S{s.people:02}"]


def another_plan(s):
    (s.folder / "b").mkdir()
    s.write("b/study.toml", s.definition())
    s.plan()
    time.sleep(1.1)
    s.plan("b/study.toml")
    s.rehearse(s.people - 1)
    s.rehearse(s.people, "other", "b/study.toml")
    for file in (s.folder / "other").glob(f"S{s.people:02}*.h5"):
        shutil.copy(file, s.out)
    return {"another_plan", "file_unknown"}, set(), [f"S{s.people:02}"]


def excluded(s, because):
    s.plan()
    s.rehearse()
    who = f"S{s.rng.randint(1, s.people):02}"
    s.run("roster", "study.toml", "out", "--seed", s.seed, "--exclude", who, "--because", because)
    return who


def unstated_exclusion(s):
    who = excluded(s, "was slow")
    return {"exclusion_not_stated", "people_missing"}, {"looked_at_data"}, [who]


def silent_exclusion(s):
    s.plan()
    s.rehearse()
    (s.out / "excluded").mkdir()
    who = s.rng.randint(1, s.people)
    for file in s.files_of(who):
        file.rename(s.out / "excluded" / file.name)
    return {"exclusion_not_stated", "people_missing"}, {"looked_at_data"}, [f"S{who:02} was excluded without"]


def stated_exclusion_without_replacement(s):
    excluded(s, "left early, ill")
    return {"people_missing"}, {"looked_at_data"}, ["stated"]


def withdrawn(s):
    s.plan()
    s.rehearse()
    s.run("withdraw", "out", f"S{s.rng.randint(1, s.people):02}", "--yes")
    return {"people_missing"}, {"looked_at_data"}, ["stated"]


def changed_log(s):
    s.plan()
    s.rehearse()
    s.analyze()
    lines = s.log().read_text().splitlines(keepends=True)
    at = s.rng.randrange(len(lines))
    lines[at] = lines[at].replace("\t", "\tx", 1)
    s.log().write_text("".join(lines))
    return {"log_changed"}, set(), ["changed"]


def line_taken_out(s):
    s.plan()
    s.rehearse(s.people - 1)
    s.analyze()
    s.rehearse()
    lines = s.log().read_text().splitlines(keepends=True)
    s.log().write_text("".join(line for line in lines if "\tanalysis\t" not in line))
    return {"log_changed"}, {"log_cut"}, ["taken"]


def changed_plan(s):
    s.plan()
    s.rehearse()
    plan = s.out / "study.plan.json"
    plan.write_text(plan.read_text().replace("sooner", "later"))
    return {"log_changed", "another_plan"}, {"definition_changed", "log_cut"}, ["plan"]


def other_program(s):
    s.plan()
    plan = s.folder / "study.plan.json"
    text = json.loads(plan.read_text())
    text["program"] = "haptrial 0.1.9 (0123456789ab)"
    plan.write_text(json.dumps(text, indent=1, ensure_ascii=False) + "\n")
    s.rehearse()
    return {"program_changed"}, set(), ["0.1.9"]


PLANTED = [fewer_people, more_people, fewer_sessions, fewer_trials, dropped_trial, edited_file,
           appended_file, replaced_file, copied_file, missing_person, changed_level,
           changed_criterion, changed_analysis, changed_hypothesis, given_test, peeked, before_plan,
           partly_before_plan, without_plan, another_plan, unstated_exclusion, silent_exclusion,
           stated_exclusion_without_replacement, withdrawn, changed_log, line_taken_out,
           changed_plan, other_program]


# Clean studies: what a plan allows.

def as_planned(s):
    s.plan()
    s.rehearse()


def in_parts(s):
    s.plan()
    s.rehearse(1)
    s.rehearse()


def analysed_again(s):
    as_planned(s)
    s.analyze()
    s.analyze()


def stated_look(s):
    s.plan()
    s.rehearse(1)
    if "look" in s.shape:
        s.analyze()
    s.rehearse()


def stated_exclusion(s):
    """Somebody more came, in place of the one who is excluded for a stated reason."""
    if "groups" in s.shape:
        return as_planned(s)
    s.plan()
    s.rehearse(s.people + 1)
    who = f"S{s.people + 1:02}"
    s.run("roster", "study.toml", "out", "--seed", s.seed, "--exclude", who, "--because",
          s.rng.choice(["Left early", "no consent form was signed"]))
    return None


def other_layout(s):
    s.plan()
    s.write("study.toml", "# A comment.\n" + s.definition().replace(" = ", "  =  "))
    s.rehearse()


def planned_in_its_folder(s):
    """The plan stands among the sessions alone."""
    s.plan("study.toml", "--out", "out")
    for number in range(1, s.people + 1):
        for session in range(1, s.sessions + 1):
            s.run("run", "study.toml", "--subject", f"P{number:02}", "--session", session, "--out",
                  "out")


CLEAN = [as_planned, in_parts, analysed_again, stated_look, stated_exclusion, other_layout,
         planned_in_its_folder]
