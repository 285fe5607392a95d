"use strict";
// data: {file, width, height, exposure, groups: [{name, factor, color}], halves: base 64 of 16-bit floats, group after
// group r g b of all pixels}.
const data = JSON.parse(byId("data").textContent);
const count = 3 * data.width * data.height;

/** The values of all 16-bit floats, by their bits. */
function valuesOfHalves() {
  const values = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = bits >> 10 & 31, mantissa = bits & 1023;
    const size = exponent === 0 ? mantissa * 2 ** -24 : exponent === 31 ? Infinity : (1024 + mantissa) * 2 ** (exponent - 25);
    values[bits] = bits & 0x8000 ? -size : size;
  }
  return values;
}

/** Linear light of every group. */
function decodeLayers() {
  const text = atob(data.halves), values = valuesOfHalves();
  return data.groups.map((group, number) => Float32Array.from({length: count}, (unused, i) => {
    const at = 2 * (number * count + i);
    return values[text.charCodeAt(at) | text.charCodeAt(at + 1) << 8];
  }));
}

const toLinear = code => code <= 0.04045 ? code / 12.92 : ((code + 0.055) / 1.055) ** 2.4;
const toSrgb = light => light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055;

/** sRGB codes by the upper 17 bits of a float: finer than a code everywhere. */
function codesOfFloats() {
  const codes = new Uint8ClampedArray(1 << 16), bits = new Uint32Array(1), value = new Float32Array(bits.buffer);
  for (let i = 0; i < codes.length; ++i) {
    bits[0] = i << 15 | 1 << 14;
    codes[i] = value[0] >= 1 ? 255 : Math.round(255 * toSrgb(value[0]));
  }
  return codes;
}

const layers = decodeLayers(), codes = codesOfFloats();
const sum = new Float32Array(count), sumBits = new Uint32Array(sum.buffer);
const canvas = byId("picture"), context = canvas.getContext("2d");
canvas.width = data.width;
canvas.height = data.height;
const pixels = context.createImageData(data.width, data.height);
pixels.data.fill(255);

const mix = data.groups.map(group => ({...group, on: true, largest: 4}));
let exposure = data.exposure;

/** A colour's linear r, g and b. */
const linearColor = color => [1, 3, 5].map(at => toLinear(parseInt(color.slice(at, at + 2), 16) / 255));

function draw() {
  sum.fill(0);
  mix.forEach((group, number) => {
    const scale = group.on ? group.factor * 2 ** exposure : 0;
    if (scale === 0) return;
    const [r, g, b] = linearColor(group.color).map(channel => channel * scale), layer = layers[number];
    for (let i = 0; i < count; i += 3) {
      sum[i] += r * layer[i];
      sum[i + 1] += g * layer[i + 1];
      sum[i + 2] += b * layer[i + 2];
    }
  });
  // Less than nothing has its sign's bit set, and is black.
  for (let i = 0, at = 0; i < count; i += 3, at += 4)
    for (let c = 0; c < 3; ++c) pixels.data[at + c] = sumBits[i + c] >>> 31 ? 0 : codes[sumBits[i + c] >>> 15];
  context.putImageData(pixels, 0, 0);
  byId("stops").value = exposure.toFixed(1);
  byId("exposure").value = exposure;
  byId("command").textContent = mixCommand(data.file, mix, exposure);
}

let waiting = false;
function changed() {
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => { waiting = false; draw(); });
}

const rows = lightTable(document.querySelector("#groups tbody"), mix, changed);
byId("exposure").addEventListener("input", event => { exposure = event.target.valueAsNumber; changed(); });
byId("reset").addEventListener("click", () => {
  for (const group of mix) Object.assign(group, {on: true, factor: 1, color: "#ffffff"});
  exposure = 0;
  for (const {show} of rows) show();
  draw();
});
draw();
