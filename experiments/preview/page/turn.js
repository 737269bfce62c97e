// Turns the objects of a page: pointer, sliders and their arrow keys.
{
  const kWide = 900, kHigh = 460;

  for (const data of document.querySelectorAll("svg metadata.turn")) {
    const view = JSON.parse(data.textContent);
    const svg = data.closest("svg");
    const paths = [...svg.querySelectorAll(".turn-object")];
    const axes = [...svg.querySelectorAll(".turn-axis")], names = [...svg.querySelectorAll(".turn-name")];
    const lines = view.objects.map((text) => text.split(";").map((line) => line.split(",").map(Number)));

    const draw = (about, over) => {
      const a = about * Math.PI / 180, b = over * Math.PI / 180;
      const [ca, sa, cb, sb] = [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b)];
      const seen = (x, y, z) => {
        const depth = z * ca - x * sa;
        return [kWide / 2 + view.scale * (x * ca + z * sa), kHigh / 2 - view.scale * (y * cb - depth * sb)];
      };
      const at = (x, y, z) => seen(x - view.middle[0], y - view.middle[1], z - view.middle[2]).map((each) => each.toFixed(1)).join(" ");
      paths.forEach((path, i) => path.setAttribute("d", lines[i].map((l) => "M" + at(l[0], l[1], l[2]) + "L" + at(l[3], l[4], l[5])).join("")));
      axes.forEach((axis, i) => {
        const unit = [0, 1, 2].map((each) => each === i ? 38 / view.scale : 0);
        const [x, y] = seen(...unit), dx = x - kWide / 2 + 60, dy = y - kHigh / 2 + kHigh - 60;
        axis.setAttribute("d", `M60 ${kHigh - 60}L${dx} ${dy}`);
        names[i].setAttribute("x", dx + 4);
        names[i].setAttribute("y", dy - 2);
      });
    };

    const slider = (name, low, high, value) => {
      const input = Object.assign(document.createElement("input"), {type: "range", min: low, max: high, step: 5, value});
      input.addEventListener("input", redraw);
      const label = document.createElement("label");
      label.append(name + " ", input);
      return [input, label];
    };
    const redraw = () => draw(Number(about.value), Number(over.value));
    const [about, about_label] = slider(view.words.about, -180, 180, view.about);
    const [over, over_label] = slider(view.words.over, -90, 90, view.over);
    const controls = document.createElement("div");
    controls.style.cssText = "display:flex;flex-wrap:wrap;gap:1rem;font:inherit";
    controls.append(about_label, over_label);
    svg.after(controls);
    svg.style.touchAction = "none";
    svg.style.cursor = "grab";
    about.step = over.step = 1;
    svg.addEventListener("pointerdown", (event) => svg.setPointerCapture(event.pointerId));
    svg.addEventListener("pointermove", (event) => {
      if (!event.buttons) return;
      about.value = Number(about.value) + 0.5 * event.movementX;
      over.value = Number(over.value) + 0.5 * event.movementY;
      redraw();
    });
    redraw();
  }
}
