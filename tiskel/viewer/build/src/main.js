// The viewer of one scene; a page may hold several.
import { Box3 } from 'three';
import { ROLES } from './colours.js';
import { readScene } from './data.js';
import { build, colour, segments } from './layers.js';
import { axes, legend, scale, words } from './overlay.js';
import { pick, place } from './pick.js';
import { Player } from './play.js';
import { World } from './world.js';

const NARROW = 640; // pixels; the width of phones
const CLICK = 5; // pixels that a pointer may move and still click
const TURN = Math.PI / 24, NEARER = 0.85; // of one key press
const VIEWS = { x: [1, 0, 0], y: [0, -1, 0], z: [0, 0, 1] };

function webgl() {
  try {
    return Boolean(document.createElement('canvas').getContext('webgl2'));
  } catch {
    return false;
  }
}

class Viewer {
  constructor(root) {
    this.root = root;
    this.scene = readScene(root);
    this.world = new World(root.querySelector('canvas'), this.scene);
    this.name = this.scene.colour;
    build(this.scene, this.world);
    this.player = new Player(this.scene, this.world, root);
    this.controls();
    this.pointer();
    root.addEventListener('keydown', event => this.key(event));
    const dark = matchMedia('(prefers-color-scheme: dark)').matches && root.dataset.theme !== 'light';
    this.theme(root.dataset.theme || (dark ? 'dark' : 'light'));
    this.world.after.push(() => this.drawn());
    if (root.dataset.alone !== undefined) root.focus({ preventScroll: true });
    this.wheel();
  }

  drawn() {
    axes(this.root, this.world);
    scale(this.root, this.world, this.scene.unit);
    if (this.root.dataset.state === 'ready') return;
    this.root.dataset.state = 'ready';
    this.root.dataset.milliseconds = Math.round(performance.now());
  }

  // In a longer page the wheel scrolls until the viewer was clicked.
  wheel() {
    const alone = this.root.dataset.alone !== undefined;
    const set = on => { this.world.controls.enableZoom = alone || on; };
    this.root.addEventListener('focusin', () => set(true));
    this.root.addEventListener('focusout', () => set(false));
    set(this.root.contains(document.activeElement));
  }

  controls() {
    const list = this.root.querySelector('.layers');
    this.scene.layers.forEach((layer, number) => {
      const label = document.createElement('label'), box = document.createElement('input'), name = document.createElement('span');
      const swatch = document.createElement('i');
      box.type = 'checkbox';
      box.checked = layer.shown;
      box.onchange = () => this.show(number, box.checked);
      name.textContent = layer.name;
      name.title = number < 9 ? `key ${number + 1}` : '';
      label.append(box, swatch, name);
      list.append(label);
      Object.assign(layer, { box, swatch });
    });
    const select = this.root.querySelector('select');
    const names = new Map(this.scene.layers.flatMap(l => (l.fields || []).filter(f => !f.quiet).map(f => [f.name, f.title || f.name])));
    for (const [name, title] of names) select.add(new Option(title, name));
    select.onchange = () => this.colour(select.value);
    const buttons = { '.home': () => this.home(), '.zoom': () => this.zoom(), '.dark': () => this.theme(), '.help': () => this.help(), '.fold': () => this.fold() };
    for (const [name, act] of Object.entries(buttons)) this.root.querySelector(name).onclick = act;
    this.root.querySelectorAll('.said button').forEach(button => { button.onclick = () => this.warning(button.dataset.layer, +button.dataset.mark); });
    this.fold(this.root.clientWidth < NARROW);
    this.world.home(false);
  }

  fold(folded) {
    const panel = this.root.querySelector('.panel');
    panel.classList.toggle('folded', folded);
    const narrow = this.root.clientWidth < NARROW;
    this.world.covered = { left: narrow ? 0 : panel.offsetLeft + panel.offsetWidth, below: narrow ? 110 : 50 };
    this.world.resize();
  }
  help() { const box = this.root.querySelector('.keys'); box.hidden = !box.hidden; }
  home() { this.select(null); this.world.home(); }

  theme(name) {
    const chosen = name || (this.root.dataset.theme === 'dark' ? 'light' : 'dark');
    this.root.dataset.theme = chosen;
    this.roles = ROLES[chosen];
    this.world.background(this.roles.background);
    this.player.paint(this.roles);
    this.colour(this.name);
  }

  show(number, shown) {
    const layer = this.scene.layers[number];
    if (!layer) return;
    layer.box.checked = layer.group.visible = shown;
    if (layer.faint) layer.faint.visible = shown;
    this.world.ask();
  }

  colour(name) {
    this.name = name;
    this.root.querySelector('select').value = name;
    let shown = null;
    for (const layer of this.scene.layers) {
      colour(layer, name, this.roles);
      const known = layer.values && layer.values.get(name);
      shown = shown || (known && known.field);
      layer.swatch.style.background = known ? 'linear-gradient(90deg, #440154, #1f9e89, #fde725)' : this.roles[layer.role];
    }
    legend(this.root, shown, this.scene.unit);
    this.world.ask();
  }

  // Pixels of the canvas in, words out; empty where nothing is.
  hover(x, y, reach = 1) {
    const found = pick(this.scene, this.world, x, y, reach), box = this.root.querySelector('.tip');
    box.hidden = !found;
    this.under = found;
    if (!found) return '';
    box.innerHTML = words(this.scene, found);
    const wide = this.world.canvas.clientWidth, high = this.world.canvas.clientHeight;
    box.style.left = `${Math.max(Math.min(x + 14, wide - box.offsetWidth - 8), 4)}px`;
    box.style.top = `${y + 14 + box.offsetHeight > high ? Math.max(y - box.offsetHeight - 14, 4) : y + 14}px`;
    return box.textContent;
  }

  pointer() {
    const canvas = this.world.canvas;
    let down = null;
    const at = event => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
    canvas.addEventListener('pointerdown', event => { down = at(event); this.root.focus({ preventScroll: true }); });
    canvas.addEventListener('pointermove', event => { if (!event.buttons && event.pointerType === 'mouse') this.hover(...at(event)); });
    canvas.addEventListener('pointerleave', event => { if (event.pointerType === 'mouse') this.root.querySelector('.tip').hidden = true; });
    canvas.addEventListener('pointerup', event => {
      const [x, y] = at(event);
      if (!down || Math.hypot(x - down[0], y - down[1]) > CLICK) return;
      this.hover(x, y, event.pointerType === 'mouse' ? 1 : 2);
      this.select(this.under);
    });
    canvas.addEventListener('dblclick', () => this.zoom());
  }

  // Mark a branch, or a place, and remember its box.
  select(found) {
    if (this.halo) { this.halo.removeFromParent(); this.halo = null; }
    this.selected = null;
    if (found) {
      const { layer, row } = found, branch = layer.kind === 'curve' && layer.values.get('branch');
      const pairs = branch ? this.branch(layer, branch, row) : [];
      const box = new Box3();
      for (const one of pairs.length ? pairs : [row]) box.expandByPoint(place(layer, one));
      const size = this.world.box.min.distanceTo(this.world.box.max);
      this.selected = box.expandByScalar(pairs.length ? size / 100 : size / 25);
      if (pairs.length) {
        this.halo = segments(this.world, layer.places, pairs, 10, { transparent: true, opacity: 0.4, color: 0xffb000, depthTest: false });
        this.world.front.add(this.halo);
      }
    }
    this.world.ask();
  }

  branch(layer, { numbers, field }, row) {
    const chosen = numbers[row];
    if (field.labels[chosen] === '') return [];
    const pairs = [];
    for (let i = 0; i < layer.pairs.length; i += 2) {
      const a = layer.pairs[i], b = layer.pairs[i + 1];
      if (numbers[a] === chosen || numbers[b] === chosen) pairs.push(a, b);
    }
    return pairs;
  }

  zoom() {
    if (this.selected) this.world.show(this.selected);
    else this.world.show(this.world.box, null, true, this.world.sample);
  }

  // Go to a place of a warning.
  warning(name, row) {
    const layer = this.scene.layers.find(one => one.kind === 'marks' && one.name === name);
    if (!layer) return;
    this.show(this.scene.layers.indexOf(layer), true);
    this.select({ layer, row });
    this.zoom();
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || /^(SELECT|INPUT)$/.test(event.target.tagName)) return;
    const turns = { ArrowLeft: [-TURN, 0], ArrowRight: [TURN, 0], ArrowUp: [0, TURN], ArrowDown: [0, -TURN] };
    const acts = {
      '+': () => this.world.nearer(NEARER), '=': () => this.world.nearer(NEARER), '-': () => this.world.nearer(1 / NEARER),
      f: () => this.zoom(), h: () => this.home(), r: () => this.home(), d: () => this.theme(), '?': () => this.help(),
      ' ': () => this.player.runs.length && this.player.toggle(), c: () => this.next(), Escape: () => this.select(null),
    };
    if (turns[event.key]) this.world.turn(...turns[event.key]);
    else if (VIEWS[event.key]) this.along(event.key);
    else if (/^[1-9]$/.test(event.key)) this.show(+event.key - 1, !(this.scene.layers[+event.key - 1] || { group: {} }).group.visible);
    else if (acts[event.key]) acts[event.key]();
    else return;
    event.preventDefault();
  }

  along(axis) {
    const from = this.world.camera.up.clone().set(...VIEWS[axis]);
    if (axis === this.scene.up) from.addScaledVector(this.world.start, 1e-3); // straight down has no right
    this.world.show(this.world.box, from, true, this.world.sample);
  }

  next() {
    const options = [...this.root.querySelector('select').options].map(option => option.value);
    this.colour(options[(options.indexOf(this.name) + 1) % options.length]);
  }
}

for (const root of document.querySelectorAll('.tiskel-viewer')) {
  if (webgl()) root.viewer = new Viewer(root);
  else root.dataset.state = 'still';
}
