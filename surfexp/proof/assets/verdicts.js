"use strict";
// Each claim of the page as rows: what was computed here, what is stated, and whether the two agree within rounding.

const equal = (what, computed, stated, slack) => ({ what, computed, stated, slack, holds: Math.abs(computed - stated) <= slack });
const atMost = (what, computed, bound) => ({ what, computed, bound, holds: computed <= bound });

function gapRows({ numbers, stated }, arrays) {
  const surface = geometry(arrays.vertices, arrays.faces);
  const edge = Math.sqrt(((surface.area / surface.m) * 4) / Math.sqrt(3));
  const mu = numbers.weight / (numbers.noise * edge);
  const { map, values, dual, slopes } = arrays;
  const found =
    numbers.model === "TGV"
      ? generalisedVariationGap(surface, map, values, slopes, dual, mu, numbers.ratio * edge)
      : totalVariationGap(surface, map, values, dual, mu);
  const { rounding, scale } = found;
  const slope = found.errorBound > 0 ? rounding / (found.errorBound * mu * surface.area) : 0;
  const error = Math.min(Math.sqrt((2 * rounding) / mu / surface.area), slope);
  const rows = [
    equal("energy", found.energy, stated.energy, rounding),
    equal("lower bound", found.lowerBound, stated.lower_bound, rounding),
    equal("relative gap", found.gap / scale, stated.relative_gap, (2 * rounding) / scale),
    atMost("relative gap and its rounding", (found.gap + 2 * rounding) / scale, numbers.tolerance),
    equal("largest distance to the minimiser, root mean square", found.errorBound, stated.error_bound, 2 * error + 1e-12 * found.errorBound),
    atMost("length of the dual field, less 1", found.longest - 1, FEASIBLE),
    atMost("lower bound above the energy", found.lowerBound - found.energy, rounding),
  ];
  if (numbers.model === "TGV") rows.push(atMost("imbalance of the dual field at edges", found.imbalance, FEASIBLE));
  return rows;
}

function spectrumRows({ numbers, stated }, arrays) {
  const surface = geometry(arrays.vertices, arrays.faces);
  const { values, vectors, order, residuals } = arrays;
  const found = checkedSpectrum(surface, values, vectors, { ...numbers, order });
  let [apart, allowed, worst] = [0, 1, 0];
  found.residuals.forEach((residual, k) => {
    const slack = 2 * found.rounding[k];
    if (Math.abs(residual - residuals[k]) / slack > apart / allowed) [apart, allowed] = [Math.abs(residual - residuals[k]), slack];
    worst = Math.max(worst, residual);
  });
  const drift = found.rayleigh.reduce((most, value, k) => Math.max(most, Math.abs(value - values[k]) / Math.max(values[k], found.spacing)), 0);
  return [
    atMost("residual that differs most from the stated one", apart, allowed),
    atMost("largest relative residual", worst, numbers.tolerance),
    atMost("Rayleigh quotients from the eigenvalues, relatively", drift, Math.max(...found.rounding) + worst),
    equal("orthogonality, largest entry of |X^T B X - I|", found.overlap, stated.orthogonality, 1e-12),
    atMost("the same", found.overlap, 1e-8),
    equal("eigenvalues below the shift, by inertia", found.below, numbers.certified, 0),
    atMost("largest quotient of the certified span, and the rounding of the shift", found.top + found.margin, numbers.shift),
    ...(Number.isFinite(found.next) ? [atMost("shift, below the next pair", numbers.shift, found.next)] : []),
    equal("area", surface.area, stated.area, 1e-12 * surface.area),
    atMost("entries at a fixed boundary", found.fixed, 0),
  ];
}

function signRows({ numbers, stated }, arrays, claims, all) {
  const [source, target] = numbers.spectra.map((place) => {
    const { vertices, faces, values, vectors } = all[place];
    return embedding(geometry(vertices, faces), values, vectors, numbers.dimension, numbers.weighting);
  });
  const found = checkedSigns(source, target, arrays.signs, arrays.closed, arrays.correspondence);
  const rounding = found.rounding + 1e-12 * found.value;
  return [
    equal("distance", found.value, stated.value, rounding),
    equal("share of the choices of signs that was decided", found.share, 1, 0),
    atMost("distance above the lower bound of all signs", found.value - found.lowerBound, stated.optimal ? rounding : Infinity),
    atMost("stated lower bound above the one computed", stated.lower_bound - found.lowerBound, rounding),
    atMost("label farther than the nearest point, squared", found.excess, found.lost),
  ];
}

const CHECKS = { "duality gap": gapRows, spectrum: spectrumRows, signs: signRows };

function digestRows(claim) {
  return Object.entries(claim.arrays).map(([name, array]) => {
    const computed = sha256(bytesOf(array.data));
    return { what: `SHA-256 of ${name}`, bytes: true, computed, stated: array.sha256, holds: computed === array.sha256 };
  });
}

// Rows of one claim; what cannot be computed is a row that does not hold.
function rowsOf(claims, place) {
  const claim = claims[place];
  const rows = digestRows(claim);
  try {
    const all = claims.map(({ arrays }) => new Proxy(arrays, { get: (known, name) => known[name] && decoded(known[name]) }));
    const arrays = Object.fromEntries(Object.entries(claim.arrays).map(([name, array]) => [name, decoded(array)]));
    rows.unshift(...CHECKS[claim.kind](claim, arrays, claims, all));
  } catch (error) {
    rows.unshift({ what: "what stopped the computation", computed: error.message, holds: false });
  }
  return rows;
}

const holds = (rows) => rows.length > 0 && rows.every((row) => row.holds === true);
