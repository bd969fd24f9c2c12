// The light at the top: how far this run may be trusted, and why.

import { h } from "./dom.js";

const LIGHTS = { good: ["good", "Good"], unsure: ["warn", "Unsure"], "do not trust": ["bad", "Do not trust"] };

export function verdictPanel({ level, reasons }) {
  const [state, title] = LIGHTS[level] ?? ["warn", level];
  return h("section", { class: `verdict ${state}` }, h("h2", {}, h("span", { class: "light", "aria-hidden": "true" }), title),
    h("ul", {}, (reasons ?? []).map((reason) => h("li", {}, reason))));
}
