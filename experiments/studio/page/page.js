"use strict";
// What every view uses: requests, elements, the command line of what is shown.
const kToken = new URLSearchParams(location.search).get("token") || "";
const kNonce = document.currentScript.nonce;
const by_id = (id) => document.getElementById(id);

/// An element; texts become text, never markup.
function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

const address = (path, query = {}) => path + "?" + new URLSearchParams({...query, token: kToken});

async function answer_of(request) {
  let answer;
  try {
    answer = await request;
  } catch {
    throw new Error(word("gone"));
  }
  if (!answer.ok) throw new Error((await answer.text()).trim());
  return answer.json();
}
const get = (path, query) => answer_of(fetch(address(path, query)));
const post = (path, body) => answer_of(fetch(path, {
  method: "POST", body: JSON.stringify(body),
  headers: {"Content-Type": "application/json", "X-Haptrial-Token": kToken},
}));

function say(text) { by_id("said").textContent = text; clearTimeout(say.timer); say.timer = setTimeout(() => { by_id("said").textContent = ""; }, 4000); }
let failed = "";  // what the sentence in "trouble" is about; "": none is shown
function show_trouble(error, what) {
  failed = error ? what : "";
  by_id("trouble").textContent = error ? error.message : "";
  by_id("trouble").hidden = !error;
}
const kRequest = "request";  // of the user
/// Runs what the user asked for; a failure is shown as its sentence until the user asks for more.
async function attempt(work) {
  show_trouble(null);
  try {
    return await work();
  } catch (error) {
    show_trouble(error, kRequest);
    return undefined;
  }
}
/// Runs what the page does by itself: it takes back its own sentence alone, and never the one that
/// the user's request was answered with.
async function by_itself(what, work) {
  try {
    const result = await work();
    if (failed === what) show_trouble(null);
    return result;
  } catch (error) {
    if (failed !== kRequest) show_trouble(error, what);
    return undefined;
  }
}

/// The command line that does what is shown.
function command_line(command, label = word("same")) {
  return make("div", {class: "command"}, make("span", {}, label), make("code", {lang: "en"}, command),
    make("button", {type: "button", "aria-label": word("copy") + ": " + command, onclick: () => copy(command)}, word("copy")));
}
async function copy(text) {
  await attempt(async () => { await navigator.clipboard.writeText(text); say(word("copied")); });
}

function table(names, rows) {
  return make("div", {class: "scroll"}, make("table", {},
    make("thead", {}, make("tr", {}, ...names.map((name) => make("th", {scope: "col"}, name)))),
    make("tbody", {}, ...rows)));
}
const row = (...cells) => make("tr", {}, ...cells.map((cell) => cell instanceof Node && cell.tagName === "TD" ? cell : make("td", {}, cell)));
const printed = (text, id) => make("pre", {lang: "en", tabindex: "0", ...(id ? {id} : {})}, text);
const link_to = (view, file, text, more = {}) => make("a", {href: "#" + [view, file].filter((part) => part).map(encodeURIComponent).join("/"), ...more}, text);
