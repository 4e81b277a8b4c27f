"use strict";
// Each claim of the page as rows: what was computed here, what is stated, and whether the two agree within rounding. What
// stands above the rows says no number that they do not decide.

const equal = (what, computed, stated, slack) => ({ what, computed, stated, slack, holds: Math.abs(computed - stated) <= slack });
const atMost = (what, computed, bound) => ({ what, computed, bound, holds: computed <= bound });
const ten = (number) => String(Number(number.toPrecision(10)));

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
  const generalised = numbers.model === "TGV";
  if (generalised) rows.push(atMost("imbalance of the dual field at edges", found.imbalance, FEASIBLE));
  return {
    heading: `The map is within a relative gap of ${ten(numbers.tolerance)} of the minimum of ${generalised ? "TGV" : "TV"}(u) + mu/2 |u - f|^2`,
    sentence:
      `On ${surface.n} vertices and ${surface.m} faces no field has an energy below ${ten(stated.lower_bound)}, and this one has ` +
      `${ten(stated.energy)}: the dual field proves it. mu is ${ten(mu)}, by the weight ${ten(numbers.weight)}, the noise ` +
      `${ten(numbers.noise)} and the edge length ${ten(edge)}${generalised ? `; slopes weigh ${ten(numbers.ratio)} edge lengths` : ""}.`,
    rows,
  };
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
  const count = numbers.certified;
  const rows = [
    atMost("residual that differs most from the stated one", apart, allowed),
    atMost("largest relative residual", worst, numbers.tolerance),
    atMost("Rayleigh quotients from the eigenvalues, relatively", drift, Math.max(...found.rounding) + worst),
    equal("orthogonality, largest entry of |X^T B X - I|", found.overlap, stated.orthogonality, 1e-12),
    atMost("the same", found.overlap, 1e-8),
    equal("eigenvalues below the shift, by inertia", found.below, count, 0),
    atMost("certified pairs, of those that are given", count, values.length),
    atMost("largest quotient of the certified span, and the rounding of the shift", found.top + found.margin, numbers.shift),
    ...(Number.isFinite(found.next) ? [atMost("shift, below the next pair", numbers.shift, found.next)] : []),
    equal("area", surface.area, stated.area, 1e-12 * surface.area),
    atMost("entries at a fixed boundary", found.fixed, 0),
  ];
  return {
    heading: `The first ${count} of ${values.length} eigenpairs are the lowest ones, and none is missing`,
    sentence:
      `On ${surface.n} vertices exactly ${count} eigenvalues lie below ${ten(numbers.shift)}: so many pivots of L D L^T are ` +
      `negative. Mass: ${numbers.mass}; boundary: ${numbers.boundary}; largest relative residual: ${ten(numbers.tolerance)}.`,
    rows,
  };
}

function signRows({ numbers, stated }, arrays, claims, all) {
  const { dimension } = numbers;
  const certified = numbers.spectra.map((place) => (claims[place].kind === "spectrum" ? claims[place].numbers.certified : 0));
  const given = numbers.spectra.map((place) => all[place].values.length);
  const [source, target] = numbers.spectra.map((place) => {
    const { vertices, faces, values, vectors } = all[place];
    return embedding(geometry(vertices, faces), values, vectors, numbers.dimension, numbers.weighting);
  });
  const found = checkedSigns(source, target, arrays.signs, arrays.closed, arrays.correspondence);
  const rounding = found.rounding + 1e-12 * found.value;
  const rows = [
    atMost("eigenfunctions and the constant, of those that each surface has", dimension + 1, Math.min(...given)),
    equal("eigenfunctions with a sign of 1 or -1", arrays.signs.filter((sign) => Math.abs(sign) === 1).length, dimension, 0),
    equal("distance", found.value, stated.value, rounding),
    equal("share of the choices of signs that was decided", found.share, 1, 0),
    atMost("stated lower bound above the one computed", stated.lower_bound - found.lowerBound, rounding),
    atMost("label farther than the nearest point, squared", found.excess, found.lost),
  ];
  if (stated.optimal) rows.push(atMost("distance above the lower bound of all signs", found.value - found.lowerBound, rounding));
  // a last one that is not apart from the next belongs to a cluster, of which any part may be taken
  const lowest = Math.min(dimension, Math.min(...certified) - 1);
  const proved = stated.optimal ? "no other signs give less" : `no signs give less than ${ten(stated.lower_bound)}`;
  return {
    heading: `The distance is ${ten(stated.value)}, and ${proved}`,
    sentence:
      `${found.searched} bounds decide all ${2 ** dimension} choices of signs of ${dimension} eigenfunctions, weighted as ` +
      `${numbers.weighting}; ${lowest === dimension ? "all" : `the first ${lowest}`} of these are proved to be the lowest ones. The label of each of the ${target.count} vertices of the target is its nearest of the ${source.count} of the source.`,
    rows,
  };
}

const CHECKS = { "duality gap": gapRows, spectrum: spectrumRows, signs: signRows };

function digestRows(claim) {
  return Object.entries(claim.arrays).map(([name, array]) => {
    const computed = sha256(bytesOf(array.data));
    return { what: `SHA-256 of ${name}`, bytes: true, computed, stated: array.sha256, holds: computed === array.sha256 };
  });
}

// Which surface of a distance a spectrum belongs to, as the start of its heading.
function roleOf(claims, place) {
  const signs = claims.find((claim) => claim.kind === "signs" && claim.numbers.spectra.includes(place));
  return signs ? `${["source", "target"][signs.numbers.spectra.indexOf(place)]}: ` : "";
}

// What one claim says, and its rows; what cannot be computed is a row that does not hold.
function computedClaim(claims, place) {
  const claim = claims[place];
  const rows = digestRows(claim);
  let [heading, sentence] = ["This claim cannot be computed", ""];
  try {
    const all = claims.map(({ arrays }) => new Proxy(arrays, { get: (known, name) => known[name] && decoded(known[name]) }));
    const arrays = Object.fromEntries(Object.entries(claim.arrays).map(([name, array]) => [name, decoded(array)]));
    const found = CHECKS[claim.kind](claim, arrays, claims, all);
    rows.unshift(...found.rows);
    ({ heading, sentence } = found);
    heading = roleOf(claims, place) + heading;
    if (arrays.rows) sentence += ` They are a part of the surface that was given: row k stands in row rows[k] of it.`;
  } catch (error) {
    rows.unshift({ what: "what stopped the computation", computed: error.message, holds: false });
  }
  return { heading, sentence, rows };
}

const holds = (rows) => rows.length > 0 && rows.every((row) => row.holds === true);
