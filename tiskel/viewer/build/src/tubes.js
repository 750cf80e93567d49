// Branches as thick as their radii say: a ring of corners about every node, joined to its neighbour's.
import { BufferAttribute, BufferGeometry, Vector3 } from 'three';

const AROUND = 14; // corners of a ring

// Lines of `counts` vertices one after the other; returns the surface and the vertex that each of its corners is about.
export function tubes(places, radii, counts) {
  const corners = [], faces = [], owner = [];
  let start = 0;
  for (const count of counts) {
    branch(places, radii, start, count, corners, faces, owner);
    start += count;
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(Float32Array.from(corners), 3));
  geometry.setIndex(faces);
  geometry.computeVertexNormals();
  return { geometry, owner };
}

const at = (places, i) => new Vector3(places[3 * i], places[3 * i + 1], places[3 * i + 2]);

function branch(places, radii, start, count, corners, faces, owner) {
  let side = null;
  for (let i = start; i < start + count; i++) {
    const along = at(places, Math.min(i + 1, start + count - 1)).sub(at(places, Math.max(i - 1, start)));
    if (!along.lengthSq()) along.set(0, 0, 1);
    along.normalize();
    side = across(side, along); // carried from ring to ring, so that the tube does not twist
    const other = new Vector3().crossVectors(along, side), first = corners.length / 3;
    for (let k = 0; k < AROUND; k++) {
      const turn = (2 * Math.PI * k) / AROUND, radius = radii[i] > 0 ? radii[i] : 0;
      const corner = at(places, i).addScaledVector(side, radius * Math.cos(turn)).addScaledVector(other, radius * Math.sin(turn));
      corners.push(corner.x, corner.y, corner.z);
      owner.push(i);
      if (i === start) continue;
      const next = (k + 1) % AROUND, a = first + k, b = first + next;
      faces.push(a - AROUND, b - AROUND, b, a - AROUND, b, a);
    }
  }
}

function across(before, along) {
  const axis = Math.abs(along.x) < 0.8 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
  const side = (before || axis).clone();
  side.addScaledVector(along, -side.dot(along));
  if (side.lengthSq() < 1e-9) side.crossVectors(along, axis);
  return side.normalize();
}
