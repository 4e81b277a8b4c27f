// Reads a page, runs its scripts but the last one, and prints the rows of its claims, as they are and after planted changes.
"use strict";
const fs = require("fs");
const vm = require("vm");

const page = fs.readFileSync(process.argv[2], "utf8");
const scripts = [...page.matchAll(/<script>([\s\S]*?)<\/script>/g)].map((match) => match[1]);
vm.runInThisContext(scripts.slice(0, -1).join("\n").replaceAll('"use strict";', ""));
const text = page.match(/<script type="application\/json" id="claims"[^>]*>([\s\S]*?)<\/script>/)[1];
const changes = JSON.parse(fs.readFileSync(0, "utf8") || "[]");

// {claim, array, index, value} or {claim, part, name, value}
function changed({ claim, array, index, part, name, value }) {
  const claims = JSON.parse(text);
  if (part) claims[claim][part][name] = value;
  else {
    const held = claims[claim].arrays[array];
    const bytes = Buffer.from(held.data, "base64");
    if (held.type === "float64") bytes.writeDoubleLE(value, 8 * index);
    else bytes.writeInt32LE(value, 4 * index);
    held.data = bytes.toString("base64");
  }
  return claims;
}

const all = (claims) => claims.map((_, place) => rowsOf(claims, place));
const started = performance.now();
const unchanged = all(JSON.parse(text));
const seconds = (performance.now() - started) / 1000;
console.log(JSON.stringify({ unchanged, seconds, changed: changes.map((change) => all(changed(change))) }));
