"""Drives headless Chromium for the tests of pages.

Speaks the WebDriver protocol to chromedriver with the standard library alone.
"""

import base64
import json
import os
import subprocess
import sys
import time
import urllib.error
import urllib.request

FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--disable-dev-shm-usage", "--hide-scrollbars", "--window-size=1280,900",
]
ESCAPE = "\ue00c"


class Refused(Exception):
    """What chromedriver answers to a command that it does not carry out."""

    def __init__(self, answer):
        super().__init__(f"{answer['error']}: {answer['message']}")
        self.error = answer["error"]


class Driver:
    """One chromedriver on a port of its own choice, with one window."""

    def __init__(self, folder, flags=()):
        profile = folder / "profile"
        self.base = self.started(folder)
        options = {"args": FLAGS + [f"--user-data-dir={profile}", *flags]}
        logging = {"goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}
        try:
            answer = self.call("POST", "/session", {"capabilities": {"alwaysMatch": {
                "browserName": "chrome", "goog:chromeOptions": options, **logging}}})
        except (OSError, Refused):
            self.process.kill()
            raise
        self.base += "/session/" + answer["sessionId"]

    def started(self, folder):
        # The driver takes a port that is free for one version of the protocol; where it is not free
        # for the other it ends at once.
        for _ in range(10):
            self.process = subprocess.Popen(
                ["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True,
                env={**os.environ, "HOME": str(folder)})
            for line in self.process.stdout:
                if "started successfully on port" in line:
                    return "http://127.0.0.1:" + line.strip().rstrip(".").rsplit(" ", 1)[1]
            self.process.wait()
        raise RuntimeError("chromedriver does not start")

    def open(self, url):
        self.call("POST", "/url", {"url": url})

    def call(self, method, path, body=None):
        data = None if method != "POST" else json.dumps(body or {}).encode()
        request = urllib.request.Request(self.base + path, data, method=method,
                                         headers={"Content-Type": "application/json"})
        opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
        try:
            with opener.open(request) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as refused:
            raise Refused(json.load(refused)["value"]) from None

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
        """As a person does: at the place on the screen, once nothing covers it any more."""
        def possible():
            try:
                self.call("POST", f"/element/{self.element(name)}/click")
            except Refused as refused:
                if refused.error not in ("element click intercepted", "element not interactable"):
                    raise
                return False
            return True
        wait(f"a place to click on '{name}'", possible)

    def type(self, name, text):
        self.call("POST", f"/element/{self.element(name)}/value", {"text": text})

    def key(self, key):
        self.call("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": [
            {"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]}]})

    def resize(self, width=1280, height=900):
        """Until it is so: a click would fall beside what moves meanwhile."""
        self.call("POST", "/window/rect", {"width": width, "height": height})
        wait(f"a window of {width} x {height}",
             lambda: self.run("return [innerWidth, outerHeight]") == [width, height])

    def picture(self, file, width=1280, height=900):
        self.resize(width, height)
        time.sleep(0.3)
        file.write_bytes(base64.b64decode(self.call("GET", "/screenshot")))

    def drawn(self, canvas, opacity=0):
        """Pixels of a canvas above this opacity, of 255; read from a copy, since Chromium complains
        of a canvas that is read again and again."""
        return self.run(
            f"const c = document.getElementById('{canvas}'), d = document.createElement('canvas');"
            "d.width = c.width; d.height = c.height; const g = d.getContext('2d');"
            "g.drawImage(c, 0, 0); const p = g.getImageData(0, 0, d.width, d.height).data;"
            f"let n = 0; for (let i = 3; i < p.length; i += 4) n += p[i] > {opacity}; return n")

    def complaints(self):
        """Errors in the browser's console: scripts that fail, things that the policy blocks."""
        log = self.call("POST", "/se/log", {"type": "browser"})
        return [entry["message"] for entry in log if entry["level"] in ("SEVERE", "WARNING")]

    def requested(self):
        """Addresses that pages asked for since the last call."""
        log = self.call("POST", "/se/log", {"type": "performance"})
        messages = [json.loads(entry["message"])["message"] for entry in log]
        return [message["params"]["request"]["url"] for message in messages
                if message["method"] == "Network.requestWillBeSent"]

    def close(self):
        try:
            self.call("DELETE", "")
        except (OSError, Refused):
            pass
        self.process.terminate()
        self.process.wait()


def wait(what, condition):
    """For as long as it takes; the test runner ends a hang."""
    told = time.monotonic()
    while not condition():
        time.sleep(0.03)
        if time.monotonic() - told > 60:
            told = time.monotonic()
            print("still waiting for " + what, file=sys.stderr, flush=True)


def look_at(url, folder, look, flags=()):
    """Calls look(page) with a page that shows the address; no page complains of anything and none
    scrolls sideways."""
    page = Driver(folder, flags)
    try:
        page.open(url)
        look(page)
        wide = page.run("return document.documentElement.scrollWidth > window.innerWidth")
        assert not wide, "the page scrolls sideways"
        complaints = page.complaints()
        assert not complaints, complaints
    finally:
        page.close()


def ask(page, *buttons):
    """As an experimenter does at the console: again, where the page says that a request was not
    delivered."""
    delivered = False
    while not delivered:
        page.run("document.getElementById('said').replaceChildren()")
        for button in buttons:
            page.click(button)
        wait(f"a receipt of '{buttons[-1]}'", lambda: page.text("said") != "")
        delivered = "NOT DELIVERED" not in page.text("said")


def state(page, wanted):
    wait(f"state {wanted}", lambda: page.text("state") == wanted)
