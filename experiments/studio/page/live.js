"use strict";
// Sessions with participants: who is next, the checklist, the session that runs, and its console.
const kept_choice = {device: "", second: "", window: true, watch: "", language: ""};  // for the next participant

const field = (label, input) => make("label", {class: "field"}, label, input);
const chosen = (value, options) => make("option", {value: options.value, selected: options.value === value}, options.text);
const select = (id, value, options) => make("select", {id}, ...options.map((each) => chosen(value, each)));

/// The part of the view that begins sessions. @param renew  shows the view anew
function next_session(file, study, renew) {
  const section = make("section", {"aria-labelledby": "next_title"}, make("h2", {id: "next_title"}, word("run_next")));
  if (!study.roster || !study.roster.next) {
    section.append(make("p", {class: "bad"}, study.roster && study.roster.failure || word("mend_first")));
    return section;
  }
  const {next, remarks, command} = study.roster;
  if (next.length === 0) section.append(make("p", {class: "soft"}, word("nobody_next")));
  section.append(session_form(file, next, renew), ...remarks.map((remark) => make("p", {lang: "en"}, remark)), command_line(command));
  return section;
}

const words_of_next = (next) => word(next.resume ? "resume_is" : "next_is", {subject: next.subject, n: next.session}) + (next.group ? ", " + word("group", {name: next.group}) : "");

function session_form(file, nexts, renew) {
  const who = select("who", "0", [...nexts.map((next, i) => ({value: String(i), text: words_of_next(next)})), {value: "pilot", text: word("a_pilot")}]);
  const pilot = make("input", {id: "pilot_name", value: "T01", maxlength: "64", pattern: "[A-Za-z0-9_][A-Za-z0-9_\\-]*"});
  const device = select("device", "", []), second = select("second", "", []);
  const shows = make("input", {id: "shows_window", type: "checkbox", checked: kept_choice.window});
  const hand = select("handedness", "", ["", "left", "right", "both"].map((each) => ({value: each, text: each === "" ? word("not_told") : word("hand_" + each)})));
  const consent = make("input", {id: "consent", maxlength: "64", placeholder: "2026-11-28"});
  const language = make("input", {id: "language", maxlength: "20", placeholder: "de", value: kept_choice.language});
  const watch = make("input", {id: "watch", maxlength: "45", placeholder: "192.168.1.20", value: kept_choice.watch, "aria-describedby": "watch_help"});
  const line = make("div", {}), checks = make("div", {id: "checks", "aria-live": "polite"}), begin = make("button", {class: "main", id: "begin", disabled: true}, word("begin_session"));
  const choice = () => {
    Object.assign(kept_choice, {device: device.value, second: second.value, window: shows.checked, watch: watch.value.trim(), language: language.value.trim()});
    const next = nexts[Number(who.value)];
    return {file, subject: next ? next.subject : pilot.value.trim(), session: next ? next.session : 0, resume: Boolean(next && next.resume), pilot: !next,
      devices: [device.value, second.value].filter((each) => each), window: shows.checked, handedness: hand.value, consent: consent.value.trim(), language: language.value.trim(), watch: watch.value.trim()};
  };
  const show_who = () => {
    const next = nexts[Number(who.value)];
    pilot.closest("label").hidden = Boolean(next);
    begin.textContent = word(next && next.resume ? "resume_session" : "begin_session");
    line.replaceChildren(next ? command_line(next.command, word("in_terminal")) : "");
  };
  const form = make("form", {id: "session_form", onsubmit: (event) => { event.preventDefault(); begin_session(choice(), renew); }},
    make("div", {class: "row"}, field(word("who"), who), field(word("pilot_name"), pilot), field(word("device"), device), make("span", {}, shows, " ", make("label", {for: "shows_window"}, word("shows_window")))),
    make("details", {}, make("summary", {}, word("more")), make("div", {class: "row"}, field(word("second"), second), field(word("handedness"), hand), field(word("consent"), consent), field(word("language"), language), field(word("watch"), watch)), make("p", {class: "soft", id: "watch_help"}, word("watch_help"))),
    line, make("div", {class: "row"}, make("button", {type: "button", id: "checklist", onclick: () => show_checklist(checks, choice())}, word("checklist")), begin,
      make("button", {type: "button", id: "card", onclick: () => make_card(checks, choice())}, word("card"))), checks);
  who.addEventListener("change", show_who);
  device.addEventListener("change", () => { if (device.value === "mouse" || device.value === "gamepad") shows.checked = true; });
  show_who();
  by_itself("devices", async () => { await fill_devices(device, second); begin.disabled = false; });
  return form;
}

/// Devices that can be used now; the one of the last session first.
async function fill_devices(device, second) {
  const usable = (await found_devices()).rows.filter(([name, state]) => state === "ready" && name !== "replay").map(([name]) => ({value: name, text: name}));
  const real = usable.find(({value}) => value !== "virtual" && value !== "mouse" && value !== "gamepad");
  const first = kept_choice.device || (real || {value: "mouse"}).value;
  device.replaceChildren(...usable.map((each) => chosen(first, each)));
  second.replaceChildren(...[{value: "", text: word("none")}, ...usable].map((each) => chosen(kept_choice.second, each)));
}

async function show_checklist(place, choice) {
  place.replaceChildren(make("p", {class: "soft"}, word("checking")));
  const found = await attempt(() => post("/checklist", choice));
  if (!found || !place.isConnected) return place.replaceChildren();
  place.replaceChildren(...(found.failure ? [printed(found.failure)] : [
    make("p", {id: "ready", class: found.ready ? "good" : "bad"}, word(found.ready ? "can_begin" : "cannot_begin")),
    state_table(found.checks.map((check) => [check.what, check.state, check.found])), command_line(found.run, word("in_terminal"))]), command_line(found.command));
}

async function make_card(place, choice) {
  const made = await attempt(() => post("/card", choice));
  if (made) place.replaceChildren(make("p", {}, make("a", {id: "open_card", href: address("/file", {file: made.file}), target: "_blank", rel: "noopener"}, word("open_card", {file: made.file}))), command_line(made.command));
}

async function begin_session(choice, renew) {
  const started = await attempt(() => post("/begin", choice));
  if (!started) return;
  say(word("started", {command: started.command}));
  await renew();
}

/// The session that runs, or the last one of this studio; shown again and again while it runs.
function live_session(renew) {
  const section = make("section", {id: "live", hidden: true, "aria-labelledby": "live_title"});
  const state = make("span", {id: "live_state", role: "status"}), time = make("span", {class: "n soft"});
  const open = make("a", {id: "open_console", class: "button main", target: "_blank", rel: "noopener noreferrer"}, word("open_console"));
  const end = make("button", {type: "button", id: "end_session", onclick: () => end_session(section.job)}, word("end_session"));
  const watch = make("p", {id: "watch_at"}), line = make("div", {}), output = printed("", "live_output");
  section.append(make("h2", {id: "live_title"}, word("live")), make("div", {class: "row"}, state, time, open, end), make("p", {class: "soft", id: "console_help"}, word("console_help")), watch, line, output);
  let ran = false;
  const look = () => by_itself("session", async () => {
    const session = await get("/session");
    if (session.job === null || !section.isConnected) return;
    const runs = session.state === "running";
    section.hidden = false;
    section.job = session.job;
    state.textContent = session.study + ": " + word(session.state === "cancelled" || session.state === "failed" ? "session_" + session.state : session.state);
    state.className = runs ? "good" : session.state === "done" ? "" : "bad";
    time.textContent = word("seconds", {n: session.seconds.toFixed(0)});
    output.textContent = session.output;
    end.hidden = by_id("console_help").hidden = !runs;
    show_console(open, session.console);
    watch.hidden = !session.watch;
    watch.replaceChildren(word("watch_at"), " ", make("code", {}, session.watch));
    if (!line.firstChild) line.append(command_line(session.command, word("in_terminal")));
    if (runs) section.timer = setTimeout(look, 500);
    else if (ran) await renew();
    ran = runs;
  });
  look();
  return section;
}

/// The link gets the focus when it appears: the console is where the session is led.
function show_console(link, url) {
  const appears = link.hidden !== false && url;
  link.hidden = !url;
  if (!url) return link.removeAttribute("href");
  if (link.href !== url) link.href = url;
  if (appears && (document.activeElement === document.body || document.activeElement === by_id("main"))) link.focus();
}

function end_session(job) {
  const dialog = make("dialog", {"aria-labelledby": "end_title"}, make("h2", {id: "end_title"}, word("end_session")), make("p", {}, word("end_help")),
    make("div", {class: "row"}, make("button", {type: "button", autofocus: true, onclick: () => dialog.close()}, word("cancel")),
      make("button", {type: "button", class: "main", id: "really_end", onclick: () => { dialog.close(); attempt(() => post("/cancel", {job})); }}, word("end_session"))));
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}

/// Lists what a withdrawal deletes; deletes it once the identifier was typed.
async function ask_withdrawal(file, subject, renew) {
  const found = await post("/withdraw", {file, subject, sure: false});
  const typed = make("input", {id: "withdrawn", autocomplete: "off"});
  const dialog = make("dialog", {"aria-labelledby": "withdraw_title"}, make("h2", {id: "withdraw_title"}, word("withdraw_of", {subject})),
    make("p", {}, word("withdraw_help")), printed(found.output), command_line(found.command),
    make("form", {method: "dialog"}, make("label", {}, word("type_to_delete", {subject}), typed),
      make("div", {class: "row"}, make("button", {type: "button", class: "bad", id: "withdraw_now", onclick: () => attempt(async () => {
        if (typed.value !== subject) return typed.focus();
        const done = await post("/withdraw", {file, subject, sure: true});
        dialog.close();
        await renew();
        say(done.output.trim().split("\n").pop());
      })}, word("delete_files")), make("button", {type: "button", onclick: () => dialog.close()}, word("cancel")))));
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}

/// The sessions that each participant has had, as the roster has them.
function participant_table(study, file, renew) {
  const persons = study.roster && study.roster.participants || [];
  const marks = (person) => [person.pilot && word("pilot"), person.simulated && word("simulated"), person.excluded && word("excluded")].filter((each) => each).join(", ");
  return persons.length === 0 ? make("p", {class: "soft"}, word("no_sessions")) : table([word("participant"), word("group_title"), word("sessions"), word("note"), word("withdraw")],
    persons.map((person) => row(person.subject, person.group || "\u2013", make("td", {}, ...person.sessions.map((each) => make("div", {class: each.state === "done" ? "good" : "bad"},
      word("session_is", {n: each.session, state: word("roster_" + each.state), trials: each.trials})))), marks(person),
      make("button", {type: "button", class: "remove", "aria-label": word("withdraw_of", {subject: person.subject}), onclick: () => attempt(() => ask_withdrawal(file, person.subject, renew))}, word("withdraw")))));
}
