"use strict";
// Views by their name in the address: #NAME/FILE/MORE. A view more is one line here.
const kViews = {home: show_home, definition: show_definition, preview: show_preview, rehearse: show_rehearse, sessions: show_sessions, results: show_results};
let shown = "";

function show_nav(view, file) {
  const names = file ? Object.keys(kViews) : ["home"];
  by_id("nav").setAttribute("aria-label", word("views"));
  by_id("nav").replaceChildren(make("ul", {}, ...names.map((name) => make("li", {},
    link_to(name, name === "home" ? "" : file, word(name), {id: "to_" + name, ...(name === view ? {"aria-current": "page"} : {})})))));
}

async function show_view() {
  if (location.hash === "#main") return;  // the link that skips the navigation
  const [name, file, more] = location.hash.slice(1).split("/").map(decodeURIComponent);
  const view = Object.hasOwn(kViews, name) ? name : "home";
  shown = location.hash;
  show_nav(view, file);
  document.title = (file ? file + " \u2013 " : "") + word(view) + " \u2013 haptrial studio";
  const main = make("main", {id: "main", tabindex: "-1"});
  by_id("main").replaceWith(main);
  main.focus({preventScroll: true});
  await by_itself("view", () => kViews[view](main, file, more));
}

document.documentElement.lang = kLanguage;
by_id("skip").textContent = word("skip");
window.addEventListener("hashchange", () => { show_trouble(null); show_view(); });
show_view();
by_itself("folder", async () => { by_id("folder").textContent = (await get("/studies")).folder; });
