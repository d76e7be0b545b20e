// Reads what a .glb file of Dismantle says about places and times.

/** @returns {nodes, animations}: {at, turn} by part name; by animation name its steps and, by part name, keys {time, at, turn} */
export function readGlb(bytes) {
  const length = bytes.readUInt32LE(12), json = JSON.parse(bytes.toString('utf8', 20, 20 + length)), begin = 28 + length;
  function numbers(index) {
    const {bufferView, count, type} = json.accessors[index], offset = begin + (json.bufferViews[bufferView].byteOffset ?? 0);
    const width = {SCALAR: 1, VEC3: 3, VEC4: 4}[type], all = Array.from({length: count * width}, (_, k) => bytes.readFloatLE(offset + 4 * k));
    return width === 1 ? all : Array.from({length: count}, (_, k) => all.slice(width * k, width * k + width));
  }
  const real = ([x, y, z, w]) => [w, x, y, z];
  const nodes = new Map(json.nodes.slice(1).map(n => [n.name, {at: n.translation, turn: real(n.rotation ?? [0, 0, 0, 1])}]));
  const animations = new Map((json.animations ?? []).map(({name, channels, samplers, extras}) => {
    const keys = new Map(), samplerOf = (node, path) => {
      const channel = channels.find(c => c.target.node === node && c.target.path === path);
      return channel && samplers[channel.sampler];
    };
    for (const node of new Set(channels.map(c => c.target.node))) {
      const part = json.nodes[node].name, translation = samplerOf(node, 'translation'), rotation = samplerOf(node, 'rotation');
      const times = numbers(translation.input), at = numbers(translation.output), turn = rotation && numbers(rotation.output);
      keys.set(part, times.map((time, k) => ({time, at: at[k], turn: turn ? real(turn[k]) : nodes.get(part).turn})));
    }
    return [name, {steps: extras.steps, keys}];
  }));
  return {nodes, animations};
}
