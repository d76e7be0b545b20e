// Colours of parts in the order of removal, from amber over green and blue to pink; red is reserved for problems.

/** Oklch (lightness 0..1, chroma, hue in degrees) to sRGB 0..255, clamped to the colours that the screen can show. */
export function oklch(lightness, chroma, hue) {
  const a = chroma * Math.cos(hue * Math.PI / 180), b = chroma * Math.sin(hue * Math.PI / 180);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.2914855480 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s,
  ].map(x => x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055)
   .map(x => Math.round(255 * Math.min(1, Math.max(0, x))));
}

export const hex = rgb => '#' + rgb.map(x => x.toString(16).padStart(2, '0')).join('');

export const STAYS = '#8b929e', TROUBLE = '#e5484d';

/** Colour of the part that leaves as number `rank` of `count`; consecutive colours also differ in lightness. */
export function byOrder(rank, count) {
  const share = count > 1 ? rank / (count - 1) : 0.45;
  return hex(oklch(rank % 2 === 0 ? 0.76 : 0.64, 0.135, 75 + 265 * share));
}

/** A part's colour in the plan: "#rrggbb", or three numbers from 0 to 1. Null if it is missing or invalid. */
export function given(part) {
  const c = part.color ?? part.colour;
  if (typeof c === 'string' && /^#[0-9a-f]{6}$/i.test(c)) return c.toLowerCase();
  if (Array.isArray(c) && c.length >= 3 && c.slice(0, 3).every(x => Number.isFinite(x)))
    return hex(c.slice(0, 3).map(x => Math.round(255 * Math.min(1, Math.max(0, x)))));
  return null;
}
