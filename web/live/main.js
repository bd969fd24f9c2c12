// The monitor of a session: a light with its reasons, the map, the camera, the streams, and buttons.

import { h } from "../report/dom.js";
import { drawMap, MapFrame } from "./map.js";

const LIGHTS = { good: ["good", "Good"], unsure: ["warn", "Unsure"], "do not trust": ["bad", "Do not trust"] };
const COMMANDS = [
  ["mark", "Mark here", "The robot stands on a mark on the floor"],
  ["save", "Save map", "Writes the map as it is now"],
  ["stop", "End", "Ends the session and writes its results"],
];
const MOST_POINTS = 4000;

const lamp = h("span", { class: "lamp", "aria-hidden": "true" });
const title = h("span", {}, "Waiting for the robot");
const reasons = h("ul", {});
const light = h("section", { class: "light", role: "status" }, h("h1", {}, lamp, title), reasons);
const numbers = h("p", { class: "numbers" });
const canvas = h("canvas", { "aria-label": "Map from above: the way of the robot, landmarks with ellipses of three sigmas" });
const image = h("img", { alt: "What the camera sees" });
const camera = h("section", { hidden: true }, h("h2", {}, "Camera"), image);
const streams = h("tbody", {});
const status = h("p", { class: "note" });
const done = h("p", { class: "note", role: "status" });

document.getElementById("monitor").append(
  light,
  h("section", { class: "map" }, numbers, canvas),
  camera,
  h("section", {}, h("h2", {}, "Streams"), h("table", {}, streams), status),
  h("section", {}, h("h2", {}, "Robot"),
    h("div", { class: "buttons" }, COMMANDS.map(([command, label, help]) =>
      h("button", { type: "button", title: help, onclick: () => press(command, label) }, label))), done));

const frame = new MapFrame(canvas);
const world = { trail: [], landmarks: [], pose: null };
let shownImage = 0;

async function press(command, label) {
  const answer = await fetch(`do/${command}`, { method: "POST", headers: { "X-Waymark": "1" } }).catch(() => null);
  done.textContent = answer?.ok ? `${label}: done` : `${label}: the robot does not answer`;
}

function row(stream) {
  const age = stream.age_ms === undefined ? "" : `${stream.age_ms.toFixed(1)} ms`;
  const counts = [["damaged", "damaged"], ["lost", "lost"], ["replaced", "replaced by newer"]]
    .filter(([key]) => stream[key] > 0).map(([key, word]) => `${stream[key]} ${word}`);
  const silent = stream.silent_s > 1 ? [`silent for ${stream.silent_s.toFixed(1)} s`] : [];
  const detail = [stream.fault, ...silent, ...counts].filter(Boolean).join(", ");
  return [
    h("tr", {}, h("th", { scope: "row" }, stream.name), h("td", {}, `${stream.rate_hz.toFixed(1)} Hz`), h("td", {}, age)),
    detail ? h("tr", { class: `detail${stream.fault || silent.length ? " trouble" : ""}` }, h("td", { colspan: 3 }, detail)) : null,
  ];
}

function showLight(level, why) {
  const [name, words] = LIGHTS[level] ?? ["", level];
  light.className = `light ${name}`;
  title.textContent = words;
  reasons.replaceChildren(...why.map((reason) => h("li", {}, reason)));
}

function showNumbers({ pose, since_start_s: time, corrections }) {
  const number = (value, unit) => h("span", {}, h("b", {}, value), ` ${unit}`);
  const parts = [number(time.toFixed(0), "s")];
  if (pose) {
    const sigma_cm = 300 * Math.hypot(pose.ellipse[0], pose.ellipse[1]);
    parts.push(number(`${pose.x_m.toFixed(2)}, ${pose.y_m.toFixed(2)}`, "m"),
      number(((180 / Math.PI) * pose.theta_rad).toFixed(1), "deg"),
      number(`± ${sigma_cm.toFixed(1)}`, "cm"), number(`± ${(3 * pose.heading_sigma_deg).toFixed(1)}`, "deg (3 sigma)"));
  }
  parts.push(number(String(world.landmarks.length), "landmarks"));
  if (corrections) parts.push(number(corrections.p50_ms.toFixed(1), `ms to correct (99 %: ${corrections.p99_ms.toFixed(1)})`));
  if (corrections?.missed) parts.push(number(String(corrections.missed), "frames missed"));
  numbers.replaceChildren(...parts);
}

function show(state) {
  showLight(state.light, state.reasons);
  if (state.landmarks) world.landmarks = state.landmarks;
  if (state.pose) {
    world.pose = state.pose;
    world.trail.push([state.pose.x_m, state.pose.y_m]);
    if (world.trail.length > MOST_POINTS) world.trail = world.trail.filter((_, i) => i % 2 === 0);
  }
  showNumbers(state);
  streams.replaceChildren(...state.streams.flatMap(row).filter(Boolean));
  const notes = [];
  if (state.recording) notes.push(`recording ${state.recording}`);
  if (state.free_mb !== undefined) notes.push(`${(state.free_mb / 1000).toFixed(1)} GB free`);
  if (state.late > 0) notes.push(`${state.late} events too late`);
  if (state.marks > 0) notes.push(`${state.marks} marks`);
  status.textContent = notes.join(", ");
  if (state.image !== shownImage && (image.complete || !shownImage)) {
    shownImage = state.image;
    camera.hidden = false;
    image.src = `image?${shownImage}`;
  }
  drawMap(frame, world);
}

async function begin() {
  const past = await fetch("past").then((answer) => answer.json()).catch(() => ({}));
  world.trail = past.trail ?? [];
  const events = new EventSource("events");
  events.onmessage = (message) => show(JSON.parse(message.data));
  events.onerror = () => showLight("do not trust", ["the robot does not answer"]);
}

addEventListener("resize", () => drawMap(frame, world));
begin();
