"""Takes the pictures of the experimenter's console: make.sh calls it.

    console.py HAPTRIAL WORK IMAGES

Runs two shipped definitions on the virtual device and clicks through their sessions in Chromium.
"""

import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/experiments"))
from browser import Driver, state, wait  # noqa: E402

PLOT = 9  # of a run, before its picture is taken [s]


class Session:
    def __init__(self, haptrial, name, work):
        definition = work / name
        text = (ROOT / "experiments" / name).read_text()
        definition.write_text(text.replace("card = true", "card = false"))  # no notice about it
        self.process = subprocess.Popen(
            [haptrial, "run", str(definition), "--subject", "P01",
             "--console", "--out", str(work / "sessions" / definition.stem)],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        for line in self.process.stdout:
            if line.startswith("console: "):
                self.url = line.split(" ", 1)[1].strip()
                return
        raise RuntimeError("no console for " + name)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.communicate()


def running(page, stage):
    wait(stage, lambda: page.text("what").endswith(stage))
    time.sleep(PLOT)


def trial(page, url, images):
    """The test pass of the first trial with a note, and an emergency stop in the next trial."""
    page.call("POST", "/url", {"url": url})
    state(page, "Instructions")
    page.click("start")
    running(page, "test \u00b7 trial runs")
    page.type("note", "asked which hand to use: the right one")
    page.click("keep")
    page.picture(images / "console-running.png", height=980)
    wait("the second trial", lambda: page.text("trial").startswith("2 of"))
    running(page, "training \u00b7 trial runs")
    page.click("emergency_stop")
    state(page, "STOPPED")
    time.sleep(1)
    page.picture(images / "console-stopped.png", height=1080)


def drilling(page, url, images):
    page.call("POST", "/url", {"url": url})
    state(page, "Instructions")
    page.click("start")
    state(page, "Running")
    time.sleep(20)
    page.picture(images / "console-drilling.png", height=1120)


def main():
    haptrial, work, images = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    for name, take in (("force_training.toml", trial), ("bone_drilling.toml", drilling)):
        with Session(haptrial, name, work) as session:
            page = Driver(work)
            try:
                take(page, session.url, images)
            finally:
                page.close()


main()
