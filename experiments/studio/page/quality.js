"use strict";
// How well each session was recorded, what changed between them, and files for other programs.
const kEvents = /^(aborted|interrupted|notice|emergency_stop|session_stopped|overruns|problem|definition_changed|consent_declined|repaired|recovered|ended_for_good)\b/;

/// A row for each session file, filled one after the other: each asks for a command.
function quality_section(folder) {
  const cells = folder.sessions.map(() => Array.from({length: 5}, () => make("td", {lang: "en"})));
  const section = make("section", {"aria-labelledby": "quality_title"}, make("h2", {id: "quality_title"}, word("quality")),
    table([word("participant"), word("trials"), word("passes"), word("loop"), word("recording"), word("events")], folder.sessions.map((each, i) => row(each.name.replace(/\.h5$/, ""), ...cells[i]))),
    folder.sessions.length > 0 ? command_line("haptrial info " + folder.folder + "/" + folder.sessions[0].name) : "");
  (async () => {
    for (const [i, each] of folder.sessions.entries()) {
      if (i > 0 && !section.isConnected) return;
      try {
        fill_quality(cells[i], await get("/info", {file: folder.folder + "/" + each.name}));
      } catch (error) {
        cells[i][0].replaceChildren(make("span", {class: "bad"}, error.message));
      }
    }
  })();
  return section;
}

function fill_quality(cells, info) {
  const lines = info.output.split("\n");
  const of = (name) => lines.filter((line) => line.startsWith(name + " ")).map((line) => line.slice(name.length).trim());
  const show = (cell, texts, bad) => cell.replaceChildren(...texts.map((text) => make("div", {class: bad ? "bad" : ""}, text)));
  show(cells[0], of("trials"), false);
  show(cells[1], of("passes"), false);
  show(cells[2], [...of("loop"), ...of("lateness")], of("loop").some((text) => text.startsWith("NOT")));
  show(cells[3], of("recording"), !info.complete);
  show(cells[4], lines.filter((line) => kEvents.test(line)), false);
}

/// What the analysis says of the study as a whole, such as keys that changed between sessions.
async function fill_remarks(section, folder) {
  if (!folder.results.some((each) => each.name === "results.json")) return;
  const {remarks} = await answer_of(fetch(address("/file", {file: folder.folder + "/results.json"})));
  if (remarks && remarks.length > 0) section.append(make("h3", {}, word("remarks")), make("ul", {id: "study_remarks", lang: "en"}, ...remarks.map((each) => make("li", {}, each))));
}

/// Buttons that write a folder in other formats, as jobs.
function hand_over_row(file, folder) {
  return make("div", {class: "row"}, make("span", {class: "soft"}, word("write_as")), ...["csv", "bids", "pdf"].map((format) => make("button", {type: "button", class: "write_" + format, onclick: () => attempt(async () => {
    const started = await post("/hand_over", {file, folder, format});
    opened_jobs.add(started.job);
    say(word("started", {command: started.command}));
    location.hash = "#rehearse/" + encodeURIComponent(file);
  })}, word("as_" + format))));
}

function export_section(each) {
  return make("section", {"aria-label": word("written_to", {folder: each.folder})}, make("h2", {}, word("written_to", {folder: each.folder})), file_list(each.folder, each.files));
}
