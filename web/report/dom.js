// Elements without a framework: h("p", {class: "note"}, "text", child).

export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
}

export function panel(title, { note, tools = [], id } = {}, ...children) {
  return h("section", { class: "panel", id },
    h("header", { class: "panel-head" },
      h("div", {}, h("h3", {}, title), note ? h("p", { class: "note" }, note) : null),
      h("div", { class: "tools" }, tools)),
    ...children);
}

// A part of the page under its heading, where there is something to show.
export function section(title, className, ...children) {
  const present = children.flat().filter(Boolean);
  return present.length ? h("section", { class: "group" }, h("h2", {}, title), h("div", { class: className }, present)) : null;
}

export function toggleButton(label, pressed, onchange, title) {
  const button = h("button", { type: "button", class: "chip", "aria-pressed": String(pressed), title }, label);
  button.addEventListener("click", () => {
    pressed = !pressed;
    button.setAttribute("aria-pressed", String(pressed));
    onchange(pressed);
  });
  return button;
}

// A row of buttons of which exactly one is chosen.
export function choice(options, chosen, onchange, label) {
  const buttons = options.map(({ value, text, title }) =>
    h("button", {
      type: "button", class: "segment", title, "aria-pressed": String(value === chosen),
      onclick: () => {
        buttons.forEach((button, i) => button.setAttribute("aria-pressed", String(options[i].value === value)));
        onchange(value);
      },
    }, text));
  return h("div", { class: "segments", role: "group", "aria-label": label }, buttons);
}

export function download(name, url) {
  h("a", { href: url, download: name }).click();
}
