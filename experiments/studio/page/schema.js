"use strict";
// Keys of a definition from the JSON Schema of its protocol.
const schemas = new Map();  // protocol -> a promise of its schema
function schema_of(text) {
  const found = text.match(/^\s*protocol\s*=\s*"(\w+)"/m);
  if (!found) return Promise.resolve(null);
  const protocol = found[1];
  if (!schemas.has(protocol)) {
    schemas.set(protocol, get("/schema", {protocol}).then((answer) => answer.schema, () => null));
  }
  return schemas.get(protocol);
}

/// The tables that may stand at a node: of lists, of alternatives and of what it refers to.
function tables_of(root, node, depth = 0) {
  if (!node || depth > 8) return [];
  const all = node.properties || typeof node.additionalProperties === "object" ? [node] : [];
  const inner = [...(node.anyOf || []), node.items];
  if (node.$ref) inner.push(node.$ref.replace(/^#\//, "").split("/").reduce((at, part) => at && at[part], root));
  return all.concat(...inner.map((each) => tables_of(root, each, depth + 1)));
}

function step(root, node, name) {
  for (const table of tables_of(root, node)) {
    if (table.properties && Object.hasOwn(table.properties, name)) return table.properties[name];
    if (typeof table.additionalProperties === "object") return table.additionalProperties;
  }
  return null;
}
const node_at = (root, path) => path.reduce((node, name) => node && step(root, node, name), root);

/// [name, description] of every key that may stand in a node's tables.
function keys_in(root, node) {
  const found = new Map();
  for (const table of tables_of(root, node)) {
    for (const [name, key] of Object.entries(table.properties || {})) found.set(name, key.description || "");
  }
  return [...found].sort((a, b) => a[0] < b[0] ? -1 : 1);
}

/// Words that a key may have, in quotation marks.
function values_of(node) {
  if (!node) return [];
  const own = (node.enum || []).map((value) => JSON.stringify(value));
  const truth = node.type === "boolean" ? ["true", "false"] : [];
  return own.concat(truth, ...(node.anyOf || []).map(values_of));
}

const parts_of = (dotted) => dotted.split(".").map((part) => part.trim().replace(/^["']|["']$/g, "")).filter((part) => part);

/// Where a place of the text is: tables around it, the key there, and what is being written.
/// @param before  the lines up to the place, the last one cut there
function place_of(before) {
  const line = before[before.length - 1].replace(/"[^"]*"/g, (text) => text.replace(/[{}\[\]=#,]/g, "_"));
  const header = line.match(/^\s*\[\[?\s*([^\]]*)$/);
  if (header) {
    const parts = header[1].split(".");
    return {kind: "table", path: parts_of(parts.slice(0, -1).join(".")), prefix: parts[parts.length - 1].trim()};
  }
  let path = [];
  for (let i = before.length - 2; i >= 0; --i) {
    const table = before[i].match(/^\s*\[\[?\s*([^\]]+?)\s*\]/);
    if (table) { path = parts_of(table[1]); break; }
  }
  const outer = [];  // keys whose inline tables are open
  let key = "", start = 0, in_value = false;
  for (let i = 0; i < line.length; ++i) {
    const c = line[i];
    if (c === "=") { key = line.slice(start, i).trim(); start = i + 1; in_value = true; }
    else if (c === "{") { outer.push(key); start = i + 1; in_value = false; }
    else if (c === "}") { key = outer.pop() || ""; in_value = true; }
    else if (c === "," && outer.length > 0) { start = i + 1; in_value = false; }
  }
  path = path.concat(...outer.map(parts_of));
  const rest = line.slice(start).trimStart();
  return in_value ? {kind: "value", path: path.concat(parts_of(key)), prefix: rest.replace(/^.*[\[,\s]/, "")}
                  : {kind: "key", path, prefix: rest.split(".").pop()};
}
