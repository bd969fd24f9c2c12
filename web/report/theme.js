// Colours come from style.css, so that light, dark and paper are decided in one place.

let cached = new Map();

export function color(name) {
  if (!cached.has(name)) {
    cached.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  }
  return cached.get(name);
}

const listeners = new Set();
function changed() {
  cached = new Map();
  listeners.forEach((listener) => listener());
}

// Calls listener now and then: whenever colours change. Returns a function that ends it.
export function onThemeChange(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

// Paper is white whatever the screen was, and canvases have to be painted again before they are printed.
const root = document.documentElement;
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
addEventListener("beforeprint", () => { root.classList.add("paper"); changed(); });
addEventListener("afterprint", () => { root.classList.remove("paper"); changed(); });

export const RUN_COLORS = ["run-1", "run-2", "run-3", "run-4", "run-5", "run-6"];
export const runColor = (index) => RUN_COLORS[index % RUN_COLORS.length];
