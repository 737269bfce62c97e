"use strict";
// Home: the studies of the folder, shipped experiments, the machine.
async function show_home(main) {
  const studies = await get("/studies");
  by_id("folder").textContent = studies.folder;
  main.append(make("h1", {}, word("home")));
  const rows = studies.files.map((file) => study_row(file));
  main.append(make("section", {"aria-label": word("home")}, studies.files.length === 0
    ? make("p", {id: "no_studies"}, word("no_studies"))
    : table([word("study"), word("state"), word("participants"), word("next"), word("last"), word("report")], rows.map((each) => each.row))));
  const gallery = make("section", {"aria-labelledby": "gallery_title"}, make("h2", {id: "gallery_title"}, word("gallery")));
  const machine = make("section", {"aria-labelledby": "machine_title"}, make("h2", {id: "machine_title"}, word("machine")), make("p", {class: "soft"}, word("checking")));
  const devices = make("section", {"aria-labelledby": "devices_title"}, make("h2", {id: "devices_title"}, word("devices")), make("p", {class: "soft"}, word("checking")));
  main.append(gallery, devices, machine);
  by_itself("gallery", () => fill_gallery(gallery));
  fill_rows(rows).then(() => fill_devices_section(devices)).then(() => fill_machine(machine));
}

function study_row(file) {
  const cells = Array.from({length: 5}, () => make("td", {}));
  cells[0].append(make("span", {class: "soft"}, word("checking")));
  return {file, cells, row: make("tr", {}, make("td", {}, link_to("definition", file, file)), ...cells)};
}

/// One after the other: each asks for commands.
async function fill_rows(rows) {
  for (const each of rows) {
    if (!each.row.isConnected) return;
    try {
      fill_row(each, await get("/study", {file: each.file}));
    } catch (error) {
      each.cells[0].replaceChildren(make("span", {class: "bad"}, error.message));
    }
  }
}

function fill_row({file, cells}, study) {
  const mistakes = study.remarks.filter((remark) => remark.mistake);
  const warnings = study.remarks.length - mistakes.length;
  const groups = study.roster && study.roster.groups || [];
  const sum = (name) => groups.reduce((all, group) => all + group[name], 0);
  const done = sum("finished"), planned = sum("planned");
  const state = !study.valid ? word("draft", {n: mistakes.length}) : study.sessions === 0 ? word("ready")
    : done >= planned && planned > 0 ? word("all_done") : word("under_way", {done, all: planned});
  cells[0].replaceChildren(make("span", {class: study.valid ? "good" : "bad", title: study.command}, state),
    warnings > 0 ? make("div", {class: "soft"}, word("warnings", {n: warnings})) : "",
    study.roster && study.roster.failure ? make("div", {class: "bad", lang: "en"}, study.roster.failure) : "");
  cells[1].replaceChildren(...groups.map((group) => make("div", {}, (group.name ? group.name + ": " : "") + group.finished + " / " + group.planned)));
  const next = study.roster && study.roster.next && study.roster.next[0];
  if (next) cells[2].replaceChildren(next.subject, next.group ? make("div", {class: "soft"}, word("group", {name: next.group})) : "", make("div", {}, link_to("sessions", file, word("sessions"))));
  if (study.last_event) cells[3].replaceChildren(make("span", {lang: "en"}, study.last_event.text), make("div", {class: "soft"}, study.last_event.file));
  cells[4].replaceChildren(link_to("results", file, word("report_" + study.report), study.report === "old" ? {class: "bad"} : {}));
}

async function fill_gallery(gallery) {
  const examples = await get("/examples");
  gallery.append(make("ul", {class: "cards"}, ...examples.rows.map(([name, protocol, what]) => make("li", {},
    make("h3", {}, name), make("div", {class: "soft"}, protocol), make("p", {lang: "en"}, what),
    make("button", {type: "button", id: "begin_" + name, "aria-label": word("begin") + ": " + name, onclick: () => begin(name)}, word("begin"))))));
  gallery.append(command_line(examples.command));
}

/// Asks for the name of a new study and begins it.
function begin(from) {
  const name = make("input", {id: "new_name", required: true, pattern: "[A-Za-z0-9_][A-Za-z0-9_\\-]*", maxlength: "100", autocomplete: "off", "aria-describedby": "new_help"});
  const wrong = make("p", {class: "bad", role: "alert", lang: "en"});
  const dialog = make("dialog", {"aria-labelledby": "new_title"}, make("h2", {id: "new_title"}, word("begin_of", {name: from})),
    make("form", {id: "new_form", onsubmit: create}, make("label", {}, word("name"), name), make("p", {class: "soft", id: "new_help"}, word("name_help")), wrong,
      make("div", {class: "row"}, make("button", {class: "main", id: "create"}, word("create")), make("button", {type: "button", onclick: () => dialog.close()}, word("cancel")))));
  async function create(event) {
    event.preventDefault();
    try {
      const made = await post("/new", {name: name.value, from});
      dialog.close();
      location.hash = "#definition/" + encodeURIComponent(made.file);
    } catch (error) {
      wrong.textContent = error.message;
    }
  }
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}

let machine_found = null;  // kept, since the check takes seconds
async function fill_machine(section, again = false) {
  if (!section.isConnected) return;
  if (again) machine_found = null;
  machine_found = machine_found || get("/machine");
  try {
    const found = await machine_found;
    section.replaceChildren(make("h2", {id: "machine_title"}, word("machine")),
      make("p", {class: found.fit ? "good" : "bad", id: "verdict", lang: "en"}, found.verdict),
      make("details", {}, make("summary", {}, word("found")), state_table(found.rows)),
      command_line(found.command), make("button", {type: "button", onclick: () => fill_machine(section, true)}, word("check_again")));
  } catch (error) {
    section.append(make("p", {class: "bad"}, error.message));
  }
}
