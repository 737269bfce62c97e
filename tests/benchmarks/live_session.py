"""A long live session with everything on, beside a servo loop that does nothing.

    live_session.py BUILD [SECONDS [RATE]]

The shipped study on the real clock with the virtual device, the participant's window (under Xvfb),
the console with a page that follows it, and the recorder; then what `haptrial info` says of its
file, and what the idle loop saw in the same minutes. 600 s at 1000 Hz by default.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]


def definition(folder, rate):
    text = (ROOT / "experiments/force_training.toml").read_text()
    file = folder / "long.toml"
    file.write_text(re.sub(r"(?m)^rate = \S+", f"rate = {rate:.1f}", text))
    return file


class Page:
    """What a browser does: follows the events, asks for things."""

    def __init__(self, url):
        parts = urllib.parse.urlsplit(url)
        self.base = f"http://{parts.netloc}"
        self.token = urllib.parse.parse_qs(parts.query)["token"][0]
        self.status = {}
        threading.Thread(target=self.follow, args=(url,), daemon=True).start()

    def follow(self, url):
        with urllib.request.urlopen(url.replace("/?", "/events?")) as events:
            for line in events:
                if line.startswith(b"data:"):
                    self.status = json.loads(line[5:])

    def ask(self, what):
        urllib.request.urlopen(urllib.request.Request(
            self.base + "/ask", json.dumps({"request": what}).encode(),
            {"Content-Type": "application/json", "X-Haptrial-Token": self.token}))


def display():
    server = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", "1280x720x24"],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return server, ":" + server.stdout.readline().strip()


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 600.0
    rate = float(sys.argv[3]) if len(sys.argv) > 3 else 1000.0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        server, screen = display()
        session = subprocess.Popen(
            [build / "haptrial", "run", definition(folder, rate), "--subject", "S01", "--out",
             folder, "--window", "--console"],
            stdout=subprocess.PIPE, text=True, env={"DISPLAY": screen, "HOME": name})
        page = Page(re.search(r"http://\S+", session.stdout.readline()).group())
        while not page.status:
            time.sleep(0.05)
        idle = subprocess.Popen([build / "bench_idle_loop", str(rate), str(seconds)],
                                stdout=subprocess.PIPE, text=True)
        page.ask("start")
        while page.status["ticks"] < rate * seconds:
            time.sleep(0.5)
        page.ask("abort")
        print(session.communicate()[0])
        server.terminate()
        print(subprocess.run([build / "haptrial", "info", folder / "S01.h5"],
                             stdout=subprocess.PIPE, text=True).stdout)
        print("idle loop beside it")
        print(idle.communicate()[0])


main()
