"use strict";
// Definition: the text, what is wrong with it, what its keys mean.
const drafts = new Map();  // file -> the text as it is being written, with its undo

/// A draft that was opened before is compared with its file.
async function draft_of(file) {
  if (drafts.has(file)) await drafts.get(file).look();
  else drafts.set(file, await open_draft(file));
  return drafts.get(file);
}

async function show_definition(main, file) {
  const save_button = make("button", {type: "button", class: "main", id: "save"}, word("save"));
  const saved = make("span", {id: "saved", role: "status"});
  const count = make("span", {id: "count", role: "status"});
  const remarks = make("ul", {class: "remarks-list", id: "remarks"});
  const plan = make("div", {}), since = make("ul", {class: "remarks-list", id: "since"});
  const since_part = make("div", {hidden: true}, make("h2", {}, word("since_last")), since);
  const newer = make("div", {id: "newer", role: "alert"});
  main.append(make("h1", {}, file), make("div", {class: "row"}, save_button, saved, count), newer);
  const draft = await draft_of(file);
  const key = key_help(draft.editor);
  main.append(make("div", {class: "editor"}, make("section", {"aria-label": word("text_of", {file})}, draft.editor.element),
    make("aside", {}, key, make("section", {"aria-label": word("mistakes", {n: ""})}, remarks, since_part, plan), draft.form.element)));
  const preview = preview_part(file);
  const beside = make("details", {id: "preview_beside", ontoggle: () => beside.open && preview.renew()}, make("summary", {}, word("preview")), preview.element);
  main.append(make("section", {"aria-label": word("preview")}, beside));
  draft.editor.refresh();
  draft.show = () => {
    const changed = draft.newer !== null || draft.editor.text() !== draft.text;
    saved.textContent = word(changed ? "unsaved" : "as_saved");
    saved.className = changed ? "bad" : "soft";
    save_button.disabled = !changed;
    newer.replaceChildren(...(draft.newer === null ? [] : [choice_of_texts(file, draft)]));
  };
  draft.show_remarks = (checked) => {
    draft.editor.show(checked.remarks);
    const mistakes = checked.remarks.filter((remark) => remark.mistake).length;
    const warnings = checked.remarks.length - mistakes;
    count.textContent = (checked.valid ? word("valid") : word("mistakes", {n: mistakes})) + (warnings > 0 ? ", " + word("warnings", {n: warnings}) : "");
    count.className = checked.valid ? "good" : "bad";
    remarks.replaceChildren(...checked.remarks.map((remark) => remark_item(remark, draft.editor)));
    draft.form.renew().then(() => draft.form.show(checked.remarks));
    if (beside.open && checked.valid) preview.renew();
    since.replaceChildren(...checked.since.map((line) => make("li", {class: / another study: /.test(line) ? "warn" : "", lang: "en"}, line)));
    since_part.hidden = checked.since.length === 0;
    plan.replaceChildren(make("details", {open: checked.valid}, make("summary", {}, word("plan")), printed(checked.output)), command_line(checked.command));
  };
  save_button.addEventListener("click", draft.save);
  draft.show();
  draft.check();
}

/// The two ways to go on if another program changed the file while its text was changed here.
function choice_of_texts(file, draft) {
  return make("div", {class: "row"}, make("span", {class: "bad"}, word("newer_file", {file})),
    make("button", {type: "button", id: "take_file", onclick: draft.take_file}, word("take_file")),
    make("button", {type: "button", id: "keep_text", onclick: draft.keep_text}, word("keep_text")));
}

const lines_of = (text) => text.replaceAll("\r\n", "\n");

async function open_draft(file) {
  const draft = {checks: 0, newer: null, show() {}, show_remarks() {}};
  draft.know = (read) => {
    draft.windows_lines = read.text.includes("\r\n");  // kept as they are
    draft.text = lines_of(read.text);
    draft.stamp = read.stamp;
    draft.newer = null;
  };
  draft.know(await get("/text", {file}));
  draft.save = async () => {
    await attempt(async () => {
      const text = draft.editor.text();
      const kept = await post("/save", {file, text: draft.windows_lines ? text.replaceAll("\n", "\r\n") : text, stamp: draft.stamp});
      draft.text = text;
      draft.stamp = kept.stamp;
      draft.show();
      say(word("saved"));
    });
    await draft.look();
  };
  /// A text that was not changed here follows its file; of one that was, the page offers both.
  draft.look = () => by_itself("file", async () => {
    const before = draft.stamp, read = await get("/text", {file});
    if (draft.stamp !== before) return;  // it was saved meanwhile
    const text = draft.editor.text();
    draft.newer = read.stamp === draft.stamp ? null : read;
    if (draft.newer !== null && text === draft.text) {
      draft.take_file();
      say(word("read_again"));
    } else if (draft.newer !== null && text === lines_of(read.text)) {
      draft.know(read);
    }
    draft.show();
  });
  draft.take_file = () => {
    draft.know(draft.newer);
    draft.editor.replace(draft.text);
    draft.show();
  };
  draft.keep_text = () => {
    draft.know(draft.newer);
    draft.show();
  };
  draft.check = () => by_itself("check", async () => {
    const number = ++draft.checks;
    const checked = await post("/validate", {file, text: draft.editor.text()});
    if (number === draft.checks) draft.show_remarks(checked);
  });
  draft.editor = await make_editor(draft.text, word("text_of", {file}), draft.save);
  draft.form = make_form(file, draft);
  draft.editor.on_cursor(() => draft.form.go_to(draft.editor.line()));
  draft.editor.on_change(() => {
    draft.show();
    clearTimeout(draft.pause);
    draft.pause = setTimeout(draft.check, 500);
  });
  return draft;
}

function remark_item(remark, editor) {
  const text = (remark.line > 0 ? word("line", {n: remark.line}) : "") + remark.text;
  const style = {class: remark.mistake ? "bad" : "warn", lang: "en"};
  return make("li", {}, remark.line > 0 ? make("button", {type: "button", ...style, onclick: () => editor.go_to(remark.line)}, text) : make("span", style, text));
}

/// What the schema says of the key at the cursor.
function key_help(editor) {
  const name = make("b", {id: "key_name"}), words = make("p", {id: "key_words"}, word("no_key"));
  editor.on_cursor(async () => {
    const schema = await schema_of(editor.text());
    const lines = editor.before();
    lines[lines.length - 1] += editor.after().match(/^[\w.-]*/)[0];  // the whole word at the cursor
    const place = place_of(lines);
    const path = place.kind === "value" ? place.path : place.path.concat(parts_of(place.prefix));
    const node = schema && path.length > 0 ? node_at(schema, path) : null;
    name.textContent = node ? path.join(".") : "";
    words.textContent = node ? node.description || "" : word("no_key");
  });
  return make("section", {"aria-labelledby": "key_title"}, make("h2", {id: "key_title"}, word("key")), name, words);
}

window.addEventListener("focus", () => { for (const draft of drafts.values()) draft.look(); });
window.addEventListener("beforeunload", (event) => {
  if ([...drafts.values()].some((draft) => draft.editor.text() !== draft.text)) event.preventDefault();
});
