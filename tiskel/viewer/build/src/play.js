// Trajectories: the contact's path, the sphere with two-coloured octants so that its turning shows, and a time bar.
import {
  BufferAttribute, Color, Mesh, MeshLambertMaterial, Quaternion, SphereGeometry,
} from 'three';
import { chained, segments } from './layers.js';
import { digits } from './data.js';

const AROUND = 64, FROM_POLE = 32; // faces of the sphere
const LEAST = 4, MOST = 20; // seconds that a run takes on the screen

export class Player {
  constructor(scene, world, root) {
    this.scene = scene;
    this.world = world;
    this.runs = scene.layers.filter(layer => layer.kind === 'path');
    this.bar = root.querySelector('.player');
    this.bar.hidden = !this.runs.length;
    this.time = 0;
    this.playing = false;
    if (!this.runs.length) return;
    this.runs.forEach(run => this.build(run));
    this.last = Math.max(...this.runs.map(run => run.t[run.t.length - 1]));
    this.speed = this.last / Math.min(Math.max(this.last, LEAST), MOST);
    this.slider = this.bar.querySelector('input');
    this.slider.max = 1000;
    this.button = this.bar.querySelector('button');
    this.button.onclick = () => this.toggle();
    this.slider.oninput = () => { this.stop(); this.to((this.last * this.slider.value) / 1000); };
    world.before.push(now => this.step(now));
    this.to(0);
  }

  build(run) {
    for (const name of ['t', 'contact', 'centre', 'turns']) run[name] = this.scene.array(run[name]);
    run.places = run.contact;
    run.values = new Map();
    const pairs = chained([run.t.length]), width = 3;
    run.seen = segments(this.world, run.contact, pairs, width);
    run.hidden = segments(this.world, run.contact, pairs, width, { transparent: true, opacity: 0.35, dashed: true });
    const size = this.world.box.min.distanceTo(this.world.box.max);
    run.hidden.material.dashSize = run.hidden.material.gapSize = size / 150;
    run.hidden.computeLineDistances();
    run.group.add(run.seen);
    run.faint = run.group.clone(false);
    run.faint.add(run.hidden);
    const geometry = new SphereGeometry(run.radius, AROUND, FROM_POLE).toNonIndexed();
    run.ball = new Mesh(geometry, new MeshLambertMaterial({ vertexColors: true }));
    run.group.add(run.ball);
    run.group.visible = run.faint.visible = run.shown;
    this.world.back.add(run.group);
    this.world.front.add(run.faint);
  }

  paint(roles) {
    for (const run of this.runs) {
      run.seen.material.color.set(roles.path);
      run.hidden.material.color.set(roles.path);
      const p = run.ball.geometry.attributes.position, rgb = new Float32Array(3 * p.count);
      const tones = [new Color(roles.ball), new Color(roles.ball).multiplyScalar(0.35)];
      for (let i = 0; i < p.count; i += 3) { // a face at a time
        const mean = k => p.array[3 * i + k] + p.array[3 * i + 3 + k] + p.array[3 * i + 6 + k];
        const tone = tones[(mean(0) > 0) ^ (mean(1) > 0) ^ (mean(2) > 0)];
        for (let k = 0; k < 3; k++) tone.toArray(rgb, 3 * (i + k));
      }
      run.ball.geometry.setAttribute('color', new BufferAttribute(rgb, 3));
    }
  }

  toggle() {
    this.playing = !this.playing;
    this.button.textContent = this.playing ? '\u23f8' : '\u25b6';
    this.button.setAttribute('aria-label', this.playing ? 'pause' : 'play');
    if (this.playing && this.time >= this.last) this.to(0);
    this.before = null;
    this.world.ask();
  }

  stop() { if (this.playing) this.toggle(); }

  step(now) {
    if (!this.playing) return;
    if (this.before !== null) this.to(this.time + ((now - this.before) / 1000) * this.speed);
    this.before = now;
    if (this.time >= this.last) this.stop();
    else this.world.ask();
  }

  to(time) {
    this.time = Math.min(Math.max(time, 0), this.last);
    for (const run of this.runs) this.put(run);
    this.slider.value = (1000 * this.time) / (this.last || 1);
    this.bar.querySelector('output').textContent = `${digits(this.time)} of ${digits(this.last)} s`;
    this.world.ask();
  }

  // Place the sphere of a run between its two rows about this time.
  put(run) {
    let row = 0;
    while (row < run.t.length - 2 && run.t[row + 1] <= this.time) row++;
    const next = Math.min(row + 1, run.t.length - 1), gap = run.t[next] - run.t[row];
    const share = gap ? Math.min(Math.max((this.time - run.t[row]) / gap, 0), 1) : 0;
    const q = k => new Quaternion(run.turns[4 * k + 1], run.turns[4 * k + 2], run.turns[4 * k + 3], run.turns[4 * k]);
    run.ball.quaternion.copy(q(row).slerp(q(next), share));
    for (const [k, axis] of ['x', 'y', 'z'].entries()) {
      run.ball.position[axis] = run.centre[3 * row + k] * (1 - share) + run.centre[3 * next + k] * share;
    }
  }
}
