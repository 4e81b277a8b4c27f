"use strict";
// Inertia by L D L^T of a sparse symmetric matrix, row by row along the elimination tree, and a bound of its backward error.

function inverseOrder(order) {
  const place = new Int32Array(order.length).fill(-1);
  order.forEach((vertex, k) => {
    if (!(vertex >= 0 && vertex < order.length) || place[vertex] >= 0) throw new Error("the order is no permutation");
    place[vertex] = k;
  });
  return place;
}

// How many pivots are negative, and the largest row sum of |E| where L D L^T = matrix + E.
function inertia(matrix, order) {
  const n = matrix.starts.length - 1;
  if (order.length !== n) throw new Error(`the order has ${order.length} of ${n} rows`);
  const place = inverseOrder(order);
  const [parent, flag, counts] = [new Int32Array(n).fill(-1), new Int32Array(n).fill(-1), new Int32Array(n)];
  const climb = (k, visit) => {
    flag[k] = k;
    const row = order[k];
    for (let p = matrix.starts[row]; p < matrix.starts[row + 1]; p++)
      if (place[matrix.columns[p]] < k) visit(place[matrix.columns[p]], matrix.entries[p]);
  };
  for (let k = 0; k < n; k++)
    climb(k, (i) => {
      for (; flag[i] !== k; i = parent[i]) {
        if (parent[i] < 0) parent[i] = k;
        counts[i] += 1;
        flag[i] = k;
      }
    });
  const starts = new Int32Array(n + 1);
  for (let k = 0; k < n; k++) starts[k + 1] = starts[k] + counts[k];
  const [rows, lower, pivots] = [new Int32Array(starts[n]), new Float64Array(starts[n]), new Float64Array(n)];
  const [ends, work, pattern, path] = [starts.slice(0, n), new Float64Array(n), new Int32Array(n), new Int32Array(n)];
  flag.fill(-1);
  let longest = 0;
  for (let k = 0; k < n; k++) {
    let top = n;
    let pivot = 0;
    const row = order[k];
    for (let p = matrix.starts[row]; p < matrix.starts[row + 1]; p++)
      if (matrix.columns[p] === row) pivot += matrix.entries[p];
    climb(k, (i, entry) => {
      work[i] += entry;
      let length = 0;
      for (; flag[i] !== k; i = parent[i]) {
        path[length++] = i;
        flag[i] = k;
      }
      while (length) pattern[--top] = path[--length];
    });
    longest = Math.max(longest, n - top);
    for (; top < n; top++) {
      const i = pattern[top];
      const value = work[i];
      work[i] = 0;
      for (let p = starts[i]; p < ends[i]; p++) work[rows[p]] -= lower[p] * value;
      const factor = value / pivots[i];
      pivot -= factor * value;
      rows[ends[i]] = k;
      lower[ends[i]++] = factor;
    }
    if (!(Math.abs(pivot) > 0 && Number.isFinite(pivot))) throw new Error(`pivot ${k} is ${pivot}: choose another shift`);
    pivots[k] = pivot;
  }
  return {
    negative: pivots.reduce((count, pivot) => count + (pivot < 0 ? 1 : 0), 0),
    smallest: pivots.reduce((least, pivot) => Math.min(least, Math.abs(pivot)), Infinity),
    entries: starts[n],
    error: 2 * EPSILON * (longest + 4) * largestRow(starts, rows, lower, pivots),
  };
}

// Largest row sum of |L| |D| |L^T|.
function largestRow(starts, rows, lower, pivots) {
  const n = pivots.length;
  const middle = new Float64Array(n);
  for (let k = 0; k < n; k++) {
    middle[k] = 1;
    for (let p = starts[k]; p < starts[k + 1]; p++) middle[k] += Math.abs(lower[p]);
    middle[k] *= Math.abs(pivots[k]);
  }
  const sums = middle.slice();
  for (let k = 0; k < n; k++)
    for (let p = starts[k]; p < starts[k + 1]; p++) sums[rows[p]] += Math.abs(lower[p]) * middle[k];
  return sums.reduce((largest, sum) => Math.max(largest, sum), 0);
}
