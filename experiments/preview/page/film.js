"use strict";
// Plays the films of a page: the elements of each picture are set to the samples of its data.
{
  const element = (tag, properties) => Object.assign(document.createElement(tag), properties);
  const kNumbers = 7;  // of a frame: time; place x, y, z; force x, y, z

  for (const data of document.querySelectorAll("svg metadata.film")) {
    const film = JSON.parse(data.textContent);
    const svg = data.closest("svg");
    const count = film.frames.length / kNumbers;
    const last = film.frames[(count - 1) * kNumbers];
    const all = (name) => [...svg.querySelectorAll("." + name)];
    const hands = all("film-hand"), arrows = all("film-arrow"), objects = all("film-object");
    const [said] = all("film-said");

    const frame_at = (time) => {
      let low = 0, high = count - 1;
      while (low < high) {
        const middle = (low + high + 1) >> 1;
        if (film.frames[middle * kNumbers] <= time) low = middle; else high = middle - 1;
      }
      return film.frames.slice(low * kNumbers, (low + 1) * kNumbers);
    };
    const show = (time) => {
      const [, ...numbers] = frame_at(time);
      const place = numbers.slice(0, 3), force = numbers.slice(3);
      const stage = film.stages.filter((each) => each.begin <= time).pop() || {name: "", interval: 0};
      film.panels.forEach((panel, i) => {
        const x = panel.x + panel.scale * place[panel.across], y = panel.y + panel.up_scale * place[panel.up];
        hands[i].setAttribute("cx", x);
        hands[i].setAttribute("cy", y);
        const along = film.pixels * force[panel.across], up = (panel.up_scale < 0 ? -1 : 1) * film.pixels * force[panel.up];
        const length = Math.hypot(along, up), head = Math.min(9, 0.5 * length) / (length || 1);
        const tip_x = x + along, tip_y = y + up, neck_x = tip_x - 1.4 * head * along, neck_y = tip_y - 1.4 * head * up;
        arrows[i].setAttribute("d", length < 1 ? "" : `M${x} ${y}L${neck_x} ${neck_y}M${tip_x} ${tip_y}L${neck_x - 0.6 * head * up} ${neck_y + 0.6 * head * along}L${neck_x + 0.6 * head * up} ${neck_y - 0.6 * head * along}Z`);
      });
      for (const object of objects) {
        const interval = Number(object.dataset.interval);
        object.setAttribute("visibility", interval === 0 || interval === stage.interval ? "visible" : "hidden");
      }
      const [fx, fy, fz] = force.map((each) => each.toFixed(2));
      said.textContent = `${time.toFixed(2)} s${stage.name ? ", " + stage.name : ""}: ${Math.hypot(...force).toFixed(2)} N (x ${fx}, y ${fy}, z ${fz})`;
      return said.textContent;
    };

    const play = element("button", {type: "button", textContent: film.words.play});
    const slider = element("input", {type: "range", min: 0, max: last, step: 0.01, value: 0});
    const speed = element("select", {});
    slider.setAttribute("aria-label", film.words.time);
    speed.setAttribute("aria-label", film.words.speed);
    for (const each of [0.1, 0.25, 0.5, 1, 2]) speed.append(element("option", {value: each, textContent: "× " + each, selected: each === 1}));
    slider.style.cssText = "flex:1 1 12rem";
    const controls = element("div", {className: "film-controls"});
    controls.style.cssText = "display:flex;flex-wrap:wrap;gap:.6rem;align-items:center;font:inherit";
    controls.append(play, slider, speed);
    svg.after(controls);

    let playing = false, before = 0;
    const go_to = (time) => { slider.value = time; slider.setAttribute("aria-valuetext", show(Number(slider.value))); };
    const step = (now) => {
      if (!playing) return;
      const time = Number(slider.value) + Number(speed.value) * (now - before) / 1000;
      before = now;
      slider.value = Math.min(time, last);
      go_to(slider.value);
      if (time >= last) { set_playing(false); return; }
      requestAnimationFrame(step);
    };
    const set_playing = (yes) => {
      playing = yes;
      play.textContent = playing ? film.words.pause : film.words.play;
      if (!playing) return;
      if (Number(slider.value) >= last) go_to(0);
      before = performance.now();
      requestAnimationFrame(step);
    };
    slider.step = "any";
    play.addEventListener("click", () => set_playing(!playing));
    slider.addEventListener("input", () => { set_playing(false); go_to(slider.value); });
    slider.addEventListener("keydown", (event) => {
      const steps = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1}[event.key];
      if (steps === undefined) return;
      event.preventDefault();
      set_playing(false);
      go_to(Math.min(last, Math.max(0, Number(slider.value) + steps / 60)));
    });
    go_to(film.begin);
  }
}
