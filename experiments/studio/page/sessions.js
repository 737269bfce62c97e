"use strict";
// Sessions and results: what the commands wrote.
async function show_sessions(main, file) {
  main.append(make("h1", {}, file));
  const [held, study] = await Promise.all([get("/sessions", {file}), get("/study", {file})]);
  const renew = () => shown === "#sessions/" + encodeURIComponent(file) ? show_view() : undefined;
  main.append(live_session(renew), next_session(file, study, renew),
    make("section", {"aria-labelledby": "persons_title"}, make("h2", {id: "persons_title"}, word("participants")), participant_table(study, file, renew),
      study.roster && study.roster.to_come ? make("p", {lang: "en"}, "To come: " + study.roster.to_come) : null));
  const parts = [[word("with_people"), held.folders.filter((each) => !each.rehearsal)], [word("rehearsals"), held.folders.filter((each) => each.rehearsal)]];
  parts.forEach(([title, folders], i) => {
    main.append(make("section", {"aria-labelledby": "part_" + i}, make("h2", {id: "part_" + i}, title),
      ...(folders.length === 0 ? [make("p", {class: "soft"}, word("no_sessions"))] : folders.map(session_table))));
  });
}

const size_of = (bytes) => bytes < 1e6 ? (bytes / 1e3).toFixed(0) + " kB" : (bytes / 1e6).toFixed(1) + " MB";
const time_of = (milliseconds) => new Date(milliseconds).toLocaleString(kLanguage);

function session_table(folder) {
  const shown = make("div", {"aria-live": "polite"});
  const show = (name) => attempt(async () => {
    const info = await get("/info", {file: folder.folder + "/" + name});
    shown.replaceChildren(make("h3", {}, word("info_of", {file: name})), printed(info.output), command_line(info.command));
  });
  return make("div", {}, make("h3", {}, folder.folder), table([word("file"), word("size"), word("changed"), word("show")],
    folder.sessions.map((each) => row(each.name, make("td", {}, size_of(each.bytes)), time_of(each.modified),
      make("button", {type: "button", "aria-label": word("show") + ": " + each.name, onclick: () => show(each.name)}, word("show"))))), shown);
}

async function show_results(main, file, folder) {
  main.append(make("h1", {}, file));
  const held = await get("/sessions", {file});
  const named = held.folders.filter((each) => each.sessions.length > 0 || each.report);
  if (named.length === 0) main.append(make("section", {}, make("p", {class: "soft"}, word("no_sessions"))));
  const chosen = folder || (named.find((each) => each.report) || named[0] || {}).folder;
  for (const each of named) main.append(result_section(file, each, each.folder === chosen));
  for (const each of held.exports) main.append(export_section(each));
}

const file_list = (folder, files) => make("ul", {class: "files"}, ...files.map((each) => make("li", {},
  make("a", {href: address("/file", {file: folder + "/" + each.name, download: "1"}), download: each.name}, each.name), " ", make("span", {class: "soft"}, size_of(each.bytes)))));

/// A folder's report and files; the report is shown only where it was chosen.
function result_section(file, folder, chosen) {
  const of_file = (name, query = {}) => address("/file", {file: folder.folder + "/" + name, ...query});
  const section = make("section", {"aria-label": word("folder_of", {folder: folder.folder})}, make("h2", {}, folder.folder),
    make("p", {class: folder.report_is_old ? "bad" : "soft"}, word(!folder.report ? "no_report" : folder.report_is_old ? "old_report" : "new_report")));
  section.append(make("div", {class: "row"}, folder.sessions.length > 0 ? analyze_button(file, folder.folder) : null,
    folder.report ? make("a", {href: of_file("report.html"), target: "_blank", rel: "noopener"}, word("open_report")) : null,
    folder.report && !chosen ? report_link(file, folder.folder) : null), command_line("haptrial analyze " + folder.folder));
  if (folder.sessions.length > 0) section.append(hand_over_row(file, folder.folder));
  by_itself("remarks", () => fill_remarks(section, folder));
  if (chosen) section.append(quality_section(folder));
  if (folder.results.length > 0) {
    section.append(make("details", {}, make("summary", {}, word("files")), file_list(folder.folder, folder.results)));
  }
  if (folder.report && chosen) section.append(make("iframe", {id: "report", title: word("report_frame", {folder: folder.folder}), sandbox: "", src: of_file("report.html")}));
  return section;
}
