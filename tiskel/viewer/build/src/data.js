// The scene as the page holds it: a JSON document, and one run of bytes in base64 that its arrays point into.

const TYPES = { u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, f32: Float32Array };
const LAST = 65535; // of 16 bits: stands for "no value" in fields

export function readScene(root) {
  const scene = JSON.parse(root.querySelector('.scene').textContent);
  const text = atob(root.querySelector('.bytes').textContent.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  scene.array = ref => new TYPES[ref.type](bytes.buffer, ref.at, ref.count);
  return scene;
}

// Positions relative to the scene's centre, as 32-bit floats: 16-bit steps within the layer's box.
export function positions(scene, layer) {
  const steps = scene.array(layer.xyz), out = new Float32Array(steps.length);
  const [low, high] = layer.box;
  for (let i = 0; i < steps.length; i++) out[i] = low[i % 3] + (high[i % 3] - low[i % 3]) * (steps[i] / LAST);
  return out;
}

// Values of a field as numbers: labels as they are, others undone from 16 bits, NaN where there is none.
export function values(scene, field) {
  const raw = scene.array(field.values);
  if (field.labels || field.rgb) return raw;
  const out = new Float32Array(raw.length);
  for (let i = 0; i < raw.length; i++) {
    out[i] = raw[i] === LAST ? NaN : field.low + (field.high - field.low) * (raw[i] / (LAST - 1));
  }
  return out;
}

export function digits(value) {
  if (!Number.isFinite(value)) return 'none';
  return Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3)
    ? value.toExponential(3) : String(+value.toPrecision(4));
}
