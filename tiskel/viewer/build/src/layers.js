// What the layers of a scene are drawn as. A layer has: name, kind, shown, fields; here it gets a group of objects,
// places to pick, and a way to be coloured by one of its fields.
import {
  BufferAttribute, BufferGeometry, CanvasTexture, DoubleSide, Group, Mesh, MeshLambertMaterial, Points, PointsMaterial,
} from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import { paint } from './colours.js';
import { positions, values } from './data.js';
import { place } from './pick.js';
import { tubes } from './tubes.js';

const SAMPLE = 2000; // places of a layer that the picture is fitted to
const WIDTH = { curve: 3.5, slices: 1.4, path: 3 }; // pixels

export function disc() {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 32;
  const pen = canvas.getContext('2d');
  pen.fillStyle = '#fff';
  pen.arc(16, 16, 15, 0, 7);
  pen.fill();
  return new CanvasTexture(canvas);
}

function flat(xyz, size, texture, over = false) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(xyz, 3));
  const material = new PointsMaterial({ size: size * Math.min(devicePixelRatio, 2), sizeAttenuation: false, map: texture,
    alphaTest: 0.5, depthTest: !over, fog: !over });
  return new Points(geometry, material);
}

export function segments(world, xyz, pairs, width, options = {}) {
  const ends = new Float32Array(3 * pairs.length);
  for (let i = 0; i < pairs.length; i++) ends.set(xyz.subarray(3 * pairs[i], 3 * pairs[i] + 3), 3 * i);
  const material = new LineMaterial({ linewidth: width, fog: true, ...options });
  material.resolution.set(world.canvas.clientWidth || 1, world.canvas.clientHeight || 1);
  world.lineMaterials.push(material);
  return new LineSegments2(new LineSegmentsGeometry().setPositions(ends), material);
}

// Pairs of neighbours along lines of so many vertices.
export function chained(counts) {
  const pairs = [];
  let start = 0;
  for (const count of counts) {
    for (let i = start; i < start + count - 1; i++) pairs.push(i, i + 1);
    start += count;
  }
  return pairs;
}

// Triangles of grids of corners, row by row: closed around, and along where the last row meets the first.
function gridded(grids) {
  const faces = [];
  let start = 0;
  for (const [rows, around, closed] of grids) {
    for (let row = 0; row < (closed ? rows : rows - 1); row++) {
      for (let k = 0; k < around; k++) {
        const next = (k + 1) % around, here = start + row * around, after = start + ((row + 1) % rows) * around;
        faces.push(here + k, here + next, after + next, here + k, after + next, after + k);
      }
    }
    start += rows * around;
  }
  return Uint32Array.from(faces);
}

// All rows in an order in which every beginning is spread over the whole: what is drawn of it while the view moves.
function shuffled(count) {
  const order = Uint32Array.from({ length: count }, (_, i) => i);
  for (let i = count - 1, seed = 1; i > 0; i--) {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0; // Numerical Recipes' generator: the same each time
    const other = Math.floor((seed / 4294967296) * (i + 1));
    [order[i], order[other]] = [order[other], order[i]];
  }
  return new BufferAttribute(order, 1);
}

const BUILD = {
  points(layer, world, texture) {
    const size = layer.role === 'cloud' ? (layer.count > 30000 ? 2 : 2.8) : 4;
    layer.dots = flat(layer.places, size, texture);
    layer.dots.geometry.setIndex(shuffled(layer.count));
    world.clouds.push(layer.dots.geometry);
    layer.group.add(layer.dots);
    (layer.role === 'cloud' ? world.back : world.front).add(layer.group);
  },
  curve(layer, world, texture) {
    layer.pairs = Array.from(layer.scene.array(layer.edges));
    layer.lines = segments(world, layer.places, layer.pairs, WIDTH.curve);
    layer.group.add(layer.lines);
    layer.knots = ['end', 'joint'].map(role => {
      const rows = Array.from(layer.scene.array(layer[role]));
      const dots = flat(Float32Array.from(rows.flatMap(row => [...layer.places.subarray(3 * row, 3 * row + 3)])), 7, texture);
      dots.material.depthTest = false;
      dots.renderOrder = 2;
      layer.group.add(dots);
      return { role, dots };
    });
    world.front.add(layer.group);
  },
  tube(layer, world) {
    const { geometry, owner } = tubes(layer.places, layer.scene.array(layer.radii), layer.scene.array(layer.counts));
    layer.owner = owner;
    layer.mesh = new Mesh(geometry, new MeshLambertMaterial({ side: DoubleSide, transparent: true, opacity: 0.42, depthWrite: false }));
    layer.group.add(layer.mesh);
    world.back.add(layer.group);
  },
  mesh(layer, world) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(layer.places, 3));
    geometry.setIndex(new BufferAttribute(layer.triangles ? layer.scene.array(layer.triangles) : gridded(layer.grids), 1));
    geometry.computeVertexNormals();
    layer.mesh = new Mesh(geometry, new MeshLambertMaterial({ side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }));
    layer.group.add(layer.mesh);
    world.back.add(layer.group);
  },
  lines(layer, world) {
    layer.pairs = chained(layer.scene.array(layer.counts));
    layer.lines = segments(world, layer.places, layer.pairs, WIDTH[layer.role] || 2);
    layer.group.add(layer.lines);
    world.back.add(layer.group);
  },
  marks(layer, world, texture) {
    layer.dots = flat(layer.places, 13, texture, true);
    layer.hearts = flat(layer.places, 6, texture, true);
    layer.dots.renderOrder = 8;
    layer.hearts.renderOrder = 9;
    layer.group.add(layer.dots, layer.hearts);
    world.front.add(layer.group);
  },
};

export function build(scene, world) {
  const texture = disc();
  for (const layer of scene.layers) {
    layer.scene = scene;
    layer.group = new Group();
    if (layer.kind === 'path') continue; // see play.js
    layer.places = positions(scene, layer);
    layer.values = new Map((layer.fields || []).map(field => [field.name, { field, numbers: values(scene, field) }]));
    BUILD[layer.kind](layer, world, texture);
    layer.group.visible = layer.shown;
  }
  world.sample = sample(scene);
  world.home(false);
}

// A few thousand places that stand for all: what the picture is to hold.
function sample(scene) {
  const every = [];
  for (const layer of scene.layers) {
    if (!layer.places || layer.kind === 'marks') continue;
    const step = Math.ceil(layer.count / SAMPLE);
    for (let i = 0; i < layer.count; i += step) every.push(place(layer, i));
  }
  return every.length ? every : null;
}

// Colour a layer by the field of this name where it has one, plainly where not.
export function colour(layer, name, roles) {
  const known = layer.values && layer.values.get(name);
  const plain = roles[layer.role];
  if (layer.knots) for (const { role, dots } of layer.knots) dots.material.color.set(roles[role]);
  if (layer.hearts) layer.hearts.material.color.set(roles.background);
  const object = layer.dots || layer.lines || layer.mesh;
  if (!object || layer.kind === 'path') return;
  const material = object.material, with_ = Boolean(known);
  material.color.set(known ? '#ffffff' : plain);
  if (material.vertexColors !== with_) { material.vertexColors = with_; material.needsUpdate = true; }
  if (!known) return;
  const rgb = new Float32Array(3 * (known.field.rgb ? known.numbers.length / 3 : known.numbers.length));
  paint(rgb, known.field, known.numbers);
  if (layer.lines) object.geometry.setColors(gathered(rgb, layer.pairs));
  else object.geometry.setAttribute('color', new BufferAttribute(layer.owner ? gathered(rgb, layer.owner) : rgb, 3));
}

function gathered(rgb, rows) {
  const out = new Float32Array(3 * rows.length);
  for (let i = 0; i < rows.length; i++) out.set(rgb.subarray(3 * rows[i], 3 * rows[i] + 3), 3 * i);
  return out;
}
