"use strict";
// Arrays of the page: little-endian bytes in base64, row after row.

const TYPES = { float64: Float64Array, int32: Int32Array };

function bytesOf(text) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

function decoded({ type, shape, data }) {
  const bytes = bytesOf(data);
  const values = new TYPES[type](bytes.buffer);
  const size = shape.reduce((product, length) => product * length, 1);
  if (values.length !== size) throw new Error(`an array of shape ${shape} has ${values.length} numbers`);
  for (const value of values) if (!Number.isFinite(value)) throw new Error("an array has a number that is not finite");
  return values;
}

// Sum with the rounding of each addition carried along (Neumaier 1974).
class Sum {
  constructor() {
    this.total = 0;
    this.rest = 0;
  }

  add(term) {
    const next = this.total + term;
    this.rest += Math.abs(this.total) >= Math.abs(term) ? this.total - next + term : term - next + this.total;
    this.total = next;
  }

  get value() {
    return this.total + this.rest;
  }
}
