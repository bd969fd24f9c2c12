import assert from "node:assert/strict";
import { test } from "node:test";

import { duration, length, microseconds, number, plain, times } from "../report/format.js";

const THIN_SPACE = "\u2009";

test("numbers have the digits that are asked for", () => {
  assert.equal(number(0.28412), "0.284");
  assert.equal(number(1234.5), "1235");
  assert.equal(number(12345.6), `12${THIN_SPACE}346`);
  assert.equal(number(-2.5e-7), "−2.50e−7");
  assert.equal(number(0), "0");
});

test("what is no number is a dash", () => {
  for (const show of [number, plain, times, duration]) assert.equal(show(Number.NaN), "–");
  assert.deepEqual(length(null), ["–", ""]);
  assert.deepEqual(microseconds(undefined), ["–", ""]);
});

test("plain numbers lose only what they cannot hold", () => {
  assert.equal(plain(0.1 + 0.2), "0.3");
  assert.equal(plain(1234567), `1${THIN_SPACE}234${THIN_SPACE}570`);
});

test("lengths and times change their unit before zeros pile up", () => {
  assert.deepEqual(length(0.004), ["4.00", "mm"]);
  assert.deepEqual(length(0.4), ["40.0", "cm"]);
  assert.deepEqual(length(4), ["4.00", "m"]);
  assert.deepEqual(microseconds(350), ["350", "µs"]);
  assert.deepEqual(microseconds(35000), ["35.0", "ms"]);
  assert.equal(duration(90), "1 min 30 s");
  assert.equal(duration(7260), "2 h 1 min");
});
