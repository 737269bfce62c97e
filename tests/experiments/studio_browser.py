"""A study from the gallery to its report on the studio's page, in headless Chromium, with a session
of a participant, who sits at the mouse while this prints "sits down" and until it prints "gets up".

    studio_browser.py URL PLAIN_URL FOLDER STUDIES

The studio of the folder STUDIES at PLAIN_URL has no CodeMirror. Leaves pictures in FOLDER. Exit
status 0: all was as it should be.
"""

import json
import pathlib
import re
import sys

from browser import Driver, Refused, ask, state, wait

KEYS = {"Backspace": "\ue003", "Tab": "\ue004", "Enter": "\ue007"}
CONTROL = "\ue009"


def press(page, *keys):
    for key in keys:
        page.key(KEYS.get(key, key))


def press_with_control(page, key):
    page.call("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": [
        {"type": "keyDown", "value": CONTROL}, {"type": "keyDown", "value": key},
        {"type": "keyUp", "value": key}, {"type": "keyUp", "value": CONTROL}]}]})


def there(page, selector):
    return page.run(f"return document.querySelector({selector!r}) !== null")


def words(page, selector):
    return page.run(f"const e = document.querySelector({selector!r}); return e ? e.innerText : ''")


def home(page, url):
    """The studies of the folder, one of them with a script for a name; nothing of it runs."""
    page.open(url)
    wait("the states", lambda: page.run(
        "const rows = [...document.querySelectorAll('tbody')][0];"
        "return rows ? rows.innerText.split('ready').length - 1 : 0") == 1)
    assert "<img src=x onerror=alert(1)>.toml" in words(page, "table"), words(page, "table")
    assert page.run("return document.images.length") == 0
    wait("the gallery", lambda: there(page, "#begin_first_experiment"))
    wait("the machine", lambda: there(page, "#verdict"))


def clean_home(page, url, folder):
    """The picture of the studies is one without those that only a test has."""
    page.open(url)
    page.call("POST", "/refresh")
    wait("the states", lambda: "checking" not in words(page, "table") and "pulls" in words(page, "table"))
    page.run("for (const row of document.querySelectorAll('tbody tr'))"
             " if (/<img|evil/.test(row.innerText)) row.remove()")
    page.picture(folder / "studio-home.png")


def begin(page):
    page.click("begin_first_experiment")
    page.type("new_name", "a b")
    page.click("create")
    assert there(page, "dialog"), "a name with a space is not taken"
    page.run("document.getElementById('new_name').value = ''")
    page.type("new_name", "pulls")
    page.click("create")
    wait("the text", lambda: "participants = 6" in words(page, ".CodeMirror"))
    wait("the check", lambda: page.text("count") == "No mistakes")
    assert page.text("saved") == "As saved on disk", page.text("saved")


def to_participants(page):
    """Puts the cursor behind the number of participants."""
    return page.run(
        "const editor = document.querySelector('.CodeMirror').CodeMirror;"
        "const line = editor.getValue().split('\\n').findIndex((each) => each.startsWith('participants'));"
        "editor.focus(); editor.setCursor({line, ch: editor.getLine(line).length}); return line + 1")


def make_a_mistake_and_mend_it(page):
    line = to_participants(page)
    wait("the key", lambda: page.text("key_name") == "design.participants")
    assert "articipants" in page.text("key_words"), page.text("key_words")
    press(page, "Backspace", "0")
    wait("the mistake", lambda: page.text("count") == "1 mistake")
    wait("its sentence", lambda: "design.participants is 0" in words(page, ".at-line"))
    at = page.run("const editor = document.querySelector('.CodeMirror').CodeMirror; let at = [];"
                  "editor.eachLine((line) => { if (line.widgets) at.push(editor.getLineNumber(line) + 1); });"
                  "return at")
    assert at == [line], (at, line)
    assert words(page, "#remarks button").startswith(f"Line {line}: "), words(page, "#remarks")
    assert page.text("saved") == "Not saved", page.text("saved")


def complete(page):
    """Ctrl+Space lists the keys of the table; Tab leaves the text."""
    line = to_participants(page)
    page.run("const editor = document.querySelector('.CodeMirror').CodeMirror;"
             "editor.replaceRange('\\nbre', editor.getCursor()); editor.focus()")
    press_with_control(page, " ")
    wait("completions", lambda: there(page, ".CodeMirror-hints"))
    assert words(page, ".CodeMirror-hints").startswith("break_after"), words(page, ".CodeMirror-hints")
    press(page, "Enter")
    wait("the completed key", lambda: "break_after" in words(page, ".CodeMirror-code"))
    page.run("const editor = document.querySelector('.CodeMirror').CodeMirror;"
             f"editor.replaceRange('', {{line: {line}, ch: 0}}, {{line: {line + 1}, ch: 0}}); editor.focus()")
    press(page, "Tab")
    assert page.run("return document.activeElement.closest('.CodeMirror') === null")


def mend_and_save(page):
    to_participants(page)
    press(page, "Backspace", "4")
    page.run("const editor = document.querySelector('.CodeMirror').CodeMirror, text = editor.getValue();"
             "const at = text.indexOf('repetitions = 10') + 'repetitions = '.length;"
             "editor.replaceRange('2', editor.posFromIndex(at), editor.posFromIndex(at + 2)); editor.focus()")
    wait("no mistake", lambda: page.text("count") == "No mistakes")
    assert not there(page, ".at-line")
    press_with_control(page, "s")
    wait("it is saved", lambda: page.text("saved") == "As saved on disk")


def other_programs(page, file):
    """Another program changes the file of a text that is open."""
    text = ("const editor = document.querySelector('.CodeMirror');"
            "return editor ? editor.CodeMirror.getValue() : ''")
    checks = ("return performance.getEntriesByType('resource')"
              ".filter((each) => each.name.endsWith('/validate')).length")
    original = file.read_text()

    def open_view(view):
        page.run(f"location.hash = '#{view}'")
        wait(view, lambda: page.run("return document.getElementById('main').innerText") != "")

    def write(line):
        page.run("document.querySelector('.CodeMirror').CodeMirror.replaceRange("
                 f"{line!r}, {{line: 0, ch: 0}})")
    open_view("definition/pulls.toml")
    wait("the text", lambda: page.run(text) == original)
    file.write_text("# by another\n" + original)
    page.run("window.dispatchEvent(new Event('focus'))")
    wait("the file's text", lambda: page.run(text) == "# by another\n" + original)
    assert page.text("saved") == "As saved on disk", page.text("saved")
    open_view("home")
    file.write_text("# by a third\n" + original)
    open_view("definition/pulls.toml")
    wait("the text of the file as it is now", lambda: page.run(text) == "# by a third\n" + original)
    wait("the check", lambda: page.text("count").startswith("No mistakes"))

    file.write_text("# by a fourth\n" + original)
    write("# here\n")
    page.run("document.getElementById('save').click()")
    refusal = "pulls.toml was changed by another program since it was read here; nothing was saved"
    wait("the refusal", lambda: page.text("trouble") == refusal)
    before = page.run(checks)
    write("# and here\n")
    wait("a check more", lambda: page.run(checks) > before)
    wait("its result", lambda: page.text("count").startswith("No mistakes"))
    assert page.text("trouble") == refusal, "a check takes nothing back that the user was told"
    open_view("home")
    open_view("definition/pulls.toml")
    wait("the choice", lambda: there(page, "#keep_text"))
    assert page.run("return document.getElementById('trouble').hidden"), "what the user does takes it back"
    assert page.text("saved") == "Not saved", page.text("saved")
    page.click("keep_text")
    assert not there(page, "#keep_text")
    page.click("save")
    wait("it is saved", lambda: page.text("saved") == "As saved on disk")
    assert file.read_text() == "# and here\n# here\n# by a third\n" + original, file.read_text()

    write("# unsaved\n")
    file.write_text(original)
    page.run("window.dispatchEvent(new Event('focus'))")
    wait("the choice", lambda: there(page, "#take_file"))
    page.click("take_file")
    wait("the file's text", lambda: page.run(text) == original)
    assert page.text("saved") == "As saved on disk", page.text("saved")
    assert file.read_text() == original


def texts_of_form(page):
    'A text of one line is shown without its quotation marks, and one that begins with "[" is a text.'
    for raw, text in (('"a \\"b\\" \\U0001F600"', 'a "b" \U0001F600'), ("'a \\'", "a \\"), ('""', ""),
                      ('"""Eine "Pause"."""', 'Eine "Pause".'), ("'''it's'''", "it's"), ("[1, 2]", None)):
        assert page.run("return unquoted(" + json.dumps(raw) + ")") == text, raw
    write = lambda typed, node, was: page.run("return written(" + ", ".join(map(json.dumps, (typed, node, was))) + ")")
    text, either = {"type": "string"}, {"anyOf": [{"type": "string"}, {"type": "array"}]}
    assert write("[Danke] Ende", text, '"Ende"') == '"[Danke] Ende"'
    assert write("Eine lange Pause.", text, '"""Eine Pause."""') == '"Eine lange Pause."'
    assert write('["a"]', either, '"all"') == '["a"]'


def by_form(page, folder):
    """An edit of the form is one edit of the text, which the text's undo takes back."""
    text = "return document.querySelector('.CodeMirror').CodeMirror.getValue()"
    before = page.run(text)
    wait("the form", lambda: there(page, "[id='form_design.participants']"))
    texts_of_form(page)
    page.run("const group = document.getElementById('form_design.participants').closest('details');"
             "group.open = true")
    page.run("const field = document.getElementById('form_design.participants');"
             "field.focus(); field.value = '0'; field.dispatchEvent(new Event('change'))")
    wait("the text", lambda: "participants = 0" in page.run(text))
    assert page.run(text) == re.sub(r"participants = \d+", "participants = 0", before)
    wait("its mistake beside the field", lambda: "design.participants is 0" in words(page, "[id='form_design.participants_bad']"))
    assert "haptrial set pulls.toml design.participants 0" in words(page, "aside"), words(page, "aside")
    assert page.run("return document.activeElement.id") == "form_design.participants"
    page.picture(folder / "studio-form.png")
    page.click("undo")
    wait("the undo", lambda: page.run(text) == before)
    wait("no mistake by the form", lambda: page.text("count") == "No mistakes")
    page.run("document.getElementById('add_design').closest('details').open = true;"
             "const list = document.getElementById('add_design'); list.value = 'break_after';"
             "list.closest('details').querySelector('button').click()")
    wait("the key more", lambda: "break_after" in page.run(text))
    wait("its field", lambda: there(page, "[id='form_design.break_after']"))
    page.run("document.querySelector(\"[aria-label='Remove design.break_after']\").click()")
    wait("the key is gone", lambda: page.run(text) == before)
    wait("it is as saved, again", lambda: page.text("saved") == "As saved on disk")


def heading_in_frame(page, frame):
    """Waits for the heading of the page in a frame, which may just be given another page.
    @returns it"""
    found = []

    def headings():
        page.call("POST", "/frame", {"id": None})
        page.call("POST", "/frame", {"id": {"element-6066-11e4-a52e-4f735466cecf": page.element(frame)}})
        elements = page.call("POST", "/elements", {"using": "css selector", "value": "h1"})
        return [page.call("GET", f"/element/{next(iter(each.values()))}/text") for each in elements]

    def is_there():
        try:
            found[:] = headings()
        except Refused:  # the heading went with the page before
            found.clear()
        return found != []
    wait("a heading in the frame", is_there)
    page.call("POST", "/frame", {"id": None})
    return found


def in_frame(page, frame, script):
    """Runs a script in a frame. @returns what it returns"""
    page.call("POST", "/frame", {"id": {"element-6066-11e4-a52e-4f735466cecf": page.element(frame)}})
    try:
        return page.run(script)
    finally:
        page.call("POST", "/frame", {"id": None})


def film(page):
    """The film of a virtual participant's trial plays and pauses."""
    page.click("preview_virtual")
    wait("the film", lambda: in_frame(page, "preview", "return document.querySelector('.film-controls') !== null"))
    def time():
        return float(in_frame(page, "preview", "return document.querySelector('.film-controls input').value"))
    def press_play():
        in_frame(page, "preview", "document.querySelector('.film-controls button').click()")
    page.run("document.getElementById('preview').scrollIntoView()")  # out of sight nothing plays
    before, said = time(), in_frame(page, "preview", "return document.querySelector('.film-said').textContent")
    press_play()
    wait("it plays", lambda: time() != before)
    wait("its words follow", lambda: in_frame(page, "preview", "return document.querySelector('.film-said').textContent") != said)
    if in_frame(page, "preview", "return document.querySelector('.film-controls button').textContent") == "Pause":
        press_play()
    at = time()
    assert time() == at, "it pauses"


def preview(page, folder):
    """The preview is that of the text as it is being written."""
    page.run("document.querySelector('#preview_beside summary').click()")
    wait("the preview", lambda: page.run("return !document.getElementById('preview').hidden"))
    assert any("first_experiment" in each or "pulls" in each for each in heading_in_frame(page, "preview"))
    first = page.run("return document.getElementById('preview').src")
    page.picture(folder / "studio-preview.png")
    film(page)
    page.run("document.getElementById('preview').scrollIntoView()")
    first = page.run("return document.getElementById('preview').src")
    at = in_frame(page, "preview", "scrollTo(0, 300); return scrollY")
    assert at == 300, at
    page.run("const editor = document.querySelector('.CodeMirror').CodeMirror;"
             "editor.replaceRange('# a remark\\n', {line: 0, ch: 0})")
    wait("another preview", lambda: page.run("return document.getElementById('preview').src") != first)
    wait("it stays scrolled", lambda: in_frame(page, "preview", "return scrollY") == at)
    try_it(page, folder)
    page.run("document.querySelector('.CodeMirror').CodeMirror.undo()")
    wait("it is as saved", lambda: page.text("saved") == "As saved on disk")


def try_it(page, folder):
    """The pointer is the hand; forces come back."""
    page.run("document.querySelector('#try summary').click()")
    page.click("try_start")
    wait("the trial", lambda: page.run("return document.getElementById('try_canvas').dataset.answered") is not None)
    page.run("document.getElementById('try_canvas').focus()")
    before = page.text("try_said")
    assert before.startswith("Force "), before
    wait("more answers", lambda: int(page.run("return document.getElementById('try_canvas').dataset.answered")) > 30)
    page.picture(folder / "studio-try.png")
    page.click("try_stop")


def rehearse(page, folder):
    page.click("to_rehearse")
    wait("the form", lambda: there(page, "#rehearse"))
    page.click("rehearse")
    wait("the rehearsal", lambda: words(page, "#job_1_state") == "done")
    wait("its output", lambda: "2 sessions, " in words(page, "#job_1_output"))
    page.call("POST", "/refresh")
    wait("the jobs after a reload", lambda: words(page, "#job_1_state") == "done")
    wait("what the study costs", lambda: words(page, "#job_1 .cost").startswith("lab time: a session takes "))
    page.run("document.querySelector('#job_1 .analyze').click()")
    wait("the analysis", lambda: words(page, "#job_2_state") == "done")
    page.picture(folder / "studio-jobs.png")
    page.run("document.querySelector('#job_2 .report').click()")
    wait("the report", lambda: there(page, "iframe#report"))
    assert heading_in_frame(page, "report") == ["pulls"]
    page.picture(folder / "studio-report.png")


def sessions(page):
    page.click("to_sessions")
    wait("the next session", lambda: "haptrial run pulls.toml --subject P01" in words(page, "main"))
    wait("the rehearsals", lambda: "S01.h5" in words(page, "main"))
    page.run("document.querySelector('table button').click()")
    wait("what a session holds", lambda: "subject     S01 (simulated)" in words(page, "main"))


def prepare_session(page, folder):
    """The checklist and the emergency card."""
    page.click("to_sessions")
    wait("the devices", lambda: there(page, "#device option[value=mouse]"))
    page.run("const device = document.getElementById('device'); device.value = 'mouse';"
             "device.dispatchEvent(new Event('change'))")
    page.click("checklist")
    wait("the checklist", lambda: words(page, "#ready") == "The session can begin.")
    assert "P01, into out/pulls/P01.h5" in words(page, "#checks"), words(page, "#checks")
    page.run("document.getElementById('next_title').scrollIntoView()")
    page.picture(folder / "studio-checklist.png")
    page.click("card")
    wait("the card", lambda: "pulls-card-001.html" in words(page, "#open_card"))


def begin_session(page):
    """@returns the window of the studio, with the console in front"""
    page.click("begin")
    wait("the console", lambda: page.run(
        "const link = document.getElementById('open_console'); return link && link.href.startsWith('http')"))
    studio = page.call("GET", "/window")
    before = page.call("GET", "/window/handles")
    page.click("open_console")
    wait("its tab", lambda: len(page.call("GET", "/window/handles")) == len(before) + 1)
    new = next(each for each in page.call("GET", "/window/handles") if each not in before)
    page.call("POST", "/window", {"handle": new})
    wait("its page", lambda: there(page, "#state"))
    state(page, "Instructions")
    assert page.text("subject").startswith("P01"), page.text("subject")
    return studio


def back_to(page, studio):
    page.call("DELETE", "/window")  # the console's tab
    page.call("POST", "/window", {"handle": studio})


def stays_told(page):
    """The page looks at the session again and again, and takes nothing back by that."""
    page.click("begin")
    wait("the refusal", lambda: "a session is running already" in page.text("trouble"))
    for _ in range(2):
        before = words(page, "#live .n")
        wait("another look", lambda: words(page, "#live .n") != before)
    assert "a session is running already" in page.text("trouble")


def live_session(page, folder):
    """A session that is ended in the middle, and resumed to its end."""
    studio = begin_session(page)
    page.type("note", "began late")
    page.click("keep")
    ask(page, "start")
    wait("a trial", lambda: page.text("state") == "Running")
    console = page.call("GET", "/window")
    page.call("POST", "/window", {"handle": studio})
    page.run("document.getElementById('live_title').scrollIntoView()")
    page.picture(folder / "studio-session.png")
    stays_told(page)
    page.click("end_session")
    page.click("really_end")
    wait("the end", lambda: "it can be resumed" in words(page, "#live_state"))
    page.call("POST", "/window", {"handle": console})
    back_to(page, studio)
    wait("what can be resumed", lambda: "P01, session 1, to be resumed" in words(page, "#who"))
    page.run("const who = document.getElementById('who');"
             "who.value = [...who.options].find((each) => each.text.includes('to be resumed')).value;"
             "who.dispatchEvent(new Event('change'))")
    assert words(page, "#begin") == "Resume the session", words(page, "#begin")
    studio = begin_session(page)
    print("sits down", flush=True)
    ask(page, "start")
    wait("the end of the session", lambda: page.text("state") in ("Ended", "Thanks"))
    page.picture(folder / "console-of-studio.png")
    if page.text("state") == "Thanks":
        ask(page, "start")
    back_to(page, studio)
    wait("the session's end", lambda: "done" in words(page, "#live_state"))
    print("gets up", flush=True)
    wait("the next participant", lambda: "P02" in words(page, "#who"))
    wait("the participants", lambda: "P01" in words(page, "[aria-labelledby=persons_title]"))


def results(page, folder):
    """The report of the session, its quality, and tables for other programs."""
    page.click("to_results")
    wait("the quality", lambda: "intact: every tick is recorded" in words(page, "main"))
    wait("the trials", lambda: "8 of 8 done" in words(page, "main"))
    page.run("document.querySelector('[aria-label=\"Sessions of out/pulls\"] .analyze').click()")
    wait("the analysis", lambda: page.run(
        "return [...document.querySelectorAll('[id^=job_][id$=_state]')].map((e) => e.innerText).join()")
        in ("done,done,done",))
    page.click("to_results")
    wait("the report", lambda: there(page, "iframe#report"))
    wait("the report of people", lambda: "out/pulls/report.html" in page.run(
        "return decodeURIComponent(document.getElementById('report').src)"))
    wait("the quality", lambda: "intact" in words(page, "[aria-labelledby=quality_title]"))
    page.run("document.querySelector('[aria-label=\"Sessions of out/pulls\"] details').open = true")
    assert page.run("return [...document.querySelectorAll('a[download]')].some((a) => a.download === 'report.html')")
    page.picture(folder / "studio-results.png", height=1100)
    page.run("document.querySelector('[aria-label=\"Sessions of out/pulls\"] a[download=\"report.html\"]').click()")


def changes_since(page, url):
    """What differs from the session that was run, and whether it may."""
    page.open(url + "#definition/pulls.toml")
    wait("the check", lambda: page.text("count") == "No mistakes")
    unchanged = "since out/pulls/P01.h5: nothing has changed"
    wait("the newest session", lambda: words(page, "#since") == unchanged)
    page.run("const editor = document.querySelector('.CodeMirror').CodeMirror, text = editor.getValue();"
             "const at = text.indexOf('repetitions = 2') + 'repetitions = '.length;"
             "editor.replaceRange('3', editor.posFromIndex(at), editor.posFromIndex(at + 1)); editor.focus()")
    wait("the change", lambda: "repetitions" in words(page, "#since"))
    assert there(page, "#since .warn"), words(page, "#since")  # the trials of a study stay as they are
    page.run("document.querySelector('.CodeMirror').CodeMirror.undo()")
    wait("nothing differs", lambda: words(page, "#since") == unchanged)


def by_keyboard_alone(page, url):
    """From home to a rehearsal: Tab, Enter and typing."""
    page.open(url)
    wait("the gallery", lambda: there(page, "#begin_first_experiment"))

    def tab_to(name):
        for _ in range(300):
            if page.run("return document.activeElement.id") == name:
                return
            press(page, "Tab")
        raise AssertionError(f"Tab does not lead to {name}")

    tab_to("begin_wall_detection")
    press(page, "Enter")
    wait("the dialog", lambda: there(page, "#new_name"))
    tab_to("new_name")
    press(page, *"walls", "Enter")
    wait("the text", lambda: page.run("return location.hash") == "#definition/walls.toml")
    wait("the check", lambda: words(page, "#count").startswith("No mistakes"))
    tab_to("to_rehearse")
    press(page, "Enter")
    wait("the form", lambda: there(page, "#rehearse"))
    tab_to("subjects")
    press(page, "Enter")
    wait("a job", lambda: "walls.toml" in words(page, "#jobs"))
    tab_to("to_sessions")
    press(page, "Enter")
    wait("the devices", lambda: there(page, "#device option[value=mouse]"))
    tab_to("checklist")
    press(page, "Enter")
    wait("the checklist", lambda: there(page, "#ready"))


def hostile_files(page, url):
    """What a folder from elsewhere may hold: nothing of it runs."""
    for view in ("definition/evil.toml", "sessions/evil.toml", "results/evil.toml"):
        page.open(url + "#" + view)
        page.call("POST", "/refresh")
        wait(view, lambda: "evil" in words(page, "main"))
    wait("the report's frame", lambda: there(page, "iframe#report"))
    wait("the session's name", lambda: "onerror=hit" in words(page, "main"))
    assert page.run("return window.hit === undefined && document.images.length === 0")


def without_code_mirror(page, url):
    page.open(url + "#definition/pulls.toml")
    wait("the plain text", lambda: page.run(
        "const text = document.querySelector('textarea'); return text ? text.value : ''") != "")
    assert "libjs-codemirror" in page.text("plain_editor")
    page.type("text", "\n[wrong]\nx = 1\n")
    wait("the mistake", lambda: "[wrong] is not a known table" in words(page, "#remarks"))


def main():
    url, plain, folder, studies = sys.argv[1], sys.argv[2], *map(pathlib.Path, sys.argv[3:])
    page = Driver(folder, ["--lang=en-US"])
    try:
        home(page, url)
        begin(page)
        make_a_mistake_and_mend_it(page)
        page.picture(folder / "studio-mistake.png")
        complete(page)
        mend_and_save(page)
        other_programs(page, studies / "pulls.toml")
        by_form(page, folder)
        preview(page, folder)
        rehearse(page, folder)
        sessions(page)
        prepare_session(page, folder)
        live_session(page, folder)
        results(page, folder)
        changes_since(page, url)
        # of a console that ended, and of what was refused as it should be
        bad = [each for each in page.complaints() if not re.search("/events|/save |/begin ", each)]
        assert not bad, bad
        clean_home(page, url, folder)
        by_keyboard_alone(page, url)
        hostile_files(page, url)
        page.complaints()  # the policy says what it kept from running
        without_code_mirror(page, plain)
    finally:
        page.close()


main()
