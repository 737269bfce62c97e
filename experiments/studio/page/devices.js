"use strict";
// Devices of this computer, and what a test of one reads from it.
let devices_found = null;  // kept, since looking takes a second
const found_devices = (again = false) => {
  if (again || !devices_found) devices_found = get("/devices").catch((error) => { devices_found = null; throw error; });
  return devices_found;
};

const state_mark = (name) => make("span", {class: name === "ready" ? "good" : ["broken", "limited", "missing"].includes(name.toLowerCase()) ? "bad" : "soft"}, name);
/// Rows of what was looked at, its state, and what was found.
const state_table = (rows, more = () => []) => table([word("part"), word("state"), word("found"), ...more().map((each) => each.name)],
  rows.map((each) => row(each[0], make("td", {class: "state"}, state_mark(each[1])), make("td", {lang: "en"}, each[2]), ...more(each).map((cell) => cell.cell))));

async function fill_devices_section(section, again = false) {
  const look = () => found_devices(again);
  const found = await (again ? attempt(look) : by_itself("devices", look));
  if (!found || !section.isConnected) return;
  const reading = make("div", {id: "device_reading"});
  const button = (each, what, act) => ({name: word(what), cell: each && each[1] === "ready" && each[0] !== "replay" ? make("button", {type: "button", id: what + "_" + each[0], "aria-label": word(what) + ": " + each[0], onclick: act}, word(what)) : ""});
  const test = (each) => [button(each, "read", () => follow_device(reading, "/read_device", {device: each[0], seconds: 20})),
    button(each, "test", () => follow_device(reading, "/device_test", {device: each[0], seconds: 5}))];
  section.replaceChildren(make("h2", {id: "devices_title"}, word("devices")), make("details", {open: again}, make("summary", {}, word("ready_are", {names: found.rows.filter((each) => each[1] === "ready").map((each) => each[0]).join(", ")})),
    state_table(found.rows, test), await channel_row(reading), reading), command_line(found.command), make("button", {type: "button", onclick: () => fill_devices_section(section, true)}, word("check_again")));
}

/// Reads the channels of one of the folder's definitions.
async function channel_row(reading) {
  const files = (await get("/studies")).files;
  if (files.length === 0) return null;
  const study = make("select", {id: "channels_of"}, ...files.map((file) => make("option", {}, file)));
  return make("div", {class: "row"}, make("label", {for: "channels_of"}, word("channels_of")), study,
    make("button", {type: "button", id: "read_channels", onclick: () => follow_device(reading, "/read_channels", {file: study.value, seconds: 20})}, word("read")));
}

/// Shows what a command prints while it reads a device or channels.
async function follow_device(place, path, body) {
  const started = await attempt(() => post(path, body));
  if (!started) return;
  const output = printed("", "device_output"), state = make("p", {role: "status", id: "device_state"}, word("running"));
  const stop = make("button", {type: "button", id: "stop_reading", onclick: () => attempt(() => post("/cancel", {job: started.job}))}, word("stop"));
  place.replaceChildren(command_line(started.command), make("div", {class: "row"}, state, stop), output);
  const look = () => by_itself("reading", async () => {
    const job = (await get("/jobs")).jobs.find((each) => each.job === started.job);
    output.textContent = (await get("/job", {job: started.job})).output;
    output.scrollTop = output.scrollHeight;
    state.textContent = word(job.state);
    stop.hidden = job.state !== "running";
    if (job.state === "running" && place.isConnected) setTimeout(look, 400);
  });
  await look();
}
