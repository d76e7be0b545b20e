// Reads the data in the page (docs/viewer.md): the plan as in plan.json, the surfaces of the parts, and what is to be shown.

function bytesOf(base64) {
  if (typeof Uint8Array.fromBase64 === 'function') return Uint8Array.fromBase64(base64);
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

const array = (Type, base64) => new Type(bytesOf(base64).buffer);

function readShape(shape) {
  const Index = shape.wide ? Uint32Array : Uint16Array;
  return {
    positions: array(Float32Array, shape.positions),
    normals: array(Int16Array, shape.normals),
    triangles: array(Index, shape.triangles),
    edges: array(Index, shape.edges),
  };
}

function readView({up, leavers, account, steps, runs, animations, parts, reasons, untried}) {
  const animation = ({duration, times, poses}) => ({duration, times: array(Float32Array, times), poses: array(Uint32Array, poses)});
  return {
    up, leavers, account, steps, runs, reasons, untried,
    animations: {disassembly: animation(animations.disassembly), assembly: animation(animations.assembly)},
    rank: parts.rank,
    out: parts.out,
    gone: array(Float32Array, parts.gone),
    comes: array(Float32Array, parts.comes),
    offsets: array(Float32Array, parts.offsets),
  };
}

/** @returns {plan, result: {word, text}, parts, shapes, view}; null if this is the template, without a plan. @throws Error if the data cannot be read. */
export function readData(text) {
  if (text === '' || text[0] === '@') return null;
  const data = JSON.parse(text);
  if (data.format !== 'dismantle.page' || data.version !== 2)
    throw new Error(`this page cannot show data of format ${data.format}, version ${data.version}`);
  const {plan, geometry, result} = data;
  const parts = plan.assembly.parts.map((part, i) => {
    const {shape, place, box: [lo, hi]} = geometry.parts[i];
    const center = lo.map((x, k) => (x + hi[k]) / 2);
    const radius = Math.hypot(...lo.map((x, k) => hi[k] - x)) / 2;
    return {index: i, name: part.name, file: part.file, source: part, shape, place, lo, hi, center, radius};
  });
  return {plan, result, parts, shapes: geometry.shapes.map(readShape), view: readView(data.view)};
}

export const readPage = document => readData(document.getElementById('dismantle-data').textContent.trim());
