"use strict";
// Try it: the pointer as the hand of a trial. Places go to `haptrial show --try`, which runs the
// servo loop with the mouse device; hand and force that come back are drawn. No physics here.

const kPanels = [{title: "x, y", up: 1, sign: -1}, {title: "x, z", up: 2, sign: 1}];
const kPanelSide = 420, kNewtonPixels = 30;

/// @param trial  the field with the number of the trial
function try_part(file, trial) {
  const state = make("span", {role: "status"});
  const start = make("button", {type: "button", id: "try_start", onclick: () => attempt(begin)}, word("try_it"));
  const stop = make("button", {type: "button", id: "try_stop", onclick: () => end()}, word("stop"));
  const stages = make("select", {id: "try_stage", onchange: () => waiting.push("stage " + stages.value)});
  const canvas = make("canvas", {id: "try_canvas", width: 2 * kPanelSide + 20, height: kPanelSide, tabindex: "0", role: "img"});
  const said = make("p", {id: "try_said"});
  const tools = make("div", {class: "row"}, make("label", {for: "try_stage"}, word("try_stage")), stages, stop);
  const device = make("div", {});
  const live = make("div", {}, tools, canvas, said, make("p", {class: "soft"}, word("try_help")));
  live.hidden = true;
  let run = null, waiting = [];

  const end = () => {
    const ended = run;
    run = null;
    live.hidden = true;
    if (ended) post("/try_end", {try: ended.number}).catch(() => {});
  };
  const begin = async () => {
    end();
    state.textContent = word("checking");
    const made = await post("/try", {file, text: drafts.get(file).editor.text(), trial: Number(trial.value)});
    state.textContent = made.failure || "";
    device.replaceChildren(command_line(made.command), command_line(made.device, word("with_device")));
    if (!made.try) return;
    stages.replaceChildren(...made.head.stages.map((name, i) => make("option", {value: String(i + 1)}, name)));
    const objects = made.head.objects.map((object) => object.lines.split(";").map((line) => line.split(",").map((each) => Number(each) / 1e4)));
    run = {number: made.try, pointer: [...made.head.start], hand: [...made.head.start], force: [0, 0, 0], now: "", objects, reach: made.head.reach, began: performance.now(), busy: false};
    waiting = [];
    live.hidden = false;
    canvas.focus({preventScroll: true});
    requestAnimationFrame(tick);
  };

  const scale = () => kPanelSide / (2.1 * run.reach);
  const left = (panel) => panel * (kPanelSide + 20);
  const at = (p, panel) => [left(panel) + kPanelSide / 2 + scale() * p[0], kPanelSide / 2 + kPanels[panel].sign * scale() * p[kPanels[panel].up]];
  const draw = () => {
    const pen = canvas.getContext("2d");
    pen.fillStyle = "#ffffff";
    pen.fillRect(0, 0, canvas.width, canvas.height);
    kPanels.forEach((panel, i) => {
      pen.save();
      pen.beginPath();
      pen.rect(left(i), 0, kPanelSide, kPanelSide);
      pen.clip();
      pen.strokeStyle = "#5f6368";
      pen.strokeRect(left(i), 0, kPanelSide, kPanelSide);
      pen.fillStyle = "#1b1d1f";
      pen.font = "14px sans-serif";
      pen.fillText(panel.title, left(i) + 8, 18);
      pen.strokeStyle = "#1a5596";
      pen.beginPath();
      for (const lines of run.objects) for (const line of lines) {
        pen.moveTo(...at(line.slice(0, 3), i));
        pen.lineTo(...at(line.slice(3), i));
      }
      pen.stroke();
      const [x, y] = at(run.hand, i);
      pen.beginPath();
      pen.arc(x, y, 6, 0, 7);
      pen.fill();
      pen.strokeStyle = "#a81410";
      pen.lineWidth = 3;
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(x + kNewtonPixels * run.force[0], y + panel.sign * kNewtonPixels * run.force[panel.up]);
      pen.stroke();
      pen.restore();
    });
    said.textContent = word("try_said", {force: Math.hypot(...run.force).toFixed(2), x: run.force[0].toFixed(2), y: run.force[1].toFixed(2), z: run.force[2].toFixed(2), now: run.now});
    canvas.setAttribute("aria-label", said.textContent);
  };
  const tick = () => {
    if (!run) return;
    if (!canvas.isConnected) { end(); return; }
    waiting.push(["to", ((performance.now() - run.began) / 1000).toFixed(4), ...run.pointer.map((each) => each.toFixed(6))].join(" "));
    draw();
    if (!run.busy) move(run);
    requestAnimationFrame(tick);
  };
  const move = async (mine) => {
    mine.busy = true;
    const lines = waiting.splice(0, 400);
    const answer = await by_itself("try", () => post("/try_move", {try: mine.number, lines}));
    mine.busy = false;
    if (run !== mine) return;
    if (!answer) { end(); return; }
    const numbers = answer.lines.filter((line) => /^[-\d]/.test(line)).pop();
    if (!numbers) return;
    const words = numbers.split(" ");
    mine.hand = words.slice(1, 4).map(Number);
    mine.force = words.slice(4, 7).map(Number);
    mine.now = words.slice(7).join(" ");
    canvas.dataset.answered = String(Number(canvas.dataset.answered || 0) + 1);
  };

  canvas.addEventListener("pointermove", (event) => {
    if (!run) return;
    const x = event.offsetX * canvas.width / canvas.clientWidth, y = event.offsetY * canvas.height / canvas.clientHeight;
    const panel = x < kPanelSide ? 0 : 1;
    run.pointer[0] = (x - left(panel) - kPanelSide / 2) / scale();
    run.pointer[kPanels[panel].up] = kPanels[panel].sign * (y - kPanelSide / 2) / scale();
  });
  canvas.addEventListener("keydown", (event) => {
    const way = {ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, 1], ArrowDown: [1, -1], PageUp: [2, -1], PageDown: [2, 1]}[event.key];
    if (!run || !way) return;
    event.preventDefault();
    run.pointer[way[0]] += 0.001 * way[1];
  });
  return make("details", {id: "try"}, make("summary", {}, word("try_title")), make("div", {class: "row"}, start, state), device, live);
}
