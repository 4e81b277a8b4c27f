"use strict";
// Under each still picture of surfaces a button turns it: its panels, and those of its comparison, turn together.
// A figure without a still picture turns at once.
const KEYS = { f: "front", b: "back", l: "left", r: "right", t: "top", u: "bottom", o: "lateral", i: "medial" };
const ARROWS = { ArrowLeft: [15, 0], ArrowRight: [-15, 0], ArrowUp: [0, -15], ArrowDown: [0, 15] };
// milliseconds: without a change for so long a surface rests; a frame of the comparison that takes longer is too slow
const REST = 150, SLOW = 33;
const waiting = new Set(), moving = new Set();
let resting = 0;

function redraw(figures) {
  if (!waiting.size) requestAnimationFrame(drawWaiting);
  figures.forEach((figure) => waiting.add(figure));
}

function drawWaiting() {
  const panels = [...waiting].flatMap((figure) => figure.panels);
  waiting.clear();
  for (const panel of panels) {
    moving.add(panel);
    panel.draw(false);
  }
  clearTimeout(resting);
  resting = setTimeout(drawResting, REST);
}

// One after the other, so that whoever turns on does not wait for all.
function drawResting() {
  const [panel] = moving;
  if (!panel) return;
  moving.delete(panel);
  if (panel.element.isConnected) panel.draw(true);
  resting = setTimeout(drawResting);
}

class TurningFigure {
  constructor(element_, linked) {
    Object.assign(this, { element: element_, linked, panels: [], cost: 0 });
    this.scene = JSON.parse(element_.querySelector("script.scene").textContent);
    const number = figuresIn(document).indexOf(element_) + 1;
    this.name = `figure ${number}: ${element_.querySelector("img")?.alt ?? "surface"}`;
    this.button = element("button", { type: "button", textContent: "Turn", ariaLabel: `Turn ${this.name}` });
    this.note = element("span", { className: "note" });
    this.note.setAttribute("role", "status");
    this.views = element("span", { className: "views", hidden: true });
    const own = this.scene.surfaces.flatMap(({ sides }) => Object.keys(sides ?? {}));
    for (const name of ["reset", ...Object.values(KEYS)]) {
      if (name !== "reset" && !(name in this.scene.views) && !own.includes(name)) continue;
      const button = element("button", { type: "button", textContent: name, ariaLabel: `${name} view of ${this.name}` });
      button.addEventListener("click", () => this.face(name));
      this.views.append(button);
    }
    for (const [name, zoom] of [["larger", 1.2], ["smaller", 1 / 1.2]]) {
      const button = element("button", { type: "button", textContent: name, ariaLabel: `${name}: ${this.name}` });
      button.addEventListener("click", () => this.move({ zoom }));
      this.views.append(button);
    }
    this.tools = element("div", { className: "tools" }, this.button, this.views, this.note);
    this.place = element("div", { className: "panels" });
    this.place.dataset.count = this.scene.panels.length + (this.scene.curve ? 1 : 0);
    const still = element_.querySelector(":scope > a, :scope > img");
    if (still) still.after(this.place, this.tools);
    else element_.prepend(this.place, this.tools);
    this.button.hidden = !still;
    this.button.addEventListener("click", () => (this.panels.length ? this.still() : this.turn()));
    this.watcher = new ResizeObserver(() => redraw([this]));
  }

  start() {
    const [azimuth, elevation] = this.scene.view;
    this.view = { azimuth, elevation, zoom: 1, x: 0, y: 0 };
    const { eyes = [] } = this.scene;
    this.apart(this.panels.map((_, k) => eyes[k] ?? this.scene.view));
  }

  // Each panel looks from its own side of the common view.
  apart(eyes) {
    const { azimuth, elevation } = this.view;
    this.panels.forEach((panel, k) => (panel.offset = [eyes[k][0] - azimuth, eyes[k][1] - elevation]));
  }

  async turn() {
    this.button.disabled = true;
    try {
      startRenderer();
      const surfaces = await Promise.all(this.scene.surfaces.map(readSurface));
      this.radius = Math.max(...surfaces.map(({ radius }) => radius)) || 1;
      this.scene.panels.forEach(([which, field], k) => {
        const title = this.scene.titles?.[k];
        this.panels.push(new Panel(this, surfaces[which], this.scene.surfaces[which], field, title));
      });
      this.start();
      this.place.append(...this.panels.map((panel) => panel.element));
      if (this.scene.curve) this.drawCurve();
      this.element.classList.add("turns");
      this.panels.forEach((panel) => this.listen(panel));
      await Promise.all(this.panels.map((panel) => panel.show(panel.field.start ?? 0)));
      this.watcher.observe(this.place);
      this.cost = this.measured();
      this.linked.add(this);
      this.views.hidden = false;
      this.button.textContent = "Still";
      this.button.ariaLabel = `Still ${this.name}`;
      this.note.textContent = "Drag or arrow keys turn, + and − zoom, shift and drag moves.";
    } catch (error) {
      this.still();
      this.note.textContent = `Stays still: ${error.message}.`;
    }
    this.button.disabled = false;
  }

  // One slider for all panels that have stops, over the curve.
  drawCurve() {
    const [{ field }] = this.panels.filter(({ field: { stops } }) => stops);
    this.stop = field.start;
    this.curve = new Curve(this.scene.curve, field, (at) => {
      this.stop = at;
      this.panels.filter((panel) => panel.field.stops).forEach((panel) => panel.show(at));
    });
    this.place.append(this.curve.element);
  }

  // Milliseconds that a frame with all faces takes here.
  measured() {
    const graphics = renderer.getContext(), [first] = this.panels;
    const drawn = () => graphics.readPixels(0, 0, 1, 1, graphics.RGBA, graphics.UNSIGNED_BYTE, new Uint8Array(4));
    this.panels.forEach((panel) => panel.draw(false)); // this also compiles
    drawn();
    const start = performance.now();
    first.draw(false);
    drawn();
    return this.panels.length * (performance.now() - start);
  }

  // What a frame of the comparison takes, in frames that are quick enough.
  get strain() {
    return [...this.linked].reduce((sum, { cost }) => sum + cost, 0) / SLOW;
  }

  still() {
    this.watcher.disconnect();
    this.panels.forEach((panel) => panel.end());
    this.panels = [];
    this.place.replaceChildren();
    this.linked.delete(this);
    this.views.hidden = true;
    this.element.classList.remove("turns");
    this.button.textContent = "Turn";
    this.button.ariaLabel = `Turn ${this.name}`;
    this.note.textContent = "";
  }

  // Every figure of the comparison moves by the same; each keeps where it started from.
  move({ azimuth = 0, elevation = 0, zoom = 1, x = 0, y = 0 }) {
    for (const { view } of this.linked) {
      view.azimuth += azimuth;
      view.elevation = Math.max(-90, Math.min(90, view.elevation + elevation));
      view.zoom = Math.max(0.2, Math.min(50, view.zoom * zoom));
      view.x += x;
      view.y += y;
    }
    redraw(this.linked);
  }

  face(name) {
    for (const figure of this.linked) {
      figure.start();
      const common = figure.scene.views[name];
      const eyes = figure.panels.map(({ described }) => common ?? described.sides?.[name]);
      if (!eyes[0]) continue;
      [figure.view.azimuth, figure.view.elevation] = eyes[0];
      figure.apart(eyes.map((eye) => eye ?? eyes[0]));
    }
    redraw(this.linked);
  }

  listen(panel) {
    const { canvas } = panel, across = () => this.panels.filter(({ surface }) => surface === panel.surface);
    let asked = 0;
    const tell = (event) => {
      const vertex = panel.under(event);
      across().forEach((one) => one.tell(vertex));
    };
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      const { movementX, movementY, buttons, shiftKey } = event;
      if (buttons && shiftKey) this.move({ x: movementX, y: movementY });
      else if (buttons) this.move({ azimuth: -0.5 * movementX, elevation: 0.5 * movementY });
      cancelAnimationFrame(asked);
      if (!buttons) asked = requestAnimationFrame(() => tell(event));
    });
    canvas.addEventListener("pointerleave", () => across().forEach((one) => one.tell(-1)));
    // a wheel alone scrolls the page
    canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      this.move({ zoom: Math.exp(-0.002 * event.deltaY) });
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const { key } = event;
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (key in ARROWS) this.move({ azimuth: ARROWS[key][0], elevation: ARROWS[key][1] });
      else if (key === "+" || key === "=") this.move({ zoom: 1.2 });
      else if (key === "-") this.move({ zoom: 1 / 1.2 });
      else if (key === "0" || key === "Home") this.face("reset");
      else if (key in KEYS) this.face(KEYS[key]);
      else if (key === "Enter") {
        const { left, top, width, height } = canvas.getBoundingClientRect();
        tell({ clientX: left + width / 2, clientY: top + height / 2 });
      }
      else return;
      event.preventDefault();
    });
  }
}

function startRenderer() {
  if (typeof DecompressionStream === "undefined") throw new Error("this browser unpacks no deflated data");
  if (renderer) return;
  if (!document.createElement("canvas").getContext("webgl2")) throw new Error("this browser has no WebGL 2");
  renderer = new THREE.WebGLRenderer({ alpha: true });
  renderer.domElement.addEventListener("webglcontextlost", () => {
    renderer = null;
    for (const figure of turning.filter(({ panels }) => panels.length)) {
      figure.still();
      figure.button.hidden = false;
      figure.note.textContent = "Stays still: the browser took the graphics away; turn it again.";
    }
  });
}

function figuresIn(part) {
  return [...part.querySelectorAll("figure > script.scene")].map((scene) => scene.parentElement);
}

const turning = [...document.querySelectorAll("section")].flatMap((section) => {
  const linked = new Set();
  return figuresIn(section).map((figure) => new TurningFigure(figure, linked));
});
for (const figure of turning) if (figure.element.classList.contains("live")) figure.turn();
