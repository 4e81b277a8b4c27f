"use strict";
// Surfaces and lines as three.js draws them, in the light of the still pictures.
const VERTEX = `
  attribute vec2 shade;
  varying vec2 shaded;
  varying vec3 turned;
  void main() {
    shaded = shade;
    turned = normalMatrix * normal;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;
// x of `shaded` is the place between the limits, y is 0 where all corners have a value
const TABLE_WIDTH = 1024, FAR = 1e6;
const FRAGMENT = `
  const int TABLE_WIDTH = ${TABLE_WIDTH};
  uniform highp sampler2D table;
  uniform int missing;
  uniform float shading;
  varying vec2 shaded;
  varying vec3 turned;
  const vec3 KEY = vec3(-0.450, 0.620, 0.643), FILL = vec3(0.750, -0.050, 0.660), BACK_TINT = vec3(0.26, 0.34, 0.48);
  const float KEY_STRENGTH = 0.66, FILL_STRENGTH = 0.20, SKY = 0.34, GROUND = 0.22, WRAP = 0.25, RIM_DARKENING = 0.35;
  const float BACK_SHARE = 0.45;
  float illumination(vec3 n) {
    float light = 0.5 * (SKY + GROUND) + 0.5 * (SKY - GROUND) * n.y;
    light += (KEY_STRENGTH * max(dot(KEY, n) + WRAP, 0.0) + FILL_STRENGTH * max(dot(FILL, n) + WRAP, 0.0)) / (1.0 + WRAP);
    float rim = 1.0 - clamp(n.z, 0.0, 1.0);
    return light * (1.0 - RIM_DARKENING * rim * rim * rim);
  }
  void main() {
    int entry = shaded.y > 0.0 ? missing : int(clamp(floor(shaded.x * float(missing)), 0.0, float(missing - 1)));
    vec3 color = texelFetch(table, ivec2(entry % TABLE_WIDTH, entry / TABLE_WIDTH), 0).rgb;
    float received = 1.0 + shading * (illumination(normalize(turned) * (gl_FrontFacing ? 1.0 : -1.0)) - 1.0);
    color = received * mix(color, BACK_TINT, gl_FrontFacing ? 0.0 : BACK_SHARE);
    gl_FragColor = vec4(pow(clamp(color, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
  }`;

// Labels are flat: a point takes the label of the corner nearest to it, of three that all corners of its face know.
const FLAT_VERTEX = `
  attribute vec3 labels;
  flat varying vec3 known;
  varying vec3 shares;
  varying vec3 turned;
  void main() {
    int corner = gl_VertexID % 3;
    known = labels;
    shares = vec3(corner == 0, corner == 1, corner == 2);
    turned = normalMatrix * normal;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;
const FLAT_FRAGMENT = FRAGMENT.replace("varying vec2 shaded;", "flat varying vec3 known;\n  varying vec3 shares;").replace(
  /int entry = .*;/,
  `float label = shares.x > shares.y ? (shares.x > shares.z ? known.x : known.z) : (shares.y > shares.z ? known.y : known.z);
    int entry = label < 0.0 ? missing : int(label + 0.5);`,
);

// What panels share of a surface: positions about the middle of its box, normals, faces.
async function readSurface({ positions, faces, outside, origin }) {
  const [at, corners, known] = await Promise.all([numbersOf(positions), codesOf(faces), origin && codesOf(origin)]);
  const middle = positions.low.map((low, k) => low + 0.5 * positions.step[k] * (GAP - positions.gaps));
  const geometry = new THREE.BufferGeometry(), places = new Float32Array(3 * at.rows);
  let radius = 0;
  for (let row = 0; row < at.rows; row++) {
    let squared = 0;
    for (let k = 0; k < 3; k++) squared += (places[3 * row + k] = at(row, k) - middle[k]) ** 2;
    radius = Math.max(radius, Math.sqrt(squared) || 0);
  }
  geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
  geometry.setIndex(new THREE.BufferAttribute(corners, 1));
  geometry.computeVertexNormals();
  const side = outside ? THREE.FrontSide : THREE.DoubleSide;
  return { geometry, middle, radius, side, known };
}

// Faces between representatives of the cells of a grid, some ten thousand: what turns where drawing all is too slow.
function coarseFaces({ index, attributes: { position } }, radius) {
  const cell = 0.03 * radius, first = new Map(), kept = [];
  const places = position.array, steps = Math.ceil((2 * radius) / cell) + 2;
  const step = (vertex, k) => Math.floor((places[3 * vertex + k] + radius) / cell);
  const nearest = Array.from({ length: position.count }, (_, vertex) => {
    const key = (step(vertex, 0) * steps + step(vertex, 1)) * steps + step(vertex, 2);
    if (!first.has(key)) first.set(key, vertex);
    return first.get(key);
  });
  for (let i = 0; i < index.count; i += 3) {
    const [a, b, c] = [nearest[index.array[i]], nearest[index.array[i + 1]], nearest[index.array[i + 2]]];
    if (a !== b && b !== c && c !== a) kept.push(a, b, c);
  }
  return new THREE.BufferAttribute(new index.array.constructor(kept), 1);
}

function surfaceMesh({ geometry, radius, side }) {
  const own = new THREE.BufferGeometry(), count = geometry.attributes.position.count;
  own.setIndex(geometry.index);
  for (const name of ["position", "normal"]) own.setAttribute(name, geometry.attributes[name]);
  own.setAttribute("shade", new THREE.BufferAttribute(new Float32Array(2 * count), 2));
  own.boundingSphere = new THREE.Sphere(new THREE.Vector3(), radius);
  return new THREE.Mesh(own, surfaceMaterial(VERTEX, FRAGMENT, side));
}

// Corners of their own for each face.
function flatMesh({ geometry, radius, side }) {
  const own = geometry.toNonIndexed(), count = own.attributes.position.count;
  own.setAttribute("labels", new THREE.BufferAttribute(new Float32Array(3 * count), 3));
  own.boundingSphere = new THREE.Sphere(new THREE.Vector3(), radius);
  return new THREE.Mesh(own, surfaceMaterial(FLAT_VERTEX, FLAT_FRAGMENT, side));
}

function surfaceMaterial(vertexShader, fragmentShader, side) {
  return new THREE.ShaderMaterial({
    vertexShader,
    fragmentShader,
    uniforms: { table: { value: null }, missing: { value: 0 }, shading: { value: 1 } },
    side,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}

// Colours from the lower limit to the upper, then that of no value.
async function readTable(described) {
  const codes = await codesOf(described), count = codes.length / 3, pixels = new Uint8ClampedArray(4 * count).fill(255);
  for (let k = 0; k < count; k++) pixels.set(codes.subarray(3 * k, 3 * k + 3), 4 * k);
  return pixels;
}

// Rows of so many colours, since a texture has a largest width.
function tableTexture(pixels) {
  const count = pixels.length / 4, rows = Math.ceil(count / TABLE_WIDTH), linear = new Float32Array(4 * TABLE_WIDTH * rows);
  pixels.forEach((channel, k) => (linear[k] = (channel / 255) ** 2.2));
  return new THREE.DataTexture(linear, TABLE_WIDTH, rows, THREE.RGBAFormat, THREE.FloatType);
}

function paint(mesh, field, values, pixels, corners) {
  const shade = mesh.geometry.attributes.shade, { uniforms } = mesh.material;
  const [low, high] = field.limits ?? [0, 1];
  for (let row = 0; shade && row < shade.count; row++) {
    const value = values ? values(row) : low, missing = Number.isNaN(value);
    // far beyond the limits a number of 32 bits would be infinite
    shade.setXY(row, missing ? 0 : Math.max(-FAR, Math.min(FAR, (value - low) / (high - low))), missing ? 1 : 0);
  }
  if (shade) shade.needsUpdate = true;
  else labelFaces(mesh.geometry.attributes.labels, corners, values);
  uniforms.table.value?.dispose();
  uniforms.table.value = tableTexture(pixels);
  uniforms.table.value.needsUpdate = true;
  uniforms.missing.value = pixels.length / 4 - 1;
  uniforms.shading.value = field.shading;
}

function labelFaces(labels, corners, values) {
  const code = (vertex) => { const value = values(vertex); return Number.isNaN(value) ? -1 : Math.round(value); };
  for (let i = 0; i < corners.length; i += 3) {
    const [a, b, c] = [code(corners[i]), code(corners[i + 1]), code(corners[i + 2])];
    for (let k = 0; k < 3; k++) labels.setXYZ(i + k, a, b, c);
  }
  labels.needsUpdate = true;
}

async function lineMesh(described, middle, order) {
  const [at, segments] = await Promise.all([numbersOf(described.points), codesOf(described.segments)]);
  const ends = new Float32Array(3 * segments.length);
  segments.forEach((point, i) => middle.forEach((centre, k) => (ends[3 * i + k] = at(point, k) - centre)));
  const geometry = new THREE.LineSegmentsGeometry().setPositions(ends);
  const { color, width, through } = described;
  const material = new THREE.LineMaterial({ color, linewidth: width, depthTest: !through, depthWrite: false });
  const lines = new THREE.LineSegments2(geometry, material);
  // lines seen through the surface come last, each over the one before it
  Object.assign(lines, { width, frustumCulled: false, renderOrder: (through ? 1000 : 1) + order });
  return lines;
}
