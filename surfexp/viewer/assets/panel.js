"use strict";
// A panel: one surface on a canvas of its own, what it is coloured by, and the value under the pointer.
// One renderer draws for all: browsers allow few.
let renderer = null;
const density = Math.min(devicePixelRatio || 1, 2);

function element(name, properties = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

// The digits that tell steps of a size apart; a power of ten where a number is very small or large.
function digits(value, step) {
  const place = Math.floor(Math.log10(step) + 1e-9), size = Math.abs(value);
  const count = Math.max(0, Math.min(Math.floor(Math.log10(size || step)) - place, 15));
  if (size < 0.5 * 10 ** place) return "0";
  const text = size < 1e-4 || size >= 1e9
    ? value.toExponential(count).replace(/\.?0*e\+?/, "e")
    : value.toLocaleString("en", { maximumFractionDigits: Math.max(0, Math.min(-place, 20)), useGrouping: false });
  return text.replaceAll("-", "−");
}

// of a number alone
const significant = (value, count) => digits(value, 10 ** Math.min(0, Math.floor(Math.log10(Math.abs(value) || 1)) - count + 1));
// names of labels that are listed
const MOST_NAMES = 200;

// What a field shows at a position of its slider.
function stepAt({ steps, stops }, at) {
  if (!stops) return steps[at];
  const { place, name } = stops[at], first = Math.floor(place), last = Math.min(first + 1, steps.length - 1);
  return { ...steps[first], name, next: steps[last].values, share: place - first };
}

class Panel {
  constructor(figure, surface, described, field, title = "") {
    Object.assign(this, { figure, surface, described, scene: new THREE.Scene(), lines: [], turn: 0, offset: [0, 0] });
    this.camera = new THREE.OrthographicCamera();
    this.mesh = surfaceMesh(surface);
    this.scene.add(this.mesh);
    this.canvas = element("canvas", { tabIndex: 0 });
    this.canvas.setAttribute("role", "application");
    this.canvas.setAttribute("aria-roledescription", "surface that turns");
    this.bar = element("canvas", { height: 1 });
    this.names = element("ul", { className: "names" });
    this.ends = ["below", "above"].map((end) => element("i", { className: end, hidden: true }));
    this.ticks = element("span", { className: "ticks" });
    this.label = element("span", { className: "label" });
    this.told = element("output", { className: "told", textContent: " " });
    this.slider = element("input", { type: "range", min: 0, value: 0 });
    this.step = element("output");
    this.fields = element("select", {}, ...described.fields.map(({ name }, k) => new Option(name, k)));
    this.fields.setAttribute("aria-label", `what ${described.name} shows`);
    this.fields.value = field;
    this.sliding = element("label", { className: "step" }, this.slider, this.step);
    const [below, above] = this.ends, bar = element("div", { className: "bar" }, below, this.bar, above);
    this.colours = element("div", { className: "colours" }, bar, this.ticks, this.label);
    const head = element("div", { className: "head" }, this.fields, this.sliding);
    const name = title || (figure.scene.surfaces.length > 1 ? described.name : "");
    if (name) head.prepend(element("b", { textContent: name }));
    this.element = element("div", { className: "panel" }, head, this.canvas, this.told, this.colours, this.names);
    this.fields.addEventListener("change", () => this.show(this.field.stops ? this.figure.stop : 0));
    this.slider.addEventListener("input", () => this.show(Number(this.slider.value)));
  }

  get field() {
    return this.described.fields[Number(this.fields.value)];
  }

  get coarse() {
    return (this.surface.coarse ??= coarseFaces(this.surface.geometry, this.surface.radius));
  }

  // Colour the surface; of several requests the last one counts.
  async show(at) {
    const field = this.field, step = stepAt(field, at), turn = ++this.turn;
    const lines = await Promise.all((step?.lines ?? []).map((one, k) => lineMesh(one, this.surface.middle, k)));
    const [pixels, values] = await Promise.all([readTable(field.table), step?.values && numbersAt(step)]);
    if (turn !== this.turn) return lines.forEach(release);
    if (field.labels && !this.flat) this.scene.add((this.flat = flatMesh(this.surface)));
    paint(field.labels ? this.flat : this.mesh, field, values, pixels, this.surface.geometry.index.array);
    this.mesh.visible = !field.labels;
    if (this.flat) this.flat.visible = !!field.labels;
    this.values = values;
    this.lines.forEach((old) => this.scene.remove(release(old)));
    this.lines = lines;
    lines.forEach((one) => this.scene.add(one));
    this.sliding.hidden = !!field.stops || field.steps.length < 2;
    this.fields.hidden = this.described.fields.length < 2;
    this.slider.max = Math.max(field.steps.length - 1, 0);
    this.slider.value = at;
    this.slider.setAttribute("aria-label", field.name);
    this.step.textContent = step?.name ?? "";
    const shown = `${this.described.name}: ${step?.name || field.name}, turns with the arrow keys, Enter tells the value in the middle`;
    this.canvas.setAttribute("aria-label", shown);
    this.legend(field, pixels);
    redraw([this.figure]);
  }

  legend(field, pixels) {
    this.colours.hidden = !field.limits;
    const names = field.legend === false ? [] : field.labels ?? [];
    this.names.replaceChildren(...names.slice(0, MOST_NAMES).map((name, k) => {
      const swatch = element("i"), color = [...pixels.subarray(4 * k, 4 * k + 3)];
      swatch.style.background = `rgb(${color})`;
      return element("li", {}, swatch, name);
    }));
    if (names.length > MOST_NAMES) this.names.append(element("li", { textContent: `and ${names.length - MOST_NAMES} more` }));
    if (!field.limits) return;
    const [low, high] = field.limits, width = pixels.length / 4 - 1;
    this.bar.width = width;
    this.bar.getContext("2d").putImageData(new ImageData(pixels.slice(0, 4 * width), width, 1), 0, 0);
    const marks = [low, 0.5 * (low + high), high].map((value) => element("span", { textContent: digits(value, (high - low) / 100) }));
    this.ticks.replaceChildren(...marks);
    const beyond = field.beyond ?? [0, 0], part = 100 * (beyond[0] + beyond[1]), [first, last] = [0, 4 * (width - 1)];
    this.ends.forEach((end, k) => {
      end.hidden = !beyond[k];
      end.style.background = `rgb(${[...pixels.subarray([first, last][k], [first, last][k] + 3)]})`;
    });
    const said = part ? `${significant(part, 2)} % of the values lie beyond` : "";
    this.label.textContent = [field.label, said].filter(Boolean).join("\n");
  }

  // An orthographic eye at the azimuth and elevation of the still pictures.
  look() {
    const { zoom, x, y } = this.figure.view, azimuth = this.figure.view.azimuth + this.offset[0];
    const elevation = Math.max(-90, Math.min(90, this.figure.view.elevation + this.offset[1]));
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const [a, e] = [azimuth, elevation].map((angle) => (angle * Math.PI) / 180), size = this.figure.radius;
    const unit = (1.04 * size) / (zoom * Math.min(width, height) || 1), { camera } = this;
    camera.position.set(Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)).multiplyScalar(3 * size);
    camera.up.set(-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e));
    camera.lookAt(0, 0, 0);
    Object.assign(camera, { left: -(width + 2 * x) * unit, right: (width - 2 * x) * unit });
    Object.assign(camera, { top: (height + 2 * y) * unit, bottom: (2 * y - height) * unit, near: size, far: 5 * size });
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }

  // Four samples a pixel at rest, one while it moves; fewer faces, and fewer samples, where drawing all is too slow.
  draw(atRest) {
    const { clientWidth, clientHeight } = this.canvas, strain = atRest ? 0 : this.figure.strain;
    const samples = atRest ? 2 : strain > 3 ? 0.5 : 1;
    const width = Math.round(samples * clientWidth), height = Math.round(samples * clientHeight);
    if (!width || !height) return;
    const wide = Math.round(density * clientWidth), high = Math.round(density * clientHeight);
    this.mesh.geometry.setIndex(strain > 1 ? this.coarse : this.surface.geometry.index);
    this.lines.forEach(({ material, width: line }) => (material.linewidth = samples * line));
    const whole = renderer.getSize(new THREE.Vector2());
    if (whole.x < width || whole.y < height) {
      renderer.setSize(Math.max(whole.x, width), Math.max(whole.y, height), false);
    }
    if (this.canvas.width !== wide || this.canvas.height !== high) {
      Object.assign(this.canvas, { width: wide, height: high });
    }
    this.look();
    renderer.setViewport(0, 0, width, height);
    renderer.setScissor(0, 0, width, height);
    renderer.setScissorTest(true);
    renderer.render(this.scene, this.camera);
    const paper = this.canvas.getContext("2d"), from = renderer.domElement;
    paper.clearRect(0, 0, wide, high);
    paper.imageSmoothingQuality = atRest ? "high" : "low";
    paper.drawImage(from, 0, from.height - height, width, height, 0, 0, wide, high);
  }

  // The vertex nearest to where the line of sight meets the surface; -1 where it meets none.
  under({ clientX, clientY }) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect(), ray = new THREE.Raycaster();
    const place = new THREE.Vector2((2 * (clientX - left)) / width - 1, 1 - (2 * (clientY - top)) / height);
    this.look();
    this.mesh.geometry.setIndex(this.surface.geometry.index);
    ray.setFromCamera(place, this.camera);
    const [hit] = ray.intersectObject(this.mesh, false), { position } = this.mesh.geometry.attributes;
    if (!hit) return -1;
    const apart = (vertex) => new THREE.Vector3().fromBufferAttribute(position, vertex).distanceTo(hit.point);
    return [hit.face.a, hit.face.b, hit.face.c].reduce((one, other) => (apart(other) < apart(one) ? other : one));
  }

  tell(vertex) {
    const value = this.values?.(vertex), { unit, labels } = this.field;
    const name = (known) => (labels ? labels[Math.round(known)] : `${significant(known, 5)} ${unit}`);
    const text = value === undefined ? "" : Number.isNaN(value) ? `: no ${labels ? "label" : "value"}` : `: ${name(value)}`;
    const number = vertex < 0 ? vertex : (this.surface.known?.[vertex] ?? vertex);
    this.told.textContent = vertex < 0 ? " " : `vertex ${number}${text}`.trim();
    Object.assign(this.told.dataset, { vertex: number, value: vertex < 0 ? "" : String(value ?? "") });
  }

  end() {
    const meshes = [this.mesh, this.flat].filter(Boolean);
    [...meshes, ...this.lines].forEach(release);
    meshes.forEach(({ material }) => material.uniforms.table.value?.dispose());
  }
}

function release(drawn) {
  drawn.geometry.dispose();
  drawn.material.dispose();
  return drawn;
}
