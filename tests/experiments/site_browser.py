"""The made site in headless Chromium, from a server of this machine.

    site_browser.py SITE WORK

Pictures load, search finds a word of a guide, nothing is asked from another machine.
"""

import functools
import http.server
import pathlib
import sys
import threading

from browser import Driver, wait

SITE, WORK = (pathlib.Path(each).resolve() for each in sys.argv[1:3])
PAGES = ["index.html", "docs/guide-experimenter.html", "docs/session-file.html",
         "headers/bvh_8h.html", "results/force_training/report.html"]
BROKEN = ("return Array.from(document.images).filter(i => !i.complete || i.naturalWidth == 0)"
          ".map(i => i.src)")
SEARCH = """
const query = document.querySelector("[data-md-component=search-query]");
query.focus();
query.value = "sigmoid sinus";
query.dispatchEvent(new Event("input", {bubbles: true}));
query.dispatchEvent(new KeyboardEvent("keyup", {bubbles: true}));
"""
FOUND = ("return Array.from(document.querySelectorAll('.md-search-result__link'))"
         ".map(link => link.href)")


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def visit(page, base):
    for name in PAGES:
        page.call("POST", "/url", {"url": f"{base}/{name}"})
        page.run("document.querySelectorAll('img').forEach(i => i.loading = 'eager')")
        wait(f"pictures of {name}", lambda: page.run(BROKEN) == [])


def search(page, base):
    page.call("POST", "/url", {"url": f"{base}/docs/guide-bone.html"})
    page.run(SEARCH)
    wait("a result", lambda: page.run(FOUND))
    found = page.run(FOUND)
    assert any("docs/" in link for link in found), found
    page.call("POST", "/url", {"url": found[0]})
    assert "sinus" in page.run("return document.body.innerText").lower(), found[0]


def complaints(page):
    return [each for each in page.complaints() if "favicon" not in each]


def outside(asked, base):
    """What would leave the machine; addresses such as data: and chrome: do not."""
    return [url for url in asked if url.startswith(("http", "ws", "ftp")) and not url.startswith(base)]


server = http.server.ThreadingHTTPServer(
    ("127.0.0.1", 0), functools.partial(Quiet, directory=str(SITE)))
threading.Thread(target=server.serve_forever, daemon=True).start()
driver = Driver(WORK)
try:
    base = f"http://127.0.0.1:{server.server_port}"
    visit(driver, base)
    search(driver, base)
    left, complained = outside(driver.requested(), base), complaints(driver)
    assert left == [] and complained == [], (left[:5], complained[:5])
finally:
    driver.close()
    server.shutdown()
print("the site works")
