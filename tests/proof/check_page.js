// Reads a page, runs its scripts but the last one, and prints the rows of its claims, as they are and after planted changes.
"use strict";
const fs = require("fs");
const vm = require("vm");

const page = fs.readFileSync(process.argv[2], "utf8");
const scripts = [...page.matchAll(/<script>([\s\S]*?)<\/script>/g)].map((match) => match[1]);
vm.runInThisContext(scripts.slice(0, -1).join("\n").replaceAll('"use strict";', ""));
const text = page.match(/<script type="application\/json" id="claims"[^>]*>([\s\S]*?)<\/script>/)[1];
const changes = JSON.parse(fs.readFileSync(0, "utf8") || "[]");

// {claim, array, index, value} or {claim, array, rows}, a number of rows that are kept, or {claim, part, name, value}; or several
function changed(change, claims = JSON.parse(text)) {
  if (Array.isArray(change)) return change.reduce((made, one) => changed(one, made), claims);
  const { claim, array, index, part, name, value, rows } = change;
  if (part) claims[claim][part][name] = value;
  else if (rows !== undefined) {
    const held = claims[claim].arrays[array];
    const bytes = Buffer.from(held.data, "base64");
    held.data = bytes.subarray(0, (bytes.length / held.shape[0]) * rows).toString("base64");
    held.shape[0] = rows;
    held.sha256 = require("crypto").createHash("sha256").update(Buffer.from(held.data, "base64")).digest("hex");
  }
  else {
    const held = claims[claim].arrays[array];
    const bytes = Buffer.from(held.data, "base64");
    if (held.type === "float64") bytes.writeDoubleLE(value, 8 * index);
    else bytes.writeInt32LE(value, 4 * index);
    held.data = bytes.toString("base64");
  }
  return claims;
}

const computed = (claims) => claims.map((_, place) => computedClaim(claims, place));
const all = (claims) => computed(claims).map(({ rows }) => rows);
const started = performance.now();
const claims = computed(JSON.parse(text));
const unchanged = claims.map(({ rows }) => rows);
const said = claims.map(({ heading, sentence }) => [heading, sentence]);
const seconds = (performance.now() - started) / 1000;
console.log(JSON.stringify({ unchanged, said, seconds, changed: changes.map((change) => all(changed(change))) }));
