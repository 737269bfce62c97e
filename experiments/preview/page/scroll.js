// Within the studio's frame the page comes back where it was: the frame's address says where, and
// the frame is told when that changes.
if (window.parent !== window) {
  const from = /^#y=(\d+)$/.exec(location.hash);
  if (from) window.scrollTo(0, Number(from[1]));
  window.addEventListener("scroll", () => window.parent.postMessage({preview_scroll: Math.round(window.scrollY)}, "*"), {passive: true});
}
