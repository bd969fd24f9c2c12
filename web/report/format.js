// Numbers as people read them.

const THIN_SPACE = "\u2009";

export const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

export function number(value, digits = 3) {
  if (!isNumber(value)) return "–";
  if (value === 0) return "0";
  const magnitude = Math.abs(value);
  if (magnitude >= 1e7 || magnitude < 1e-4) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${mantissa}e${Number(exponent)}`.replaceAll("-", "−");
  }
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(magnitude)));
  return grouped(value.toFixed(Math.min(decimals, 6)));
}

// As short as it can be: for axes and tables of exact values.
export function plain(value, digits = 6) {
  if (!isNumber(value)) return "–";
  const rounded = Number(value.toPrecision(digits));
  const text = String(rounded);
  return text.includes("e") ? text.replaceAll("-", "−").replace("+", "") : grouped(text);
}

export const fixed = (value, decimals) => (isNumber(value) ? grouped(value.toFixed(decimals)) : "–");

export const count = (value) => (isNumber(value) ? grouped(String(Math.round(value))) : "–");

function grouped(text) {
  const [whole, fraction] = text.replace("-", "−").split(".");
  const digits = whole.replace("−", "");
  const spaced = digits.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, THIN_SPACE) : whole;
  return fraction === undefined ? spaced : `${spaced}.${fraction}`;
}

// A length in the unit that leaves few leading zeros: [text, unit].
export function length(metres) {
  if (!isNumber(metres)) return ["–", ""];
  const magnitude = Math.abs(metres);
  if (magnitude < 0.01) return [number(metres * 1e3), "mm"];
  if (magnitude < 1) return [number(metres * 1e2), "cm"];
  return [number(metres), "m"];
}

export const lengthText = (metres) => length(metres).join(" ").trim();

export function microseconds(us) {
  if (!isNumber(us)) return ["–", ""];
  if (us >= 1e6) return [number(us / 1e6), "s"];
  if (us >= 1e4) return [number(us / 1e3), "ms"];
  return [number(us), "µs"];
}

export const microsecondsText = (us) => microseconds(us).join(" ").trim();

export function duration(seconds) {
  if (!isNumber(seconds)) return "–";
  if (seconds < 60) return `${number(seconds)} s`;
  const whole = Math.round(seconds);
  const hours = Math.floor(whole / 3600);
  const minutes = Math.floor((whole % 3600) / 60);
  return [hours ? `${hours} h` : "", `${minutes} min`, hours ? "" : `${whole % 60} s`].filter(Boolean).join(" ");
}

export function times(ratio) {
  if (!isNumber(ratio)) return "–";
  return `${ratio >= 100 ? count(ratio) : number(ratio, 2)}×`;
}

export const degrees = (radians) => (radians * 180) / Math.PI;
