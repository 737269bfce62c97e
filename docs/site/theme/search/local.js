// Search in pages that are opened as files: a browser lets them neither start a worker nor fetch
// the index, so the index comes as a script and the worker's script runs in a frame.
var __search;
if (location.protocol === "file:") {
  const base = document.currentScript.dataset.base;
  const add = (page, address, then) => {
    const script = page.createElement("script");
    script.src = address;
    script.onload = then;
    page.body.append(script);
  };
  __search = {
    index: new Promise((done) => addEventListener("DOMContentLoaded", () => {
      add(document, base + "/search/search_index.js", () => done(window.__index));
    })),
  };
  window.Worker = class extends EventTarget {
    constructor(address) {
      super();
      const frame = document.createElement("iframe");
      frame.hidden = true;
      document.body.append(frame);
      this.inner = frame.contentWindow;
      this.inner.postMessage = (data) => this.dispatchEvent(new MessageEvent("message", {data}));
      this.ready = new Promise((done) => add(this.inner.document, address, done));
    }
    postMessage(data) {
      this.ready.then(() => this.inner.dispatchEvent(new MessageEvent("message", {data})));
    }
  };
}
