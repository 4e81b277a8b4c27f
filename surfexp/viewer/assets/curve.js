"use strict";
// A curve over the stops of a slider: its band, its least, and what is said of the stop where the slider stands.
const [WIDE, HIGH, MARGIN] = [480, 320, { left: 56, right: 14, top: 36, bottom: 50 }];
const SVG = new DOMParser().parseFromString("<svg>", "text/html").body.firstChild.namespaceURI;

function drawn(name, properties = {}, ...children) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(properties)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

class Curve {
  constructor(described, { name, stops, start }, moved) {
    Object.assign(this, { ...described, stops, moved });
    this.slider = element("input", { type: "range", min: 0, max: stops.length - 1, value: start });
    this.slider.setAttribute("aria-label", `${described.labels[0]} of ${name}`);
    this.said = element("output", { className: "said" });
    this.button = element("button", { type: "button", textContent: "to the least" });
    this.svg = this.chart();
    const tools = element("div", { className: "tools" }, this.button, "← and → move the slider. Short ticks: weights that were solved.");
    this.element = element("div", { className: "curve" }, this.said, this.slider, this.svg, tools);
    this.slider.addEventListener("input", () => this.stand(Number(this.slider.value)));
    this.button.addEventListener("click", () => this.stand(this.least));
    for (const kind of ["pointerdown", "pointermove"]) {
      this.svg.addEventListener(kind, (event) => event.buttons && this.stand(this.nearest(event)));
    }
    this.tell(start);
  }

  stand(at) {
    this.slider.value = at;
    this.tell(at);
    this.moved(at);
  }

  tell(at) {
    const { name } = this.stops[at], words = this.words[at];
    this.said.replaceChildren(element("b", { textContent: name }), `\n${words}`);
    this.slider.setAttribute("aria-valuetext", `${name}. ${words}`);
    const x = this.x(this.places[at]), [y] = this.bands[at];
    this.line.setAttribute("d", `M${x} ${MARGIN.top}V${HIGH - MARGIN.bottom}`);
    this.dot.setAttribute("cx", x);
    this.dot.setAttribute("cy", Math.max(MARGIN.top, this.y(y)));
  }

  // The stop nearest to the pointer.
  nearest({ clientX }) {
    const { left, width } = this.svg.getBoundingClientRect(), at = ((clientX - left) / width) * WIDE;
    const apart = (k) => Math.abs(this.x(this.places[k]) - at);
    return this.places.reduce((best, _, k) => (apart(k) < apart(best) ? k : best), 0);
  }

  x(place) {
    const [low, high] = this.limits[0];
    return MARGIN.left + ((WIDE - MARGIN.left - MARGIN.right) * Math.log(place / low)) / Math.log(high / low);
  }

  y(value) {
    const [low, high] = this.limits[1];
    return HIGH - MARGIN.bottom - ((HIGH - MARGIN.top - MARGIN.bottom) * (value - low)) / (high - low);
  }

  chart() {
    const [left, right, top, bottom] = [MARGIN.left, WIDE - MARGIN.right, MARGIN.top, HIGH - MARGIN.bottom];
    const text = (words, x, y, anchor, more) => drawn("text", { x, y, "text-anchor": anchor, ...more }, words);
    const path = (column, places = this.places.keys()) =>
      [...places].map((k) => `${this.x(this.places[k])} ${this.y(this.bands[k][column])}`).join("L");
    const back = [...this.places.keys()].reverse(), [least] = this.bands[this.least];
    this.line = drawn("path", { class: "stand" });
    this.dot = drawn("circle", { class: "stand", r: 5 });
    const [across, up] = this.labels, best = this.places[this.least], within = { "clip-path": "url(#within)" };
    const frame = { x: left, y: top, width: right - left, height: bottom - top };
    const svg = drawn("svg", { viewBox: `0 0 ${WIDE} ${HIGH}`, role: "img" },
      ...this.ticks[1].map((tick) => drawn("path", { class: "grid", d: `M${left} ${this.y(tick)}H${right}` })),
      ...this.ticks[1].map((tick) => text(significant(tick, 3), left - 7, this.y(tick) + 5, "end")),
      ...this.ticks[0].map((tick) => text(significant(tick, 3), this.x(tick), bottom + 20, "middle")),
      ...this.solved.map((place) => drawn("path", { class: "solved", d: `M${this.x(place)} ${bottom}v-5` })),
      drawn("clipPath", { id: "within" }, drawn("rect", frame)),
      drawn("path", { ...within, class: "band", d: `M${path(1)}L${path(2, back)}Z` }),
      drawn("path", { ...within, class: "values", d: `M${path(0)}` }),
      drawn("path", { class: "axis", d: `M${left} ${top}V${bottom}H${right}` }),
      this.line,
      drawn("path", { class: "least", d: `M${this.x(best)} ${this.y(least) - 9}l-6 -10h12z` }),
      text("least", this.x(best), this.y(least) - 25, "middle", { class: "named" }),
      this.dot,
      text(across, 0.5 * (left + right), HIGH - 8, "middle"),
      text(up, 4, 18, "start"),
    );
    svg.setAttribute("aria-label", `${up} by ${across}, least at ${significant(best, 3)}`);
    return svg;
  }
}
