"""Clicks through a scripted session at the experimenter's console in headless Chromium.

    console_browser.py URL FOLDER

Leaves pictures in FOLDER. Prints CLOSE when the console is to go away. Exit status 0: all was as it
should be.
"""

import http.server
import pathlib
import sys
import threading

from browser import ESCAPE, Driver, state, wait


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
    assert page.text("what") == "visuohaptic \u00b7 training \u00b7 trial runs", page.text("what")
    forces = set()
    wait("a force that moves", lambda: forces.add(page.text("applied")) or len(forces) > 5)
    wait("a plot", lambda: page.drawn("canvas", 128) > 2000)
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

    page.click("emergency_stop")
    state(page, "STOPPED")
    assert "The force is zero" in page.text("fault"), page.text("fault")
    page.key(" ")  # starts nothing
    for width in (480, 800, 1024, 1280):
        page.picture(folder / "console-narrow.png", width, 900)
        inside = page.run(
            "return [...document.querySelectorAll('footer button')].every((each) => {"
            "  const r = each.getBoundingClientRect();"
            "  return r.left >= 0 && r.right <= innerWidth && r.top >= 0 && r.bottom <= innerHeight; })")
        assert inside, f"all buttons are in sight, {width} wide"
    page.resize()
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
    page.run("document.getElementById('loop').open = true")
    wait("refusals on the page", lambda: int(page.text("refused").split()[-1]) >= 3)

    print("CLOSE", flush=True)
    wait("the loss", lambda: page.text("lost").startswith("CONNECTION LOST"))
    assert page.text("link") == "not connected"
    assert page.text("lost").endswith("or Ctrl-C in the terminal in which haptrial runs."), page.text("lost")
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
