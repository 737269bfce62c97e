"use strict";
// Rehearse: dry runs and analyses as jobs of the studio, which go on while pages come and go.
const opened_jobs = new Set();  // whose output is unfolded

async function show_rehearse(main, file) {
  const subjects = make("input", {id: "subjects", type: "number", min: "1", max: "10000", value: "2", required: true});
  const setup = make("input", {id: "setup", type: "number", min: "0", max: "600", "aria-describedby": "setup_help"});
  main.append(make("h1", {}, file), make("section", {"aria-labelledby": "rehearse_title"}, make("h2", {id: "rehearse_title"}, word("rehearse")),
    make("p", {}, word("rehearse_help")),
    make("form", {class: "row", onsubmit: start}, make("label", {for: "subjects"}, word("virtual")), subjects,
      make("label", {for: "setup"}, word("setup")), setup, make("button", {class: "main", id: "rehearse"}, word("start"))), make("p", {class: "soft", id: "setup_help"}, word("setup_help"))));
  main.append(make("section", {"aria-labelledby": "power_title"}, make("h2", {id: "power_title"}, word("power")), make("p", {}, word("power_help")),
    make("button", {type: "button", id: "power", onclick: () => begin_job("/power", {file})}, word("start"))));
  main.append(make("section", {"aria-labelledby": "plan_title"}, make("h2", {id: "plan_title"}, word("preregistration")), make("p", {}, word("preregistration_help")),
    make("button", {type: "button", id: "plan", onclick: () => begin_job("/plan", {file})}, word("start"))));
  const list = make("div", {id: "jobs"});
  main.append(make("section", {"aria-labelledby": "jobs_title"}, make("h2", {id: "jobs_title"}, word("jobs")), list));
  async function start(event) {
    event.preventDefault();
    await begin_job("/rehearse", {file, subjects: Number(subjects.value), ...(setup.value === "" ? {} : {setup: Number(setup.value)})});
  }
  async function begin_job(path, choice) {
    await attempt(async () => {
      const started = await post(path, choice);
      opened_jobs.add(started.job);
      say(word("started", {command: started.command}));
      await watch_jobs(list);
    });
  }
  await watch_jobs(list);
}

/// Shows the jobs, again and again while one of them runs and the list is in the page.
async function watch_jobs(list) {
  clearTimeout(list.timer);
  const jobs = (await get("/jobs")).jobs.filter((job) => !job.live);
  if (!list.isConnected) return;
  list.firstElementChild && jobs.length > 0 || list.replaceChildren(jobs.length === 0 ? make("p", {class: "soft"}, word("no_jobs")) : "");
  for (const job of jobs) await show_job(list, job);
  if (jobs.some((job) => job.state === "running")) {
    list.timer = setTimeout(() => by_itself("jobs", () => watch_jobs(list)), 400);
  }
}

async function show_job(list, job) {
  const id = "job_" + job.job;
  let card = by_id(id);
  if (!card) {
    card = job_card(list, job, id);
    list.prepend(card.element);
    list.querySelectorAll("p.soft.none").forEach((each) => each.remove());
  } else {
    card = card.parts;
  }
  if (card.shown !== job.state + job.bytes + job.written) {
    const ended = card.state === "running" && job.state !== "running";
    card.shown = job.state + job.bytes + job.written;
    card.state = job.state;
    show_state(card, job);
    if (card.details.open) await card.read();
    if (ended) say(word("ended", {state: word(job.state), command: job.command}));
  }
  const left = job.state === "running" && job.written > 0 ? job.seconds * (job.sessions - job.written) / job.written : 0;
  card.time.textContent = word("seconds", {n: job.seconds.toFixed(1)}) + (left > 0 ? word("seconds_left", {n: left.toFixed(0)}) : "");
}

function job_card(list, job, id) {
  const output = printed("", id + "_output");
  const card = {state: job.state, shown: "", stateText: make("span", {id: id + "_state", role: "status"}), time: make("span", {class: "n soft"}),
    bar: make("progress", {"aria-label": job.command, max: "1"}), count: make("span", {class: "soft"}), cost: make("p", {class: "cost", lang: "en"}), actions: make("span", {class: "row"})};
  card.read = async () => { output.textContent = (await get("/job", {job: job.job})).output; output.scrollTop = output.scrollHeight; };
  card.details = make("details", {open: opened_jobs.has(job.job), ontoggle: () => {
    card.details.open ? opened_jobs.add(job.job) : opened_jobs.delete(job.job);
    if (card.details.open) by_itself("output", card.read);
  }}, make("summary", {}, word("output")), output);
  card.cancel = make("button", {type: "button", id: id + "_cancel", onclick: () => attempt(async () => { await post("/cancel", {job: job.job}); await watch_jobs(list); })}, word("stop"));
  card.element = make("section", {id, "aria-label": word("job") + " " + job.job}, make("div", {class: "row"}, card.stateText, card.time, card.bar, card.count, card.cancel, card.actions),
    card.cost, command_line(job.command), card.details);
  card.element.parts = card;
  card.list = list;
  return card;
}

function show_state(card, job) {
  card.stateText.textContent = word(job.state);
  card.stateText.className = job.state === "done" ? "good" : job.state === "running" ? "" : "bad";
  card.cancel.hidden = job.state !== "running";
  card.bar.hidden = job.state !== "running";
  if (job.sessions > 0) {
    card.bar.value = job.written / job.sessions;
    card.count.textContent = word("sessions_of", {n: job.written, all: job.sessions});
  }
  if (job.state === "done") by_itself("cost", async () => { card.cost.textContent = ((await get("/job", {job: job.job})).output.match(/^lab time: .*$|^.* hours of sessions$/m) || [""])[0]; });
  if (job.state === "done") card.actions.replaceChildren(...(job.sessions > 0 ? [analyze_button(job.study, job.folder, card.list)] : job.folder ? [report_of(job)] : []));
}

/// A simulated study has no sessions that another view would show.
const report_of = (job) => / power simulate /.test(job.command) ? make("a", {class: "report", href: address("/file", {file: job.folder + "/report.html"}), target: "_blank", rel: "noopener"}, word("show_report")) : report_link(job.study, job.folder);
const report_link = (file, folder) => make("a", {class: "report", href: "#" + ["results", file, folder].map(encodeURIComponent).join("/")}, word("show_report"));
/// Starts an analysis; @param list  of jobs to be shown anew, if the page has one
function analyze_button(file, folder, list) {
  return make("button", {type: "button", class: "analyze", onclick: () => attempt(async () => {
    const started = await post("/analyze", {file, folder});
    opened_jobs.add(started.job);
    say(word("started", {command: started.command}));
    if (list) await watch_jobs(list);
    else location.hash = "#rehearse/" + encodeURIComponent(file);
  })}, word("analyze"));
}
