"use strict";
// The page: each claim is computed in its turn and shown; the verdict is green only after all of them hold.

const digits = (number) => (typeof number !== "number" ? String(number ?? "") : String(Number(number.toPrecision(13))));
const short = (number) => (Number.isFinite(number) ? (number === 0 ? "0" : number.toExponential(1)) : "");

function element(name, text, looks = "") {
  const made = document.createElement(name);
  made.textContent = text;
  if (looks) made.className = looks;
  return made;
}

function shownRow({ what, computed, stated, slack, bound, bytes, holds: held }) {
  const row = element("tr", "", held ? "holds" : "fails");
  const rule = bytes && held ? "the same" : bound !== undefined ? `at most ${digits(bound)}` : stated !== undefined ? digits(stated) : "";
  const cells = [["", held ? "holds" : "fails"], ["what", what], ["computed here", digits(computed)], ["stated", rule], ["may differ by", short(slack)]];
  cells.forEach(([label, text], k) => {
    const cell = element(k === 1 ? "th" : "td", text);
    if (k === 1) cell.scope = "row";
    cell.dataset.label = label;
    row.append(cell);
  });
  return row;
}

function say(node, held, text) {
  node.className = `verdict ${held === null ? "" : held ? "holds" : "fails"}`;
  node.textContent = text;
}

async function prove() {
  const source = document.getElementById("claims");
  const verdict = document.getElementById("verdict");
  const text = source.textContent;
  const digest = sha256(new TextEncoder().encode(text));
  let [all, checks] = [digest === source.dataset.sha256, 1];
  let claims = [];
  try {
    claims = JSON.parse(text);
  } catch (error) {
    all = false;
  }
  const sections = [...document.querySelectorAll("section.claim")];
  if (claims.length !== sections.length || !claims.length) all = false;
  document.getElementById("bytes").append(shownRow({ what: "SHA-256 of all that the page states", bytes: true, computed: digest, stated: source.dataset.sha256, holds: all }));
  for (const [place, section] of sections.entries()) {
    const told = section.querySelector(".verdict");
    say(told, null, "computing");
    await new Promise((done) => setTimeout(done, 30));
    const started = performance.now();
    const { heading, sentence, rows } =
      place < claims.length ? computedClaim(claims, place) : { heading: "", sentence: "", rows: [{ what: "claim is missing", holds: false }] };
    section.querySelector("h2").textContent = heading;
    section.querySelector("p").textContent = sentence;
    const seconds = ((performance.now() - started) / 1000).toFixed(2);
    const wrong = rows.filter((row) => row.holds !== true).length;
    const [numbers, fingerprints] = section.querySelectorAll("tbody");
    numbers.append(...rows.filter((row) => !row.bytes).map(shownRow));
    fingerprints.append(...rows.filter((row) => row.bytes).map(shownRow));
    section.querySelector("details").open = rows.some((row) => row.bytes && !row.holds);
    say(told, holds(rows), holds(rows) ? `${rows.length} checks hold, computed here in ${seconds} s` : `${wrong} of ${rows.length} checks fail`);
    all = all && holds(rows);
    checks += rows.length;
  }
  say(verdict, all, all ? `All ${checks} checks hold. Each number was computed by this browser.` : "This page does not hold: a check fails.");
  document.body.dataset.done = all ? "holds" : "fails";
}

prove().catch((error) => {
  say(document.getElementById("verdict"), false, `Nothing is proved: ${error.message}`);
  document.body.dataset.done = "fails";
});
