// What is under the pointer: the nearest mark, then the curve, then lines, then the point nearest to the eye.
import { Vector3 } from 'three';

const REACH = { marks: 16, curve: 12, lines: 6, points: 8 }; // pixels
const ORDER = ['marks', 'curve', 'lines', 'points'];

export function pick(scene, world, x, y, least = 1) {
  for (const kind of ORDER) {
    let best = null;
    for (const layer of scene.layers) {
      if (layer.kind !== kind || !layer.group.visible) continue;
      const found = layer.pairs ? onSegments(layer, world, x, y, least * REACH[kind]) : onPoints(layer, world, x, y, least * REACH[kind]);
      if (found && (!best || found.worth < best.worth)) best = { layer, ...found };
    }
    if (best) return best;
  }
  return null;
}

// Pixel coordinates and depth of all places.
function project(places, world) {
  const m = world.camera.projectionMatrix.clone().multiply(world.camera.matrixWorldInverse).elements;
  const wide = world.canvas.clientWidth / 2, high = world.canvas.clientHeight / 2, out = new Float32Array(places.length);
  for (let i = 0; i < places.length; i += 3) {
    const x = places[i], y = places[i + 1], z = places[i + 2];
    const w = m[3] * x + m[7] * y + m[11] * z + m[15];
    out[i] = wide * (1 + (m[0] * x + m[4] * y + m[8] * z + m[12]) / w);
    out[i + 1] = high * (1 - (m[1] * x + m[5] * y + m[9] * z + m[13]) / w);
    out[i + 2] = w;
  }
  return out;
}

function onPoints(layer, world, x, y, reach) {
  const flat = project(layer.places, world), nearest = layer.role === 'cloud';
  let best = null;
  for (let i = 0; i < flat.length; i += 3) {
    const off = Math.hypot(flat[i] - x, flat[i + 1] - y);
    if (off > reach || flat[i + 2] <= 0) continue;
    const worth = nearest ? flat[i + 2] + off * world.pixel() : off; // of a cloud what the eye sees, else what is next
    if (!best || worth < best.worth) best = { row: i / 3, worth };
  }
  return best;
}

function onSegments(layer, world, x, y, reach) {
  const flat = project(layer.places, world);
  let best = null;
  for (let i = 0; i < layer.pairs.length; i += 2) {
    const a = 3 * layer.pairs[i], b = 3 * layer.pairs[i + 1];
    const dx = flat[b] - flat[a], dy = flat[b + 1] - flat[a + 1], square = dx * dx + dy * dy || 1;
    const share = Math.min(Math.max(((x - flat[a]) * dx + (y - flat[a + 1]) * dy) / square, 0), 1);
    const off = Math.hypot(flat[a] + share * dx - x, flat[a + 1] + share * dy - y);
    if (off > reach || (best && off >= best.worth)) continue;
    best = { row: layer.pairs[i + (share > 0.5 ? 1 : 0)], worth: off };
  }
  return best;
}

export const place = (layer, row) => new Vector3(layer.places[3 * row], layer.places[3 * row + 1], layer.places[3 * row + 2]);
