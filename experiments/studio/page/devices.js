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
  const found = await attempt(() => found_devices(again));
  if (!found || !section.isConnected) return;
  const reading = make("div", {id: "device_reading"});
  const test = (each) => [{name: word("test"), cell: each && each[1] === "ready" && each[0] !== "replay" ? make("button", {type: "button", id: "test_" + each[0], "aria-label": word("test") + ": " + each[0], onclick: () => test_device(reading, each[0])}, word("test")) : ""}];
  section.replaceChildren(make("h2", {id: "devices_title"}, word("devices")), make("details", {open: again}, make("summary", {}, word("ready_are", {names: found.rows.filter((each) => each[1] === "ready").map((each) => each[0]).join(", ")})),
    state_table(found.rows, test), reading), command_line(found.command), make("button", {type: "button", onclick: () => fill_devices_section(section, true)}, word("check_again")));
}

/// Shows what the test prints while it reads the device.
async function test_device(place, device) {
  const started = await attempt(() => post("/device_test", {device, seconds: 5}));
  if (!started) return;
  const output = printed("", "device_output"), state = make("p", {role: "status", id: "device_state"}, word("running"));
  place.replaceChildren(command_line(started.command), state, output);
  const look = () => attempt(async () => {
    const job = (await get("/jobs")).jobs.find((each) => each.job === started.job);
    output.textContent = (await get("/job", {job: started.job})).output;
    state.textContent = word(job.state);
    if (job.state === "running" && place.isConnected) setTimeout(look, 400);
  });
  await look();
}
