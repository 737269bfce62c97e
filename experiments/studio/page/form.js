"use strict";
// The definition as a form beside its text. Each edit is one `haptrial set` on the text as it is
// being written, so that comments and order stay, and the text's own undo takes it back.

/// The schema of a key. @param key  with names or numbers of entries, which the schema lacks
function node_of(schema, key) {
  let node = schema;
  for (const part of key.split(".")) {
    const next = step(schema, node, part);
    if (!next && !lists(node)) return null;
    node = next || node;
  }
  return node;
}
const lists = (node) => Boolean(node.items || (node.anyOf || []).some((each) => each.items));
const takes = (node, ...types) => Boolean(node && (types.includes(node.type) || (node.anyOf || []).some((each) => takes(each, ...types))));
const is_map = (node) => Boolean(node && typeof node.additionalProperties === "object");
const is_table = (node) => Boolean(node && (node.properties || is_map(node)));
const is_number = (raw) => /^[-+]?\d[\d_]*(\.\d+)?(e[-+]?\d+)?$/i.test(raw);

/// A text of one line without its quotation marks, one or three; null for anything else.
function unquoted(raw) {
  const literal = raw.match(/^'''(.*)'''$/) || raw.match(/^'([^'\n]*)'$/);
  if (literal) return literal[1];
  const basic = raw.match(/^"""(.*)"""$/) || raw.match(/^"(.*)"$/);
  if (!basic) return null;
  const json = basic[1].replace(/\\U([0-9A-Fa-f]{8})|\\.|["\t]/g, (sign, code) => code ? String.fromCodePoint(parseInt(code, 16)) : sign === '"' ? '\\"' : sign === "\t" ? "\\t" : sign);
  try { return JSON.parse('"' + json + '"'); } catch { return null; }
}
/// What is typed as a definition writes it. @param was  the value before
function written(typed, node, was) {
  if (takes(node, "string") && !takes(node, "number", "integer", "array", "boolean", "object")) return JSON.stringify(typed);
  const text = unquoted(was) !== null || !takes(node, "number", "integer", "array", "boolean");
  if (is_number(typed) && (takes(node, "number", "integer") || !text)) return typed;
  return text && !/^[[{]/.test(typed) || takes(node, "string") && !/^[[{"']/.test(typed) ? JSON.stringify(typed) : typed;
}

/// A value with which a new key can begin.
function first_value(node) {
  const choices = values_of(node);
  const left_out = ((node && node.description) || "").match(/^If left out: (\S+)$/m);
  if (choices.length > 0 && node.type !== "boolean") return choices[0];
  if (takes(node, "boolean")) return "true";
  if (takes(node, "number", "integer")) {
    return left_out && is_number(left_out[1]) ? left_out[1] : String(node.minimum || (node.anyOf || [{}])[0].minimum || 1);
  }
  return takes(node, "array") ? "[]" : '"new"';
}
/// The edit that begins a key, or a table by the first key that says what it is.
function beginning(schema, key, node) {
  if (takes(node, "array") && tables_of(schema, node.items).length > 0) return {key, edit: "add", value: ""};
  if (!is_table(node) || !node.properties) return {key, edit: "value", value: first_value(node)};
  const names = Object.keys(node.properties);
  const first = names.find((name) => name === "type" || name === "kind") || names.find((name) => !is_table(node.properties[name]));
  return {key: key + "." + first, edit: "value", value: first_value(node.properties[first])};
}

/// @returns {element, renew(), show(remarks), go_to(line)}
function make_form(file, draft) {
  const groups = make("div", {id: "form"});
  const same = make("div", {});
  const undo = make("button", {type: "button", id: "undo", onclick: () => draft.editor.undo()}, word("undo"));
  const redo = make("button", {type: "button", id: "redo", onclick: () => draft.editor.redo()}, word("redo"));
  const open = new Set(["experiment"]);
  let fields = [], remarks = [], schema = null, number = 0;

  const edit = (change) => attempt(async () => {
    const text = draft.editor.text();
    const answer = await post("/set", {file, text, ...change});
    if (draft.editor.text() !== text) return edit(change);  // it was written on meanwhile
    draft.editor.replace(answer.text);
    same.replaceChildren(command_line(answer.command));
    if (change.edit !== "value") await renew();
  });

  async function renew() {
    const own = ++number;
    const stated = await post("/keys", {file, text: draft.editor.text()}).catch(() => null);
    const found = await schema_of(draft.editor.text());
    if (!stated || !found || own !== number) return;  // mistakes of the text are said beside it
    schema = found;
    const focus = groups.contains(document.activeElement) ? document.activeElement.id : "";
    fields = [];
    const tables = new Map([["", {key: "", line: 1, keys: []}]]);
    for (const each of stated.keys) {
      if (each.table) tables.set(each.key, {...each, keys: []});
      else tables.get(each.key.split(".").slice(0, -1).join(".")).keys.push(each);
    }
    groups.replaceChildren(...[...tables.values()].filter((table) => table.key || table.keys.length > 0).map(group), adder("", schema, stated.keys));
    show(remarks);
    if (focus && by_id(focus)) by_id(focus).focus();
  }

  function group(table) {
    const node = table.key ? node_of(schema, table.key) : schema;
    const element = make("details", {class: "group", open: open.has(table.key), ontoggle: () => open[element.open ? "add" : "delete"](table.key)},
      make("summary", {}, table.key || word("top")), ...table.keys.map(field),
      make("div", {class: "row"}, table.key ? adder(table.key, node, table.keys) : null,
        table.key ? remover(table.key) : null));
    fields.push({...table, element, group: element});
    return element;
  }

  function remover(key) {
    return make("button", {type: "button", class: "remove", "aria-label": word("remove_key", {key}), onclick: () => edit({key, edit: "remove", value: ""})}, word("remove"));
  }

  function field(each) {
    const node = node_of(schema, each.key), name = each.key.split(".").pop();
    const id = "form_" + each.key, help = (node && node.description) || "";
    const properties = {id, "aria-describedby": id + "_help", onfocus: () => draft.editor.look_at(each.line),
                        onchange: (event) => edit({key: each.key, edit: "value", value: value_in(event.target, node, each.value)})};
    const beside = make("p", {class: "bad", id: id + "_bad"});
    const element = make("div", {class: "form-field"}, make("label", {for: id}, name), input_of(each.value, node, properties), remover(each.key),
      make("p", {class: "soft", id: id + "_help"}, help.split("\n").filter((line) => !line.startsWith("If left out")).join(". ")), beside);
    fields.push({...each, element, beside});
    return element;
  }

  /// A list of the keys that a table may still have. @param stated  keys that are there
  function adder(key, node, stated) {
    const have = new Set(stated.map((each) => each.key.slice(key ? key.length + 1 : 0).split(".")[0]));
    const choices = node ? keys_in(schema, node).filter(([name]) => !have.has(name) || !key) : [];
    const maps = tables_of(schema, node).some(is_map);
    if (choices.length === 0 && !maps) return null;
    const id = "add_" + key, help = make("p", {class: "soft", id: id + "_help"});
    const select = make("select", {id, "aria-describedby": id + "_help"}, ...choices.map(([name]) => make("option", {value: name}, name)));
    const name = make("input", {id: id + "_name", placeholder: word("name_of_new"), "aria-label": word("name_of_new")});
    const chosen = () => maps && choices.length === 0 ? node : step(schema, node, select.value);
    const renamed = () => {
      name.hidden = !(maps && choices.length === 0) && !is_map(chosen());
      help.textContent = ((chosen() || {}).description || "").split("\n")[0];
    };
    select.addEventListener("change", renamed);
    renamed();
    const add = () => {
      const path = [key, choices.length > 0 ? select.value : "", name.hidden ? "" : name.value.trim()].filter((part) => part).join(".");
      const inner = name.hidden ? chosen() : chosen().additionalProperties;
      if (name.hidden || name.value.trim()) { open.add(path); edit(beginning(schema, path, inner)).then(renew); } else name.focus();
    };
    return make("details", {class: "add"}, make("summary", {}, word("add_to", {key: key || word("definition")})),
      make("div", {class: "row"}, choices.length > 0 ? make("label", {for: id}, word("key_to_add")) : null, choices.length > 0 ? select : null, name,
        make("button", {type: "button", onclick: add}, word("add"))), help);
  }

  function show(all) {
    remarks = all;
    for (const each of fields) {
      if (each.beside) each.beside.textContent = all.filter((remark) => remark.mistake && remark.line === each.line).map((remark) => remark.text).join(" ");
    }
  }

  /// Shows the field of a line of the text, unless the form is being used.
  function go_to(line) {
    if (groups.contains(document.activeElement)) return;
    const at = fields.filter((each) => each.line <= line).sort((a, b) => a.line - b.line).pop();
    fields.forEach((each) => each.element.classList.toggle("here", each === at));
    if (!at) return;
    const around = at.element.closest("details.group");
    if (around) around.open = true;
    groups.scrollTop += at.element.getBoundingClientRect().top - groups.getBoundingClientRect().top - 40;
  }

  const element = make("section", {"aria-labelledby": "form_title"}, make("h2", {id: "form_title"}, word("form")),
    make("div", {class: "row"}, undo, redo), groups, same);
  return {element, renew, show, go_to};
}

/// The means of input that suit a value.
function input_of(value, node, properties) {
  if (takes(node, "boolean") && /^(true|false)$/.test(value)) return make("input", {type: "checkbox", checked: value === "true", ...properties});
  const choices = values_of(node);
  if (choices.length > 0 && choices.includes(value)) {
    return make("select", properties, ...choices.map((each) => make("option", {value: each, selected: each === value}, unquoted(each) || each)));
  }
  if (is_number(value) && node && (node.type === "number" || node.type === "integer")) {
    return make("input", {type: "number", step: node.type === "integer" ? 1 : "any", min: node.minimum, max: node.maximum, value: value.replaceAll("_", ""), ...properties});
  }
  const text = unquoted(value);
  if (value.includes("\n")) {
    const area = make("textarea", {rows: Math.min(8, value.split("\n").length), ...properties});
    area.value = value;
    return area;
  }
  return make("input", {type: "text", value: text === null ? value : text, ...properties});
}
function value_in(input, node, was) {
  if (input.type === "checkbox") return String(input.checked);
  if (input.tagName === "SELECT" || input.tagName === "TEXTAREA" || input.type === "number") return input.value;
  return written(input.value, node, was);
}
