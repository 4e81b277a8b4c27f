"use strict";
// The spectral distance of two surfaces and its search over signs: every choice of signs is decided, each bound is computed.

const WEIGHTS = { biharmonic: (value) => 1 / value, global_point: (value) => 1 / Math.sqrt(value) };

// The surface scaled to area 1 as points (n, dimension) of its first eigenfunctions after the constant.
function embedding(surface, values, vectors, dimension, weighting) {
  const { n, area, mass } = surface;
  if (!(weighting in WEIGHTS)) throw new Error(`weighting ${weighting} is unknown`);
  const points = new Float64Array(n * dimension);
  for (let k = 0; k < dimension; k++) {
    const factor = Math.sqrt(area) * WEIGHTS[weighting](values[k + 1] * area);
    for (let i = 0; i < n; i++) points[i * dimension + k] = vectors[(k + 1) * n + i] * factor;
  }
  return { points, weights: mass.map((share) => share / area), count: n, dimension };
}

// Decided signs multiply the source; undecided coordinates are compared by their absolute values, the least any sign gives.
function arranged({ points, dimension }, signs, own) {
  return points.map((value, at) => {
    const sign = signs[at % dimension];
    return sign === 0 ? Math.abs(value) : own ? sign * value : value;
  });
}

// Squared distance to the nearest target of each source point, and back, with the row that is nearest to each target.
function nearestSquares(source, target, dimension) {
  const [s, t] = [source.length / dimension, target.length / dimension];
  const [forward, backward] = [new Float64Array(s).fill(Infinity), new Float64Array(t).fill(Infinity)];
  for (let i = 0; i < s; i++) {
    const a = i * dimension;
    for (let j = 0; j < t; j++) {
      const b = j * dimension;
      const far = Math.max(forward[i], backward[j]);
      let square = 0;
      for (let k = 0; k < dimension && square < far; k++) {
        const difference = source[a + k] - target[b + k];
        square += difference * difference;
      }
      if (square < forward[i]) forward[i] = square;
      if (square < backward[j]) backward[j] = square;
    }
  }
  return { forward, backward };
}

function meanHausdorff(source, target, signs) {
  const [own, other] = [arranged(source, signs, true), arranged(target, signs, false)];
  const { forward, backward } = nearestSquares(own, other, source.dimension);
  const mean = (squares, weights) => {
    const sum = new Sum();
    squares.forEach((square, i) => sum.add(weights[i] * Math.sqrt(square)));
    return sum.value;
  };
  return { value: Math.max(mean(forward, source.weights), mean(backward, target.weights)), forward, backward };
}

// closed (c, n): the decided signs at which the search turned back; together they must be all 2^n, each once.
function coverage(closed, n) {
  const rows = Array.from({ length: closed.length / n }, (_, r) => closed.subarray(r * n, (r + 1) * n));
  let share = 0;
  rows.forEach((row, r) => {
    if (row.some((sign) => ![-1, 0, 1].includes(sign))) throw new Error("a sign is none of -1, 0, 1");
    share += 2 ** -row.reduce((known, sign) => known + Math.abs(sign), 0);
    for (const other of rows.slice(0, r))
      if (!row.some((sign, k) => sign * other[k] === -1)) throw new Error("a choice of signs is decided twice");
  });
  return { rows, share };
}

function checkedSigns(source, target, signs, closed, correspondence) {
  const n = source.dimension;
  const found = meanHausdorff(source, target, signs);
  const { rows, share } = coverage(closed, n);
  const bounds = rows.map((row) => meanHausdorff(source, target, row).value);
  const norm = (points, i) => dot(points.subarray(i * n, i * n + n), points.subarray(i * n, i * n + n));
  const largest = ({ points, count }) => Array.from({ length: count }, (_, i) => norm(points, i)).reduce((a, b) => Math.max(a, b));
  const lost = 8 * (n + 8) * EPSILON * (largest(source) + largest(target));
  let [excess, rounding] = [0, 0];
  correspondence.forEach((row, j) => {
    if (!(row >= 0 && row < source.count)) throw new Error(`vertex ${j} is mapped to ${row}`);
    let square = 0;
    for (let k = 0; k < n; k++) square += (signs[k] * source.points[row * n + k] - target.points[j * n + k]) ** 2;
    excess = Math.max(excess, square - found.backward[j]);
  });
  const slack = (squares, weights) => squares.reduce((sum, square, i) => sum + weights[i] * Math.min(Math.sqrt(lost), lost / Math.sqrt(square)), 0);
  rounding = Math.max(slack(found.forward, source.weights), slack(found.backward, target.weights));
  return { value: found.value, lowerBound: Math.min(...bounds), share, excess, lost, rounding, searched: rows.length };
}
