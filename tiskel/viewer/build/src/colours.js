// Colours: viridis for values, Okabe and Ito's palette for labels; both are safe for colour-blind readers.
import { Color, SRGBColorSpace } from 'three';

const VIRIDIS = ['#440154', '#482878', '#3e4989', '#31688e', '#26828e', '#1f9e89', '#35b779', '#6ece58', '#b5de2b',
  '#fde725'].map(code => new Color(code));
const OKABE_ITO = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#8c6d31', '#7f7f7f'];
const NONE = new Color('#9a9a9a');
export const ROLES = {
  light: { cloud: '#8c98a4', curve: '#c0392b', points: '#2471a3', tube: '#d9822b', surface: '#8fb3cf', slices: '#2471a3',
    warning: '#b3261e', note: '#8a5a00', path: '#c0392b', ball: '#e9b48c', end: '#e69f00', joint: '#1f3a5f',
    background: '#ffffff' },
  dark: { cloud: '#93a1af', curve: '#ff7a66', points: '#6cb6e8', tube: '#f0a860', surface: '#5e87a8', slices: '#6cb6e8',
    warning: '#ff8a80', note: '#ffcc66', path: '#ff7a66', ball: '#e9b48c', end: '#ffc04d', joint: '#9fc3f0',
    background: '#14181d' },
};

export const gradient = () => VIRIDIS.map(colour => `#${colour.getHexString()}`).join(', ');
export const ofLabel = number => OKABE_ITO[number % OKABE_ITO.length];

// Fill rgb (3 numbers a row) with the colours of values by a field; rows without a value are grey.
export function paint(rgb, field, numbers) {
  if (field.rgb) {
    const one = new Color();
    for (let i = 0; i < rgb.length; i += 3) {
      one.setRGB(numbers[i] / 255, numbers[i + 1] / 255, numbers[i + 2] / 255, SRGBColorSpace).toArray(rgb, i);
    }
    return;
  }
  const labels = field.labels ? OKABE_ITO.map(code => new Color(code)) : null;
  const one = new Color(), [low, high] = field.colours || [0, 1], span = high - low || 1;
  for (let i = 0; i < numbers.length; i++) {
    const value = numbers[i];
    if (labels) one.copy(field.labels[value] === '' ? NONE : labels[value % labels.length]);
    else if (Number.isNaN(value)) one.copy(NONE);
    else {
      const place = Math.min(Math.max((value - low) / span, 0), 1) * (VIRIDIS.length - 1);
      const below = Math.min(Math.floor(place), VIRIDIS.length - 2);
      one.copy(VIRIDIS[below]).lerp(VIRIDIS[below + 1], place - below);
    }
    rgb[3 * i] = one.r; rgb[3 * i + 1] = one.g; rgb[3 * i + 2] = one.b;
  }
}
