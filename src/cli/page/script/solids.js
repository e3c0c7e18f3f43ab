// Reading a GLB as our writer writes it: one buffer, triangles with positions, normals, and colours or places on a picture;
// nodes that are placed by a matrix or moved, at most in groups.

const COMPONENTS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
const ARRAYS = { 5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };

// The parts of a file with their arrays, their places and their looks, the box around all, and how many triangles there are.
function readSolids(buffer) {
  const words = new DataView(buffer);
  if (words.getUint32(0, true) !== 0x46546c67) throw new Error("this is no GLB");
  const length = words.getUint32(12, true);
  const root = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 20, length)));
  const start = 28 + length;

  const view = (number) => {
    const { byteOffset = 0, byteLength } = root.bufferViews[number];
    return { offset: start + byteOffset, length: byteLength };
  };
  const array = (number) => {
    if (number === undefined) return undefined;
    const { bufferView, byteOffset = 0, componentType, count, type } = root.accessors[number];
    return new ARRAYS[componentType](buffer, view(bufferView).offset + byteOffset, count * COMPONENTS[type]);
  };
  const image = (number) => {
    if (number === undefined) return undefined;
    const { bufferView, mimeType } = root.images[root.textures[number].source];
    const { offset, length } = view(bufferView);
    return new Blob([new Uint8Array(buffer, offset, length)], { type: mimeType });
  };
  const look = (number) => {
    const { pbrMetallicRoughness: surface = {} } = root.materials?.[number] ?? {};
    return {
      color: surface.baseColorFactor ?? [0.62, 0.6, 0.56, 1],
      image: image(surface.baseColorTexture?.index),
    };
  };

  const solids = { parts: [], triangles: 0, low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
  const shapes = new Map();
  const place = (number, above) => {
    const node = root.nodes[number];
    const matrix = multiplied(above, node.matrix ?? moved(node.translation ?? [0, 0, 0]));
    for (const { attributes, indices, material } of root.meshes[node.mesh]?.primitives ?? []) {
      const key = `${attributes.POSITION} ${indices}`;
      if (!shapes.has(key)) {
        shapes.set(key, {
          positions: array(attributes.POSITION),
          normals: array(attributes.NORMAL),
          colors: array(attributes.COLOR_0),
          uv: array(attributes.TEXCOORD_0),
          indices: array(indices),
        });
      }
      const shape = shapes.get(key);
      solids.parts.push({ name: node.name, shape, matrix, ...look(material) });
      solids.triangles += shape.indices.length / 3;
      grow(solids, root.accessors[attributes.POSITION], matrix);
    }
    for (const child of node.children ?? []) place(child, matrix);
  };
  for (const number of root.scenes[root.scene ?? 0].nodes) place(number, moved([0, 0, 0]));
  return solids;
}

// Makes the box hold the corners of a shape's box.
function grow(solids, { min, max }, matrix) {
  for (let corner = 0; corner < 8; corner += 1) {
    const point = [0, 1, 2].map((axis) => ((corner >> axis) & 1 ? max : min)[axis]);
    const there = applied(matrix, point);
    for (let axis = 0; axis < 3; axis += 1) {
      solids.low[axis] = Math.min(solids.low[axis], there[axis]);
      solids.high[axis] = Math.max(solids.high[axis], there[axis]);
    }
  }
}

// Matrices are by columns, as WebGL has them.
function moved([x, y, z]) {
  return [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1];
}

function multiplied(a, b) {
  const product = new Array(16).fill(0);
  for (let column = 0; column < 4; column += 1) {
    for (let row = 0; row < 4; row += 1) {
      for (let k = 0; k < 4; k += 1) product[column * 4 + row] += a[k * 4 + row] * b[column * 4 + k];
    }
  }
  return product;
}

function applied(m, [x, y, z]) {
  return [0, 1, 2].map((row) => m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row]);
}

