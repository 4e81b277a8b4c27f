"use strict";
// Linear elements on triangles: hat gradients in the frame of each face, areas, masses, stiffness, and their rounding.

const EPSILON = Number.EPSILON;

// areas (m), hats (m, 3, 2), mass (n), sharpness (m): product of two sides over twice the area, by which rounding grows.
function geometry(vertices, faces) {
  const n = vertices.length / 3;
  const m = faces.length / 3;
  const [areas, hats, sharpness] = [new Float64Array(m), new Float64Array(6 * m), new Float64Array(m)];
  const mass = new Float64Array(n);
  for (const index of faces) if (!(index >= 0 && index < n)) throw new Error(`a face has vertex ${index} of ${n}`);
  for (let f = 0; f < m; f++) {
    const [a, b, c] = [3 * faces[3 * f], 3 * faces[3 * f + 1], 3 * faces[3 * f + 2]];
    const [ux, uy, uz] = [0, 1, 2].map((k) => vertices[b + k] - vertices[a + k]);
    const [vx, vy, vz] = [0, 1, 2].map((k) => vertices[c + k] - vertices[a + k]);
    const [nx, ny, nz] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const twice = Math.sqrt(nx * nx + ny * ny + nz * nz);
    if (!(twice > 0)) throw new Error(`face ${f} has no area`);
    const side = Math.sqrt(ux * ux + uy * uy + uz * uz);
    const along = (ux * vx + uy * vy + uz * vz) / side;
    areas[f] = 0.5 * twice;
    sharpness[f] = (side * Math.sqrt(vx * vx + vy * vy + vz * vz)) / twice;
    hats.set([-1 / side, (along - side) / twice, 1 / side, -along / twice, 0, side / twice], 6 * f);
    for (let k = 0; k < 3; k++) mass[faces[3 * f + k]] += areas[f] / 3;
  }
  mass.forEach((share, vertex) => {
    if (!(share > 0)) throw new Error(`vertex ${vertex} belongs to no face`);
  });
  return { n, m, faces, areas, hats, mass, sharpness, area: total(areas) };
}

function total(numbers) {
  const sum = new Sum();
  for (const number of numbers) sum.add(number);
  return sum.value;
}

// Relative rounding of a hat gradient times an area: 32 machine epsilons times the sharpness of the face, to first order.
const hatRounding = (surface, f) => 32 * EPSILON * surface.sharpness[f];

// Edges as keys, each with its faces: smaller vertex first; the edge opposite each corner.
function edgesOf({ n, m, faces }) {
  const number = new Map();
  const counts = [];
  const keys = [];
  const opposite = new Int32Array(3 * m);
  for (let f = 0; f < m; f++)
    for (let k = 0; k < 3; k++) {
      const [tail, head] = [faces[3 * f + ((k + 1) % 3)], faces[3 * f + ((k + 2) % 3)]];
      const key = Math.min(tail, head) * n + Math.max(tail, head);
      if (!number.has(key)) {
        number.set(key, keys.length);
        keys.push(key);
        counts.push(0);
      }
      opposite[3 * f + k] = number.get(key);
      counts[opposite[3 * f + k]] += 1;
    }
  // numbered in the order of their vertices, as Python numbers them
  const order = keys.map((_, k) => k).sort((a, b) => keys[a] - keys[b]);
  const rank = new Int32Array(keys.length);
  order.forEach((old, now) => (rank[old] = now));
  return { opposite: opposite.map((k) => rank[k]), counts: order.map((k) => counts[k]), keys: order.map((k) => keys[k]) };
}

// Rows of stiffness and mass as maps from column to entry, with the sum of what rounding may have moved in each row.
function pencil(surface, massKind) {
  const { n, m, faces, areas, hats } = surface;
  if (massKind !== "consistent" && massKind !== "lumped") throw new Error(`mass ${massKind} is unknown`);
  const [stiffness, mass] = [0, 1].map(() => Array.from({ length: n }, () => new Map()));
  const [stiffnessRounding, massRounding] = [new Float64Array(n), new Float64Array(n)];
  const add = (rows, i, j, entry) => rows[i].set(j, (rows[i].get(j) ?? 0) + entry);
  for (let f = 0; f < m; f++)
    for (let k = 0; k < 3; k++)
      for (let l = 0; l < 3; l++) {
        const [i, j, at] = [faces[3 * f + k], faces[3 * f + l], 6 * f];
        const [x, y] = [hats[at + 2 * k], hats[at + 2 * k + 1]];
        const [z, w] = [hats[at + 2 * l], hats[at + 2 * l + 1]];
        const share = massKind === "lumped" ? (k === l ? areas[f] / 3 : 0) : (areas[f] / 12) * (k === l ? 2 : 1);
        add(stiffness, i, j, areas[f] * (x * z + y * w));
        add(mass, i, j, share);
        stiffnessRounding[i] += 2 * hatRounding(surface, f) * areas[f] * Math.hypot(x, y) * Math.hypot(z, w);
        massRounding[i] += hatRounding(surface, f) * share;
      }
  return { stiffness: compressed(stiffness), mass: compressed(mass), stiffnessRounding, massRounding };
}

function compressed(rows) {
  const starts = new Int32Array(rows.length + 1);
  rows.forEach((row, i) => (starts[i + 1] = starts[i] + row.size));
  const [columns, entries] = [new Int32Array(starts[rows.length]), new Float64Array(starts[rows.length])];
  rows.forEach((row, i) => {
    let p = starts[i];
    for (const [column, entry] of row) [columns[p], entries[p++]] = [column, entry];
  });
  return { starts, columns, entries };
}

function product({ starts, columns, entries }, vector, absolute = false) {
  const result = new Float64Array(starts.length - 1);
  for (let i = 0; i < result.length; i++)
    for (let p = starts[i]; p < starts[i + 1]; p++)
      result[i] += absolute ? Math.abs(entries[p] * vector[columns[p]]) : entries[p] * vector[columns[p]];
  return result;
}
