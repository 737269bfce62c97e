"use strict";
// Definition: the text, what is wrong with it, what its keys mean.
const drafts = new Map();  // file -> the text as it is being written, with its undo

async function show_definition(main, file) {
  const save_button = make("button", {type: "button", class: "main", id: "save"}, word("save"));
  const saved = make("span", {id: "saved", role: "status"});
  const count = make("span", {id: "count", role: "status"});
  const remarks = make("ul", {class: "remarks-list", id: "remarks"});
  const plan = make("div", {}), since = make("ul", {class: "remarks-list", id: "since"});
  const since_part = make("div", {hidden: true}, make("h2", {}, word("since_last")), since);
  main.append(make("h1", {}, file), make("div", {class: "row"}, save_button, saved, count));
  if (!drafts.has(file)) drafts.set(file, await open_draft(file));
  const draft = drafts.get(file);
  const key = key_help(draft.editor);
  main.append(make("div", {class: "editor"}, make("section", {"aria-label": word("text_of", {file})}, draft.editor.element),
    make("aside", {}, key, make("section", {"aria-label": word("mistakes", {n: ""})}, remarks, since_part, plan), draft.form.element)));
  const preview = preview_part(file);
  const beside = make("details", {id: "preview_beside", ontoggle: () => beside.open && preview.renew()}, make("summary", {}, word("preview")), preview.element);
  main.append(make("section", {"aria-label": word("preview")}, beside));
  draft.editor.refresh();
  draft.show = () => {
    const changed = draft.editor.text() !== draft.text;
    saved.textContent = word(changed ? "unsaved" : "as_saved");
    saved.className = changed ? "bad" : "soft";
    save_button.disabled = !changed;
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

async function open_draft(file) {
  const read = await get("/text", {file});
  const windows_lines = read.text.includes("\r\n");  // kept as they are
  const draft = {text: read.text.replaceAll("\r\n", "\n"), stamp: read.stamp, checks: 0};
  draft.save = () => attempt(async () => {
    const text = draft.editor.text();
    const kept = await post("/save", {file, text: windows_lines ? text.replaceAll("\n", "\r\n") : text, stamp: draft.stamp});
    draft.text = text;
    draft.stamp = kept.stamp;
    draft.show();
    say(word("saved"));
  });
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

window.addEventListener("beforeunload", (event) => {
  if ([...drafts.values()].some((draft) => draft.editor.text() !== draft.text)) event.preventDefault();
});
