// The space: renderer, camera, light, fog as a depth cue, and a picture only where something has changed.
import { AmbientLight, Box3, Color, DirectionalLight, Fog, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const UP = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
const FIELD = 30; // degrees; narrow, so that lengths compare across the picture
const MOST_RATIO = 2; // device pixels per pixel: more costs time and is not seen
const FADE = 0.7; // how much of the background is mixed into what is farthest away
const MARGIN = 1.08; // of the distance at which everything just fits
const SLOW = 50, QUICK = 25, PAUSE = 2000; // milliseconds between pictures: too many, few; it was no movement
const LEAST_SHARE = 0.05; // of the points that are drawn while the view moves
const TURN = 250; // milliseconds of a flight

const corners = ({ min, max }) => [0, 1, 2, 3, 4, 5, 6, 7].map(i =>
  new Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z));

export class World {
  constructor(canvas, scene) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.autoClear = false;
    this.back = new Scene(); // cloud, surface, ball
    this.front = new Scene(); // curve and marks, drawn over it: what lies inside a body is to be seen
    this.camera = new PerspectiveCamera(FIELD, 1, 1e-3, 1e3);
    this.camera.up.set(...UP[scene.up]);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.ask());
    this.controls.addEventListener('start', () => { this.touched = this.moving = true; this.frame = 0; });
    this.controls.addEventListener('end', () => { this.moving = false; this.ask(); });
    const sun = new DirectionalLight(0xffffff, 2.2);
    this.camera.add(sun);
    sun.position.set(-0.4, 0.8, 1);
    this.back.add(this.camera, new AmbientLight(0xffffff, 1.1));
    this.back.fog = this.front.fog = new Fog(0xffffff, 1, 2);
    this.box = new Box3(new Vector3(...scene.box[0]), new Vector3(...scene.box[1]));
    this.start = new Vector3(...scene.from);
    this.lineMaterials = [];
    this.clouds = []; // geometries of points, of which a part is drawn while the view moves, where that takes long
    this.share = 1;
    this.covered = { left: 0, below: 0 }; // pixels that controls cover: the model is shown beside them
    this.after = [];
    this.before = [];
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(time => { this.asked = false; this.draw(time); });
  }

  draw(time) {
    if (this.flight) this.fly(time);
    this.spare(time);
    for (const task of this.before) task(time);
    const size = this.box.min.distanceTo(this.box.max);
    const depths = corners(this.box).map(corner => -corner.applyMatrix4(this.camera.matrixWorldInverse).z);
    const nearest = Math.min(...depths), farthest = Math.max(...depths);
    this.camera.near = Math.max(nearest - 0.2 * size, size / 4000);
    this.camera.far = farthest + 0.3 * size;
    this.camera.updateProjectionMatrix();
    this.back.fog.near = Math.max(nearest, 0);
    this.back.fog.far = this.back.fog.near + (farthest - this.back.fog.near) / FADE;
    this.renderer.clear();
    this.renderer.render(this.back, this.camera);
    this.renderer.clearDepth();
    this.renderer.render(this.front, this.camera);
    for (const task of this.after) task();
  }

  // Draw fewer points while the view moves, as few as keep it fluent; all of them as soon as it rests.
  spare(time) {
    const moving = this.moving || Boolean(this.flight), took = time - this.frame;
    if (moving && this.frame && took < PAUSE) {
      if (took > SLOW) this.share = Math.max(this.share * 0.6, LEAST_SHARE);
      else if (took < QUICK) this.share = Math.min(this.share * 1.2, 1);
    }
    this.frame = moving ? time : 0;
    for (const points of this.clouds) {
      points.setDrawRange(0, moving ? Math.ceil(this.share * points.index.count) : Infinity);
    }
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, MOST_RATIO));
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    const { left, below } = this.covered;
    this.camera.setViewOffset(clientWidth, clientHeight, -left / 2, below / 2, clientWidth, clientHeight);
    for (const material of this.lineMaterials) material.resolution.set(clientWidth, clientHeight);
    if (!this.touched && this.sample) this.home(false);
    this.ask();
  }

  background(code) {
    this.renderer.setClearColor(new Color(code));
    this.back.fog.color.set(code);
    this.ask();
  }

  // Look at a box, or at places in it, so that they fill the picture; from where the camera is, or from a direction.
  show(box, from = null, flying = true, places = null) {
    if (flying) this.touched = true;
    const centre = box.getCenter(new Vector3());
    const back = (from || this.camera.position.clone().sub(this.controls.target)).clone().normalize();
    const right = new Vector3().crossVectors(this.camera.up, back).normalize();
    if (!right.lengthSq()) right.set(1, 0, 0);
    const up = new Vector3().crossVectors(back, right);
    const { clientWidth, clientHeight } = this.canvas, half = Math.tan((FIELD * Math.PI) / 360);
    const high = half * (1 - this.covered.below / clientHeight), wide = half * this.camera.aspect * (1 - this.covered.left / clientWidth);
    const least = this.box.getSize(new Vector3()).length() / 200;
    const seen = (places || corners(box)).map(corner => corner.clone().sub(centre));
    const middle = axis => (Math.min(...seen.map(one => one.dot(axis))) + Math.max(...seen.map(one => one.dot(axis)))) / 2;
    const shift = right.clone().multiplyScalar(middle(right)).addScaledVector(up, middle(up));
    centre.add(shift);
    let away = least;
    for (const one of seen) {
      one.sub(shift);
      const need = Math.max(Math.abs(one.dot(right)) / wide, Math.abs(one.dot(up)) / high);
      away = Math.max(away, need * MARGIN + one.dot(back));
    }
    const to = { position: back.multiplyScalar(away).add(centre), target: centre };
    if (flying) this.flight = { to, position: this.camera.position.clone(), target: this.controls.target.clone() };
    else this.place(to);
    this.ask();
  }

  place({ position, target }) {
    this.camera.position.copy(position);
    this.controls.target.copy(target);
    this.controls.update();
  }

  fly(time) {
    const flight = this.flight;
    flight.since ??= time;
    const share = Math.min((time - flight.since) / TURN, 1), eased = share * share * (3 - 2 * share);
    this.place({
      position: flight.position.clone().lerp(flight.to.position, eased),
      target: flight.target.clone().lerp(flight.to.target, eased),
    });
    if (share === 1) this.flight = null;
    this.ask();
  }

  home(flying = true) { this.show(this.box, this.start, flying, this.sample); }

  // Turn about the target by angles in radians.
  turn(sideways, upwards) {
    this.touched = true;
    const offset = this.camera.position.clone().sub(this.controls.target), up = this.camera.up;
    offset.applyAxisAngle(up, -sideways);
    const right = new Vector3().crossVectors(up, offset).normalize();
    const tilted = offset.clone().applyAxisAngle(right, -upwards);
    if (Math.abs(tilted.clone().normalize().dot(up)) < 0.999) offset.copy(tilted);
    this.place({ position: offset.add(this.controls.target), target: this.controls.target });
    this.ask();
  }

  nearer(factor) {
    this.touched = true;
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
    this.place({ position: offset.add(this.controls.target), target: this.controls.target });
    this.ask();
  }

  // Length of a pixel at the target, in the scene's unit.
  pixel() {
    const away = this.camera.position.distanceTo(this.controls.target);
    return (2 * away * Math.tan((FIELD * Math.PI) / 360)) / this.canvas.clientHeight;
  }
}
