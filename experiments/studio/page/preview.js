"use strict";
// Preview: the page that `haptrial show` makes of the text as it is being written.

/// @returns {element, renew}; renew shows the draft as it is now, and only the newest of several.
function preview_part(file) {
  const trial = make("input", {id: "preview_trial", type: "number", min: "1", max: "1000000", value: "1", onchange: () => renew()});
  const virtual = make("input", {id: "preview_virtual", type: "checkbox", onchange: () => renew()});
  const state = make("span", {id: "preview_state", role: "status"});
  const failure = printed("", "preview_failure");
  const line = make("div", {});
  const frame = make("iframe", {id: "preview", title: word("preview_of", {file}), sandbox: "allow-scripts"});
  failure.hidden = frame.hidden = true;
  let asked = 0, scrolled = 0;  // how far the preview is scrolled; it says so itself
  window.addEventListener("message", (event) => {
    if (event.source === frame.contentWindow && Number.isInteger(event.data.preview_scroll)) scrolled = event.data.preview_scroll;
  });
  const renew = () => by_itself("preview", async () => {
    const number = ++asked;
    state.textContent = word("checking");
    const made = await post("/preview", {file, text: drafts.get(file).editor.text(), trial: Number(trial.value), virtual: virtual.checked, language: kLanguage});
    if (number !== asked) return;
    state.textContent = made.failure ? word("mend_first") : "";
    failure.textContent = made.failure || "";
    failure.hidden = !made.failure;
    line.replaceChildren(command_line(made.command));
    if (made.page) {
      frame.hidden = false;
      frame.src = address("/preview_page", {page: made.page}) + "#y=" + scrolled;
    }
  });
  const element = make("div", {}, make("div", {class: "row"}, make("label", {for: "preview_trial"}, word("trial")), trial,
    virtual, make("label", {for: "preview_virtual"}, word("with_virtual")), state), failure, line, try_part(file, trial), frame);
  return {element, renew};
}

async function show_preview(main, file) {
  main.append(make("h1", {}, file));
  await draft_of(file);
  const preview = preview_part(file);
  main.append(make("section", {"aria-label": word("preview")}, preview.element));
  await preview.renew();
}
