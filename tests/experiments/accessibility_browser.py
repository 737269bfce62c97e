"""Every view of the studio, the console, its copy that only looks, and the pages that commands write,
by the rules of axe-core in headless Chromium.

    accessibility_browser.py URL STUDIES FOLDER PACKAGES

The studio at URL shows the folder STUDIES, which holds pulls.toml, its rehearsal in out/pulls with a
report, preview.html and card.html. Axe-core is kept in PACKAGES. Exit status 0: there is no finding;
3: axe-core is out of reach.
"""

import pathlib
import sys
import urllib.parse

from accessibility import Rules
from browser import Driver, state, wait
from npm_package import OutOfReach


def shows(page, selector):
    return page.run(f"return document.querySelector({selector!r}) !== null")


VIEWS = {  # what each shows last
    "home": "#verdict",
    "definition/pulls.toml": "#remarks",
    "preview/pulls.toml": "iframe#preview:not([hidden])",
    "rehearse/pulls.toml": "#rehearse",
    "sessions/pulls.toml": "#device option",
    "results/pulls.toml": "iframe#report",
}


def view(page, url, name):
    page.open("about:blank")
    page.open(url + "#" + name)
    wait(name, lambda: shows(page, VIEWS[name]))
    wait(name + " without waiting", lambda: "checking" not in page.run("return document.body.innerText"))


# The colours of every alarm, whether or not this session has one.
ALARMS = """
document.getElementById('light').classList.add('bad');
document.querySelectorAll('.force').forEach((each) => each.classList.add('near'));
for (const id of ['aborts', 'fault', 'pilot']) {
  const each = document.getElementById(id);
  each.hidden = false;
  each.insertAdjacentHTML('beforeend', each.tagName === 'UL' ? '<li>an alarm</li>' : ' an alarm');
}
"""


def session(page, url, check):
    """The console of a session, and the view that began it."""
    view(page, url, "sessions/pulls.toml")
    page.run("document.getElementById('device').value = 'virtual';"
             "document.getElementById('shows_window').checked = false;"
             "document.getElementById('watch').value = '127.0.0.1'")
    page.run("document.querySelector('#session_form details').open = true")
    page.click("checklist")
    wait("the checklist", lambda: shows(page, "#ready"))
    check("the checklist")
    page.click("begin")
    wait("the session", lambda: page.run(
        "const link = document.getElementById('open_console'); return link && link.href.startsWith('http')"))
    check("a session that runs")
    console = page.run("return document.getElementById('open_console').href")
    watch = page.run("return document.querySelector('#watch_at code').textContent")
    page.click("end_session")
    wait("the question", lambda: shows(page, "#really_end"))
    check("the question before the end")
    page.open(watch)
    state(page, "Instructions")
    assert page.hidden("emergency_stop") and page.hidden("note"), "who watches can press nothing"
    check("the console's copy")
    page.open(console)
    state(page, "Instructions")
    check("the console")
    page.click("start")
    state(page, "Running")
    check("the console in a trial")
    page.run(ALARMS)
    check("the console with every alarm")
    page.click("abort")
    check("the console's question")
    page.click("for_good")
    state(page, "Ended")


def main():
    url, studies, folder, packages = sys.argv[1:]
    try:
        rules = Rules(packages)
    except OutOfReach as error:
        print(error, file=sys.stderr)
        sys.exit(3)
    page = Driver(pathlib.Path(folder), ["--lang=en-US"])
    findings = []

    def check(what):
        findings.extend(f"{what}: {each}" for each in rules.findings(page))
    try:
        page.open("data:text/html," + urllib.parse.quote("<html><img src=x><p>no language"))
        check("a bad page")
        assert len(findings) > 2, "the rules find nothing on a page that breaks them"
        findings.clear()
        for name in VIEWS:
            view(page, url, name)
            page.run("document.querySelectorAll('details').forEach((each) => { each.open = true; })")
            check(name)
        session(page, url, check)
        for file in ("preview.html", "card.html", "out/pulls/report.html"):
            page.open((pathlib.Path(studies) / file).as_uri())
            check(file)
    finally:
        page.close()
    assert not findings, "\n".join(findings)


main()
