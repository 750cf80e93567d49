// What lies over the picture: axes, scale bar, colour bar, and words about a place.
import { Vector3 } from 'three';
import { gradient, ofLabel } from './colours.js';
import { digits } from './data.js';

const ARM = 26; // pixels of an axis
const MOST_LABELS = 10;
const escaped = text => String(text).replace(/[&<>"]/g, sign => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;' })[sign]);

export function axes(root, world) {
  const turned = name => {
    const v = new Vector3(+(name === 'x'), +(name === 'y'), +(name === 'z')).transformDirection(world.camera.matrixWorldInverse);
    return { name, x: 40 + ARM * v.x, y: 40 - ARM * v.y, z: v.z };
  };
  const arms = ['x', 'y', 'z'].map(turned).sort((a, b) => a.z - b.z);
  root.querySelector('.axes').innerHTML = arms.map(a => `<line class="${a.name}" x1="40" y1="40" x2="${a.x.toFixed(1)}" y2="${a.y.toFixed(1)}"/>`
    + `<text x="${(40 + 1.35 * (a.x - 40)).toFixed(1)}" y="${(44 + 1.35 * (a.y - 40)).toFixed(1)}">${a.name}</text>`).join('');
}

// A bar of a round length, about a seventh of the picture wide.
export function scale(root, world, unit) {
  const pixel = world.pixel(), wanted = pixel * Math.min(160, world.canvas.clientWidth / 5);
  const power = 10 ** Math.floor(Math.log10(wanted)), round = [5, 2, 1].find(step => step * power <= wanted) * power;
  const bar = root.querySelector('.scale');
  bar.style.width = `${round / pixel}px`;
  bar.textContent = `${digits(round)}${unit ? ` ${unit}` : ''}`;
}

export function legend(root, field, unit) {
  const box = root.querySelector('.legend');
  box.hidden = !field || field.rgb;
  if (box.hidden) return;
  const title = `<b>${escaped(field.title || field.name)}${field.length && unit ? `, ${escaped(unit)}` : ''}</b>`;
  if (field.labels) {
    const shown = field.labels.map((label, i) => [label, i]).filter(([label]) => label !== '');
    const chips = shown.slice(0, MOST_LABELS).map(([label, i]) => `<span><i style="background:${ofLabel(i)}"></i>${escaped(label)}</span>`);
    const more = shown.length > MOST_LABELS ? `<span>and ${shown.length - MOST_LABELS} more, colours repeat</span>` : '';
    box.innerHTML = `${title}<div class="chips">${chips.join('')}${more}</div>`;
    return;
  }
  const steps = [0, 0.5, 1].map(share => digits(+(field.colours[0] + share * (field.colours[1] - field.colours[0])).toPrecision(3)));
  box.innerHTML = `${title}<div class="ramp" style="background:linear-gradient(90deg, ${gradient()})"></div>`
    + `<div class="ticks">${steps.map(step => `<span>${step}</span>`).join('')}</div>`;
}

// All that is known about a row of a layer.
export function words(scene, found) {
  const { layer, row } = found, centre = scene.centre;
  const rows = [];
  if (layer.texts) rows.push(`<p>${escaped(layer.texts[row])}</p>`);
  for (const { field, numbers } of layer.values.values()) {
    if (field.rgb || field.quiet) continue;
    const value = field.labels ? field.labels[numbers[row]] : digits(numbers[row]);
    if (value === '' || value === 'none') continue;
    const length = field.length && scene.unit ? ` ${scene.unit}` : '';
    rows.push(`<tr><th>${escaped(field.title || field.name)}</th><td>${escaped(value)}${escaped(length)}</td></tr>`);
  }
  if (layer.role === 'cloud') {
    layer.numbers ??= layer.rows && scene.array(layer.rows);
    rows.push(`<tr><th>row</th><td>${layer.numbers ? layer.numbers[row] : row}</td></tr>`);
  }
  const at = [0, 1, 2].map(k => digits(centre[k] + layer.places[3 * row + k])).join(', ');
  rows.push(`<tr><th>at</th><td>${at}${scene.unit ? ` ${escaped(scene.unit)}` : ''}</td></tr>`);
  return `<b>${escaped(layer.name)}</b>${rows.filter(r => r.startsWith('<p')).join('')}<table>${rows.filter(r => r.startsWith('<tr')).join('')}</table>`;
}
