"use strict";
// Residuals, orthogonality and completeness of eigenpairs of A x = lambda B x on a surface.

function freeVertices(surface, boundary) {
  const free = new Uint8Array(surface.n).fill(1);
  if (boundary === "neumann") return free;
  if (boundary !== "dirichlet") throw new Error(`boundary ${boundary} is unknown`);
  const { counts, keys } = edgesOf(surface);
  keys.forEach((key, k) => {
    if (counts[k] === 1) free[key % surface.n] = free[Math.floor(key / surface.n)] = 0;
  });
  return free;
}

// A matrix over the free vertices, numbered in their order.
function restricted({ starts, columns, entries }, free) {
  const number = new Int32Array(free.length).fill(-1);
  let count = 0;
  free.forEach((is, i) => is && (number[i] = count++));
  const rows = Array.from({ length: count }, () => new Map());
  free.forEach((is, i) => {
    if (!is) return;
    for (let p = starts[i]; p < starts[i + 1]; p++)
      if (free[columns[p]]) rows[number[i]].set(number[columns[p]], entries[p]);
  });
  return compressed(rows);
}

const dot = (x, y) => {
  let sum = 0;
  for (let i = 0; i < x.length; i++) sum += x[i] * y[i];
  return sum;
};

// No quotient of a vector in the span exceeds this, by the circles of Gershgorin: so many eigenvalues lie at or below it.
function largestOfSpan(columns, forces, masses) {
  const [most, overlap] = [new Float64Array(columns.length), new Float64Array(columns.length)];
  columns.forEach((vector, k) =>
    columns.forEach((_, l) => {
      const energy = dot(vector, forces[l]);
      most[k] += k === l ? energy : Math.abs(energy);
      overlap[k] += Math.abs(dot(vector, masses[l]) - (k === l ? 1 : 0));
    }),
  );
  return Math.max(...most) / (1 - Math.max(...overlap));
}

// values (k), vectors (k, n): one row a pair; shift and order of the elimination.
function checkedSpectrum(surface, values, vectors, { mass: massKind, boundary, shift, order, certified: certifiedPairs }) {
  const whole = pencil(surface, massKind);
  const free = freeVertices(surface, boundary);
  const [stiffness, mass] = [whole.stiffness, whole.mass].map((matrix) => restricted(matrix, free));
  const inside = (rows) => Float64Array.from(rows.filter((_, i) => free[i]));
  const [stiffnessRounding, massRounding] = [whole.stiffnessRounding, whole.massRounding].map(inside);
  const count = values.length;
  const shifted = { ...stiffness, entries: new Float64Array(stiffness.entries.length) };
  // both matrices have the same pattern: they are filled side by side
  for (let p = 0; p < shifted.entries.length; p++) shifted.entries[p] = stiffness.entries[p] - shift * mass.entries[p];
  const factors = inertia(shifted, order);
  const spacing = shift / factors.negative;
  const columns = Array.from({ length: count }, (_, k) => inside(vectors.subarray(k * surface.n, (k + 1) * surface.n)));
  let fixed = 0;
  for (let k = 0; k < count; k++)
    for (let i = 0; i < surface.n; i++) if (!free[i]) fixed = Math.max(fixed, Math.abs(vectors[k * surface.n + i]));
  const masses = columns.map((vector) => product(mass, vector));
  const [residuals, rounding, rayleigh, forces] = [[], [], [], []];
  columns.forEach((vector, k) => {
    const left = product(stiffness, vector);
    const difference = left.map((entry, i) => entry - values[k] * masses[k][i]);
    const size = Math.sqrt(dot(masses[k], masses[k]));
    const scale = Math.max(Math.abs(values[k]), spacing);
    const [rough, heavy] = [product(stiffness, vector, true), product(mass, vector, true)];
    const largest = vector.reduce((most, entry) => Math.max(most, Math.abs(entry)), 0);
    const lost = rough.map((entry, i) => 32 * EPSILON * (entry + Math.abs(values[k]) * heavy[i]) + (stiffnessRounding[i] + Math.abs(values[k]) * massRounding[i]) * largest);
    forces.push(left);
    residuals.push(Math.sqrt(dot(difference, difference)) / size / scale);
    rounding.push(Math.sqrt(dot(lost, lost)) / size / scale);
    rayleigh.push(dot(vector, left) / dot(vector, masses[k]));
  });
  let overlap = 0;
  for (let k = 0; k < count; k++)
    for (let l = k; l < count; l++) overlap = Math.max(overlap, Math.abs(dot(columns[k], masses[l]) - (k === l ? 1 : 0)));
  // no eigenvalue of B is below this: a quarter of the least lumped mass for the consistent one
  const leastMass = inside(surface.mass).reduce((least, share) => Math.min(least, share), Infinity) / (massKind === "lumped" ? 1 : 4);
  const assembly = stiffnessRounding.reduce((most, lost, i) => Math.max(most, lost + Math.abs(shift) * massRounding[i]), 0);
  return {
    residuals,
    rounding,
    rayleigh,
    overlap,
    fixed,
    spacing,
    below: factors.negative,
    smallestPivot: factors.smallest,
    entries: factors.entries,
    margin: (factors.error + assembly) / leastMass,
    top: largestOfSpan(columns.slice(0, certifiedPairs), forces, masses),
    next: certifiedPairs < count ? values[certifiedPairs] : Infinity,
  };
}
