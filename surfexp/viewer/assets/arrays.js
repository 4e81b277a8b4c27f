"use strict";
// Arrays of the page: text in the page, deflated differences, codes, numbers.
const TYPES = { uint8: Uint8Array, uint16: Uint16Array, uint32: Uint32Array };
const GAP = 65535;
const unpacked = new Map();

async function inflated(text) {
  const binary = atob(text), bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = binary.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Rows of codes: columns follow one another as differences, their low bytes before the high ones.
async function unpack({ array, type, columns }) {
  const planes = await inflated(document.getElementById(`array-${array}`).textContent);
  const codes = new TYPES[type](planes.length / TYPES[type].BYTES_PER_ELEMENT), rows = codes.length / columns;
  let sum = 0;
  for (let i = 0; i < codes.length; i++) {
    for (let byte = 0; byte * codes.length < planes.length; byte++) {
      sum += planes[byte * codes.length + i] << (8 * byte);
    }
    sum |= 0;
    codes[(i % rows) * columns + Math.floor(i / rows)] = sum;
  }
  return codes;
}

// One array serves every surface that shows it.
function codesOf(described) {
  if (!unpacked.has(described.array)) unpacked.set(described.array, unpack(described));
  return unpacked.get(described.array);
}

// The number in a row and column; NaN in a gap. Exact numbers are two words each.
async function numbersOf(described) {
  const codes = await codesOf(described), { columns, low, step, gaps } = described;
  if (described.exact) {
    const exact = new Float64Array(codes.buffer);
    return Object.assign((row) => exact[row], { rows: exact.length });
  }
  const at = (row, column = 0) => {
    const code = codes[row * columns + column];
    return gaps && code === GAP ? NaN : low[column] + step[column] * code;
  };
  return Object.assign(at, { rows: codes.length / columns });
}

// The numbers between those of two steps of a field; those of one of its steps where it has no stops.
async function numbersAt({ values, next, share = 0 }) {
  const [first, second] = await Promise.all([numbersOf(values), next && numbersOf(next)]);
  if (!share) return first;
  return Object.assign((row) => (1 - share) * first(row) + share * second(row), { rows: first.rows });
}
