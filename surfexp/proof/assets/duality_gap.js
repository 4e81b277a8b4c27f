"use strict";
// Energy, lower bound and gap of a denoised map: total variation, and total generalised variation of second order.

const FEASIBLE = 1e-9;

// TV(u) + mu/2 |u - f|^2 and its dual at p, with u and f (n, c), p (m, c, 2).
function totalVariationGap(surface, map, values, dual, mu) {
  const { m, faces, areas, hats, n } = surface;
  const channels = map.length / n;
  const [sum, rounding, longest] = [new Sum(), new Sum(), longestPart(dual, 2 * channels, 0, 2 * channels)];
  const [load, loadRounding] = [new Float64Array(map.length), new Float64Array(map.length)];
  for (let f = 0; f < m; f++) {
    let [square, size] = [0, 0];
    for (let c = 0; c < channels; c++) {
      let [x, y] = [0, 0];
      for (let k = 0; k < 3; k++) {
        const vertex = faces[3 * f + k] * channels + c;
        const [hx, hy] = [hats[6 * f + 2 * k], hats[6 * f + 2 * k + 1]];
        const at = 2 * (f * channels + c);
        x += values[vertex] * hx;
        y += values[vertex] * hy;
        size += Math.abs(values[vertex]) * Math.hypot(hx, hy);
        load[vertex] += (areas[f] * (dual[at] * hx + dual[at + 1] * hy)) / longest;
        loadRounding[vertex] += hatRounding(surface, f) * areas[f] * Math.hypot(hx, hy) * Math.hypot(dual[at], dual[at + 1]);
      }
      square += x * x + y * y;
    }
    sum.add(areas[f] * Math.sqrt(square));
    rounding.add(hatRounding(surface, f) * areas[f] * size);
  }
  return certified(surface, map, values, mu, sum, rounding, load, loadRounding, longest);
}

// The same of sum_T A_T (|G u - w| + ratio |D w|) + mu/2 |u - f|^2; w (e, 2), dual (m, 3, 2), its parts of lengths 1 and 1.
function generalisedVariationGap(surface, map, values, slopes, dual, mu, ratio) {
  const { m, n, faces, areas, hats } = surface;
  const { opposite, counts } = edgesOf(surface);
  if (slopes.length !== 2 * counts.length) throw new Error(`${slopes.length / 2} slopes for ${counts.length} edges`);
  if (map.length !== n) throw new Error("total generalised variation takes one channel");
  const longest = Math.max(longestPart(dual, 6, 0, 2), longestPart(dual, 6, 2, 6));
  const [sum, rounding] = [new Sum(), new Sum()];
  const [load, loadRounding] = [new Float64Array(n), new Float64Array(n)];
  const [slopeLoad, slopeForce] = [new Float64Array(slopes.length), new Float64Array(slopes.length)];
  for (let f = 0; f < m; f++) {
    const form = new Float64Array(6);
    const share = areas[f] / longest;
    const field = dual.subarray(6 * f, 6 * f + 6);
    let size = 0;
    for (let k = 0; k < 3; k++) {
      const vertex = faces[3 * f + k];
      const hat = [hats[6 * f + 2 * k], hats[6 * f + 2 * k + 1]];
      const length = Math.hypot(...hat);
      form[0] += values[vertex] * hat[0];
      form[1] += values[vertex] * hat[1];
      load[vertex] += share * (field[0] * hat[0] + field[1] * hat[1]);
      loadRounding[vertex] += hatRounding(surface, f) * areas[f] * length * Math.hypot(field[0], field[1]);
      const [tail, head] = [faces[3 * f + ((k + 1) % 3)], faces[3 * f + ((k + 2) % 3)]];
      const sense = tail < head ? 1 : -1;
      const along = [(sense * hat[1]) / length, (-sense * hat[0]) / length];
      const axes = [along, [-along[1], along[0]]];
      for (let c = 0; c < 2; c++) {
        const column = 2 * opposite[3 * f + k] + c;
        const push = (row, entry) => {
          form[row] += entry * slopes[column];
          slopeLoad[column] += share * entry * field[row];
          slopeForce[column] += Math.abs(share * entry * field[row]);
          size += Math.abs(entry * slopes[column]);
        };
        for (let a = 0; a < 2; a++) {
          push(a, -axes[c][a] / 3);
          for (let b = 0; b < 2; b++) push(2 + 2 * a + b, -2 * ratio * axes[c][a] * hat[b]);
        }
      }
      size += Math.abs(values[vertex]) * length;
    }
    sum.add(areas[f] * (Math.hypot(form[0], form[1]) + Math.hypot(form[2], form[3], form[4], form[5])));
    rounding.add(hatRounding(surface, f) * areas[f] * size);
  }
  const found = certified(surface, map, values, mu, sum, rounding, load, loadRounding, longest);
  let [force, worst, effect] = [Number.MIN_VALUE, 0, 0];
  slopeLoad.forEach((left, k) => {
    force = Math.max(force, slopeForce[k]);
    worst = Math.max(worst, Math.abs(left));
    effect += Math.abs(left * slopes[k]);
  });
  const steepest = Array.from(areas, (area, f) => area * Math.max(...[0, 1, 2].map((k) => Math.hypot(hats[6 * f + 2 * k], hats[6 * f + 2 * k + 1]))));
  const largest = map.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
  const scale = Math.max(found.energy, 1e-8 * found.energyOfConstant, 1e5 * EPSILON * largest * total(steepest));
  return { ...found, scale, imbalance: worst / force, rounding: found.rounding + effect };
}

// Largest length of the part from..to of each row; 1 where all are shorter.
function longestPart(field, width, from, to) {
  let longest = 1;
  for (let start = 0; start < field.length; start += width)
    longest = Math.max(longest, Math.hypot(...field.subarray(start + from, start + to)));
  return longest;
}

function certified(surface, map, values, mu, sum, rounding, load, loadRounding, longest) {
  const { mass, n, area } = surface;
  const channels = map.length / n;
  const [bound, constant] = [new Sum(), new Sum()];
  const sharpest = surface.sharpness.reduce((most, sharpness) => Math.max(most, sharpness), 0);
  const means = Array.from({ length: channels }, (_, c) => {
    const mean = new Sum();
    for (let i = 0; i < n; i++) mean.add((mass[i] / area) * map[i * channels + c]);
    return mean.value;
  });
  for (let j = 0; j < map.length; j++) {
    const i = Math.floor(j / channels);
    const difference = values[j] - map[j];
    const move = load[j] / (mu * mass[i]);
    const data = 0.5 * mu * mass[i] * difference * difference;
    sum.add(data);
    constant.add(0.5 * mu * mass[i] * (map[j] - means[j % channels]) ** 2);
    bound.add(load[j] * map[j]);
    bound.add(-0.5 * load[j] * move);
    rounding.add(32 * EPSILON * sharpest * (data + Math.abs(load[j] * move)));
    rounding.add(4 * EPSILON * mu * mass[i] * Math.abs(difference) * (Math.abs(values[j]) + Math.abs(map[j])));
    rounding.add((loadRounding[j] + 4 * EPSILON * Math.abs(load[j])) * (Math.abs(map[j]) + Math.abs(move)));
  }
  const [energy, lowerBound, energyOfConstant] = [sum.value, bound.value, constant.value];
  const gap = Math.max(energy - lowerBound, 0);
  return {
    energy,
    lowerBound,
    gap,
    energyOfConstant,
    longest,
    scale: Math.max(energy, 1e-12 * energyOfConstant),
    errorBound: Math.sqrt((2 * gap) / mu / area),
    rounding: rounding.value,
  };
}
