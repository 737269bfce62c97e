"use strict";
const token = new URLSearchParams(location.search).get("token") || "";

function $(name) { return document.getElementById(name); }
function now() { return performance.now() / 1000; }
function text(name, value) { if ($(name).textContent !== value) $(name).textContent = value; }
function make(kind, parent, words, style) {
  const element = document.createElement(kind);
  element.textContent = words || "";
  if (style) element.className = style;
  parent.append(element);
  return element;
}
