"use strict";
// Sessions and results: what the commands wrote.
async function show_sessions(main, file) {
  main.append(make("h1", {}, file));
  const [held, study] = await Promise.all([get("/sessions", {file}), get("/study", {file})]);
  main.append(next_session(study));
  const parts = [[word("with_people"), held.folders.filter((each) => !each.rehearsal)], [word("rehearsals"), held.folders.filter((each) => each.rehearsal)]];
  parts.forEach(([title, folders], i) => {
    main.append(make("section", {"aria-labelledby": "part_" + i}, make("h2", {id: "part_" + i}, title),
      ...(folders.length === 0 ? [make("p", {class: "soft"}, word("no_sessions"))] : folders.map(session_table))));
  });
}

function next_session(study) {
  const section = make("section", {"aria-labelledby": "next_title"}, make("h2", {id: "next_title"}, word("run_next")));
  if (!study.roster || !study.roster.next) {
    section.append(make("p", {class: "bad"}, study.roster && study.roster.failure || word("mend_first")));
    return section;
  }
  for (const next of study.roster.next) {
    section.append(make("p", {}, word("next_is", {subject: next.subject, n: next.session}) + (next.group ? ", " + word("group", {name: next.group}) : "")), command_line(next.command, word("in_terminal")));
  }
  section.append(make("p", {class: "soft"}, study.roster.next.length > 0 ? word("run_help") : word("nobody_next")),
    ...study.roster.remarks.map((remark) => make("p", {lang: "en"}, remark)), command_line(study.roster.command));
  return section;
}

const size_of = (bytes) => bytes < 1e6 ? (bytes / 1e3).toFixed(0) + " kB" : (bytes / 1e6).toFixed(1) + " MB";
const time_of = (milliseconds) => new Date(milliseconds).toLocaleString(kLanguage);

function session_table(folder) {
  const shown = make("div", {"aria-live": "polite"});
  const show = (name) => attempt(async () => {
    const info = await get("/info", {file: folder.folder + "/" + name});
    shown.replaceChildren(make("h3", {}, word("info_of", {file: name})), printed(info.output), command_line(info.command));
  });
  return make("div", {}, make("h3", {}, folder.folder), table([word("file"), word("size"), word("changed"), ""],
    folder.sessions.map((each) => row(each.name, make("td", {}, size_of(each.bytes)), time_of(each.modified),
      make("button", {type: "button", "aria-label": word("info_of", {file: each.name}), onclick: () => show(each.name)}, word("show"))))), shown);
}

async function show_results(main, file, folder) {
  main.append(make("h1", {}, file));
  const held = await get("/sessions", {file});
  const named = held.folders.filter((each) => each.sessions.length > 0 || each.report);
  if (named.length === 0) main.append(make("section", {}, make("p", {class: "soft"}, word("no_sessions"))));
  const chosen = folder || (named.find((each) => each.report) || {}).folder;
  for (const each of named) main.append(result_section(file, each, each.folder === chosen));
}

/// A folder's report and files; the report is shown only where it was chosen.
function result_section(file, folder, chosen) {
  const of_file = (name, query = {}) => address("/file", {file: folder.folder + "/" + name, ...query});
  const section = make("section", {"aria-label": word("folder_of", {folder: folder.folder})}, make("h2", {}, folder.folder),
    make("p", {class: folder.report_is_old ? "bad" : "soft"}, word(!folder.report ? "no_report" : folder.report_is_old ? "old_report" : "new_report")));
  section.append(make("div", {class: "row"}, folder.sessions.length > 0 ? analyze_button(file, folder.folder) : null,
    folder.report ? make("a", {href: of_file("report.html"), target: "_blank", rel: "noopener"}, word("open_report")) : null,
    folder.report && !chosen ? report_link(file, folder.folder) : null), command_line("haptrial analyze " + folder.folder));
  if (folder.results.length > 0) {
    section.append(make("details", {}, make("summary", {}, word("files")), make("ul", {class: "files"},
      ...folder.results.map((each) => make("li", {}, make("a", {href: of_file(each.name, {download: "1"}), download: each.name}, each.name), " ", make("span", {class: "soft"}, size_of(each.bytes)))))));
  }
  if (folder.report && chosen) section.append(make("iframe", {id: "report", title: word("report_frame", {folder: folder.folder}), sandbox: "", src: of_file("report.html")}));
  return section;
}
