"use strict";
// The text of a definition: CodeMirror if it is installed, else a plain field with the same means.
const kScripts = ["lib/codemirror.js", "mode/toml/toml.js", "addon/hint/show-hint.js", "addon/dialog/dialog.js",
                  "addon/search/searchcursor.js", "addon/search/search.js"];
const kStyles = ["lib/codemirror.css", "addon/hint/show-hint.css", "addon/dialog/dialog.css"];
let code_mirror = null;  // a promise whether it is there

function load(element) {
  return new Promise((resolve, reject) => {
    element.nonce = kNonce;
    element.onload = resolve;
    element.onerror = reject;
    document.head.prepend(element);  // the page's own styles come later and win
  });
}
async function load_code_mirror() {
  try {
    for (const name of kStyles) {
      const style = make("link", {rel: "stylesheet"});
      style.href = address("/library", {name});
      await load(style);
    }
    for (const name of kScripts) {
      const script = make("script");
      script.src = address("/library", {name});
      await load(script);
    }
    return true;
  } catch {
    return false;
  }
}

/// @returns {element, text(), replace(text), undo(), redo(), on_change(f), on_cursor(f), go_to(line), look_at(line), line(), show(remarks), before(), refresh()}
async function make_editor(text, label, save) {
  code_mirror = code_mirror || load_code_mirror();
  return await code_mirror ? rich_editor(text, label, save) : plain_editor(text, label, save);
}

/// The span that two texts do not share, and what the second has there.
function change_between(before, after) {
  let from = 0, same = 0;
  const most = Math.min(before.length, after.length);
  while (from < most && before[from] === after[from]) ++from;
  while (same < most - from && before[before.length - 1 - same] === after[after.length - 1 - same]) ++same;
  return {from, to: before.length - same, text: after.slice(from, after.length - same)};
}

function plain_editor(text, label, save) {
  const field = make("textarea", {id: "text", spellcheck: "false", autocomplete: "off", "aria-label": label});
  field.value = text;
  field.addEventListener("keydown", (event) => {
    if (event.ctrlKey && event.key === "s") { event.preventDefault(); save(); }
  });
  return {
    element: make("div", {}, make("p", {class: "soft", id: "plain_editor"}, word("plain_editor")), field),
    text: () => field.value,
    replace(text) {
      const at = change_between(field.value, text);
      field.setRangeText(at.text, at.from, at.to);
      field.dispatchEvent(new Event("input"));
    },
    undo() { field.focus(); document.execCommand("undo"); },
    redo() { field.focus(); document.execCommand("redo"); },
    look_at() {},
    line: () => field.value.slice(0, field.selectionStart).split("\n").length,
    on_change: (f) => field.addEventListener("input", f),
    on_cursor: (f) => { for (const kind of ["keyup", "click", "focus"]) field.addEventListener(kind, f); },
    before: () => field.value.slice(0, field.selectionStart).split("\n"),
    after: () => field.value.slice(field.selectionStart),
    go_to(line) {
      const start = field.value.split("\n").slice(0, line - 1).reduce((sum, each) => sum + each.length + 1, 0);
      field.focus();
      field.setSelectionRange(start, start);
    },
    show() {},
    refresh() {},
  };
}

function rich_editor(text, label, save) {
  const holder = make("div", {id: "text"});
  const editor = CodeMirror(holder, {
    value: text, mode: "text/x-toml", lineNumbers: true, viewportMargin: Infinity, lineWrapping: true,
    gutters: ["CodeMirror-linenumbers", "remarks"],
    extraKeys: {"Ctrl-Space": complete, "Ctrl-S": save, Tab: false, "Shift-Tab": false},  // Tab leaves the text
  });
  editor.getInputField().setAttribute("aria-label", label);
  editor.on("inputRead", (_, change) => {
    if (/^[\w.]$/.test(change.text[0]) && change.text.length === 1 && !editor.state.completionActive) complete(editor, true);
  });
  let widgets = [], marked = [], looked = [];
  const before = () => {
    const at = editor.getCursor();
    const lines = editor.getRange({line: 0, ch: 0}, at).split("\n");
    return lines;
  };
  return {
    element: holder,
    editor,
    text: () => editor.getValue(),
    replace(text) {
      const at = change_between(editor.getValue(), text);
      editor.replaceRange(at.text, editor.posFromIndex(at.from), editor.posFromIndex(at.to));
    },
    undo: () => editor.undo(),
    redo: () => editor.redo(),
    look_at(line) { editor.scrollIntoView({line: line - 1, ch: 0}, 60); looked.forEach((each) => editor.removeLineClass(each, "background", "line-looked")); looked = [editor.addLineClass(line - 1, "background", "line-looked")]; },
    line: () => editor.getCursor().line + 1,
    on_change: (f) => editor.on("change", f),
    on_cursor: (f) => editor.on("cursorActivity", f),
    before,
    after: () => editor.getLine(editor.getCursor().line).slice(editor.getCursor().ch),
    go_to(line) { editor.setCursor({line: line - 1, ch: 0}); editor.focus(); },
    show(remarks) {
      editor.operation(() => {
        widgets.forEach((widget) => widget.clear());
        marked.forEach((line) => editor.removeLineClass(line, "background", "line-mistake"));
        editor.clearGutter("remarks");
        const placed = remarks.filter((remark) => remark.line > 0 && remark.line <= editor.lineCount());
        widgets = placed.map((remark) => editor.addLineWidget(remark.line - 1, at_line(remark)));
        marked = placed.filter((remark) => remark.mistake).map((remark) => editor.addLineClass(remark.line - 1, "background", "line-mistake"));
        for (const remark of placed) editor.setGutterMarker(remark.line - 1, "remarks", make("span", {class: remark.mistake ? "bad" : "warn", title: remark.text}, remark.mistake ? "\u2716" : "\u26A0"));
      });
    },
    refresh: () => editor.refresh(),
  };
}
const at_line = (remark) => make("div", {class: remark.mistake ? "at-line" : "at-line warn", lang: "en"}, remark.text);

/// Lists what may stand at the cursor. @param quietly  only where something was begun
async function complete(editor, quietly = false) {
  const schema = await schema_of(editor.getValue());
  if (!schema) return;
  const place = place_of(editor.getRange({line: 0, ch: 0}, editor.getCursor()).split("\n"));
  if (quietly && (place.kind === "value" || place.prefix.length < 2)) return;
  const node = node_at(schema, place.path);
  const all = place.kind === "value" ? values_of(node).map((value) => [value, ""]) : keys_in(schema, node);
  const list = all.filter(([name]) => name.startsWith(place.prefix) && name !== place.prefix).map(([name, words]) => ({
    text: name, render: (element) => element.append(name, words ? "  \u2013  " + words.split("\n")[0] : ""),
  }));
  const to = editor.getCursor();
  editor.showHint({completeSingle: false, hint: () => ({list, from: {line: to.line, ch: to.ch - place.prefix.length}, to: editor.getCursor()}),
                   closeOnUnfocus: true, updateOnCursorActivity: false});
}
