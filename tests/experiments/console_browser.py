"""Clicks through a session at the experimenter's console in headless Chromium.

    console_browser.py URL FOLDER

Speaks the WebDriver protocol to chromedriver with the standard library alone. Leaves pictures in
FOLDER. Prints CLOSE when the console is to go away. Exit status 0: all was as it should be.
"""

import base64
import http.server
import json
import os
import pathlib
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request

FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-dev-shm-usage", "--hide-scrollbars", "--window-size=1280,900",
]
ESCAPE = "\ue00c"


class Driver:
    """One chromedriver on a port of its own choice, with one window."""

    def __init__(self, folder):
        profile = folder / "profile"
        self.process = subprocess.Popen(
            ["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True,
            env={**os.environ, "HOME": str(folder)})
        self.base = ""
        for line in self.process.stdout:
            if "started successfully on port" in line:
                port = line.strip().rstrip(".").rsplit(" ", 1)[1]
                self.base = f"http://127.0.0.1:{port}"
                break
        options = {"args": FLAGS + [f"--user-data-dir={profile}"]}
        logging = {"goog:loggingPrefs": {"browser": "ALL"}}
        try:
            answer = self.call("POST", "/session", {"capabilities": {"alwaysMatch": {
                "browserName": "chrome", "goog:chromeOptions": options, **logging}}})
        except OSError as error:  # no shared memory, say: nothing that the page could help
            self.process.kill()
            print(f"Chromium does not start here: {error}")
            sys.exit(77)
        self.base += "/session/" + answer["sessionId"]

    def call(self, method, path, body=None):
        data = None if method != "POST" else json.dumps(body or {}).encode()
        request = urllib.request.Request(self.base + path, data, method=method,
                                         headers={"Content-Type": "application/json"})
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        with opener.open(request, timeout=60) as answer:
            return json.load(answer)["value"]

    def run(self, script):
        return self.call("POST", "/execute/sync", {"script": script, "args": []})

    def text(self, name):
        return self.run(f"return document.getElementById('{name}').innerText")

    def hidden(self, name):
        return self.run(f"return !document.getElementById('{name}').checkVisibility()")

    def element(self, name):
        found = self.call("POST", "/element", {"using": "css selector", "value": "#" + name})
        return next(iter(found.values()))

    def click(self, name):
        """As a person does: at the place on the screen, which nothing may cover."""
        self.call("POST", f"/element/{self.element(name)}/click")

    def type(self, name, text):
        self.call("POST", f"/element/{self.element(name)}/value", {"text": text})

    def key(self, key):
        self.call("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": [
            {"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]}]})

    def picture(self, file, width=1280, height=900):
        self.call("POST", "/window/rect", {"width": width, "height": height})
        time.sleep(0.3)
        file.write_bytes(base64.b64decode(self.call("GET", "/screenshot")))

    def complaints(self):
        """Errors in the browser's console: scripts that fail, things that the policy blocks."""
        log = self.call("POST", "/se/log", {"type": "browser"})
        return [entry["message"] for entry in log if entry["level"] in ("SEVERE", "WARNING")]

    def close(self):
        try:
            self.call("DELETE", "")
        except (urllib.error.URLError, OSError):
            pass
        self.process.terminate()
        self.process.wait(20)


def wait(what, condition, seconds=10):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.03)
    raise AssertionError("never came: " + what)


def state(page, wanted):
    wait(f"state {wanted}", lambda: page.text("state") == wanted)


def elsewhere():
    """The address of a page of another origin."""
    class Page(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(200)
            self.end_headers()

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Page)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{server.server_port}/"


def click_through(page, url, folder):
    page.call("POST", "/url", {"url": url})
    state(page, "Instructions")
    assert page.text("subject") == "S01", page.text("subject")
    assert not page.hidden("simulated") and page.text("simulated") == "SIMULATED"
    assert "Hold the handle" in page.text("screen")
    assert page.text("trial") == "1 of 72", page.text("trial")
    assert page.text("link") == "connected"

    page.click("start")
    state(page, "Running")
    assert page.text("what") == "visuohaptic \u00b7 training \u00b7 run", page.text("what")
    forces = set()
    wait("a force that moves", lambda: forces.add(page.text("applied")) or len(forces) > 5)
    drawn = "const c = document.getElementById('canvas'); const d = c.getContext('2d')" \
            ".getImageData(0, 0, c.width, c.height).data; let n = 0; " \
            "for (let i = 3; i < d.length; i += 4) n += d[i] > 128; return n"
    wait("a plot", lambda: page.run(drawn) > 2000)
    for name in ("start", "clear"):
        assert page.run(f"return document.getElementById('{name}').disabled"), name

    page.click("pause")
    state(page, "Paused")
    page.type("note", "hand slips <b>&amp; \u00e9 r s a c p")  # letters that are keys elsewhere
    page.click("keep")
    wait("the note's receipt", lambda: "note: hand slips <b>" in page.text("said"))
    page.key(" ")
    state(page, "Running")
    page.key("r")
    wait("repeat", lambda: "repeat this trial" in page.text("said"))
    page.click("skip")
    wait("skip", lambda: "skip this trial" in page.text("said"))
    time.sleep(float(os.environ.get("CONSOLE_PLOT_SECONDS", "1")))  # for a fuller plot
    page.picture(folder / "console-running.png")

    page.click("emergency_stop")
    state(page, "STOPPED")
    assert "The force is zero" in page.text("fault"), page.text("fault")
    page.key(" ")  # starts nothing
    page.picture(folder / "console-stopped.png")
    page.picture(folder / "console-narrow.png", 480, 900)
    top, bottom, height = page.run(
        "const r = document.getElementById('emergency_stop').getBoundingClientRect();"
        "return [r.top, r.bottom, window.innerHeight]")
    assert 0 <= top and bottom <= height, "the emergency stop is always in sight"
    page.call("POST", "/window/rect", {"width": 1280, "height": 900})
    page.click("clear")
    state(page, "Paused")

    page.click("note")
    page.key(ESCAPE)  # also from within a note
    state(page, "STOPPED")
    page.key("c")
    state(page, "Paused")

    page.click("abort")
    wait("the question", lambda: not page.hidden("confirm"))
    page.click("go_on")
    wait("no question", lambda: page.hidden("confirm"))
    assert page.text("state") == "Paused"

    bad = page.complaints()
    assert not bad, bad

    # A page from elsewhere gets nothing through, in the same browser and even if it knew the token.
    page.call("POST", "/window/new", {"type": "tab"})
    other = [h for h in page.call("GET", "/window/handles")
             if h != page.call("GET", "/window")][-1]
    first = page.call("GET", "/window")
    page.call("POST", "/window", {"handle": other})
    page.call("POST", "/url", {"url": elsewhere()})
    root, token = url.split("?token=")
    result = page.call("POST", "/execute/async", {"args": [root + "ask", token], "script": """
        const [ask, token, done] = arguments;
        const body = '{"request":"skip"}';
        const all = [fetch(ask, {method: "POST", mode: "no-cors", body}),
          fetch(ask + "?token=" + token, {method: "POST", mode: "no-cors", body}),
          fetch(ask, {method: "POST", body, headers: {"X-Haptrial-Token": token}})];
        Promise.allSettled(all).then((r) => done(r.map((x) =>
          x.status === "fulfilled" && x.value.ok ? "let in" : "refused")));"""})
    assert result == ["refused"] * 3, result
    page.call("POST", "/window", {"handle": first})
    wait("refusals on the page", lambda: int(page.text("refused").split()[-1]) >= 3)

    print("CLOSE", flush=True)
    wait("the loss", lambda: page.text("lost").startswith("CONNECTION LOST"))
    assert page.text("link") == "not connected"
    page.picture(folder / "console-lost.png")
    page.click("emergency_stop")
    wait("the warning", lambda: "NOT DELIVERED" in page.text("undelivered"))


def main():
    url, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    page = Driver(folder)
    try:
        click_through(page, url, folder)
    finally:
        page.close()


main()
