// The drawing of solids. One WebGL 2 context, which is not shown, draws all of them, since a browser gives only a few; each canvas gets
// a copy of what was drawn for it, and only when something has changed.

const VERTEX = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 color;
layout(location = 3) in vec2 uv;
uniform mat4 scene, view;
uniform mat3 turn;
out vec3 facing, tint, seen;
out vec2 place;
void main() {
  vec4 there = view * vec4(position, 1.0);
  facing = turn * normal;
  tint = color;
  place = uv;
  seen = there.xyz;
  gl_Position = scene * there;
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec3 facing, tint, seen;
in vec2 place;
uniform vec4 base;
uniform sampler2D picture;
uniform bool pictured;
out vec4 result;
void main() {
  vec3 n = normalize(facing);
  vec3 v = normalize(-seen);
  if (dot(n, v) < 0.0) n = -n;
  vec3 color = base.rgb * tint;
  if (pictured) color *= pow(texture(picture, place).rgb, vec3(2.2));
  float sky = 0.5 + 0.5 * n.y;
  float key = max(dot(n, normalize(vec3(-0.5, 0.75, 0.6))), 0.0);
  float fill = max(dot(n, normalize(vec3(0.8, 0.1, 0.45))), 0.0);
  float rim = pow(1.0 - abs(dot(n, v)), 3.0);
  float shine = pow(max(dot(reflect(-v, n), normalize(vec3(-0.5, 0.75, 0.6))), 0.0), 24.0);
  vec3 light = color * (0.22 + 0.26 * sky + 0.72 * key + 0.2 * fill) + 0.06 * rim + 0.05 * shine;
  result = vec4(pow(light, vec3(1.0 / 2.2)), base.a);
}`;

// The angle of view.
const FIELD = 0.6;

const stage = {
  gl: null,
  models: new Set(),

  // The context; null where there is none.
  open() {
    if (this.gl) return this.gl;
    const canvas = document.createElement("canvas");
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true });
    if (!gl) return null;
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => {
      this.prepare();
      for (const viewer of this.models) viewer.upload();
    });
    this.gl = gl;
    this.prepare();
    return gl;
  },

  prepare() {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.enable(gl.DEPTH_TEST);
    const names = ["scene", "view", "turn", "base", "pictured"];
    this.at = Object.fromEntries(names.map((name) => [name, gl.getUniformLocation(program, name)]));
  },

  // The arrays of a shape on the graphics card.
  hold({ positions, normals, colors, uv, indices }) {
    const gl = this.gl;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const buffers = [];
    [[positions, 3], [normals, 3], [colors, 3], [uv, 2]].forEach(([values, size], location) => {
      if (!values) return;
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, size, gl.FLOAT, false, 0, 0);
      buffers.push(buffer);
    });
    const elements = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, elements);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    buffers.push(elements);
    const type = indices instanceof Uint16Array ? gl.UNSIGNED_SHORT : gl.UNSIGNED_INT;
    return { array, buffers, count: indices.length, type, plain: !colors };
  },

  async picture(blob) {
    const gl = this.gl;
    const bitmap = await createImageBitmap(blob);
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    return texture;
  },

  drop({ shapes, textures }) {
    for (const { array, buffers } of shapes.values()) {
      this.gl.deleteVertexArray(array);
      buffers.forEach((buffer) => this.gl.deleteBuffer(buffer));
    }
    for (const texture of textures.values()) this.gl.deleteTexture(texture);
  },

  // Draws a model as a camera sees it, and copies it onto a canvas.
  draw(model, camera, canvas, width, height) {
    const gl = this.gl;
    if (gl.canvas.width < width) gl.canvas.width = width;
    if (gl.canvas.height < height) gl.canvas.height = height;
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(this.at.scene, false, perspective(camera, width / height));
    const from = eye(camera);
    const drawn = (part) => {
      const { array, count, type, plain } = model.shapes.get(part.shape);
      const texture = part.image && model.textures.get(part.image);
      gl.bindVertexArray(array);
      if (plain) gl.vertexAttrib3f(2, 1, 1, 1);
      if (texture) gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(this.at.pictured, texture ? 1 : 0);
      const view = multiplied(from, part.matrix);
      gl.uniformMatrix4fv(this.at.view, false, view);
      gl.uniformMatrix3fv(this.at.turn, false, normals(view));
      gl.uniform4fv(this.at.base, part.color);
      gl.drawElements(gl.TRIANGLES, count, type, 0);
    };
    model.parts.filter((part) => part.color[3] >= 1).forEach(drawn);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    model.parts.filter((part) => part.color[3] < 1).forEach(drawn);
    gl.disable(gl.BLEND);
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    const paper = canvas.getContext("2d");
    paper.clearRect(0, 0, width, height);
    paper.drawImage(gl.canvas, 0, gl.canvas.height - height, width, height, 0, 0, width, height);
  },
};

// Where a camera stands: its axes, and its place.
function axes({ yaw, pitch, distance, target }) {
  const [cy, sy, cp, sp] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
  const right = [cy, 0, -sy];
  const back = [sy * cp, sp, cy * cp];
  const up = [-sy * sp, cp, -cy * sp];
  return { right, up, back, place: target.map((at, axis) => at + back[axis] * distance) };
}

// What turns normals where a matrix turns points: its cofactors, which is its inverse transposed but for a length.
function normals(m) {
  const [a, b, c] = [0, 4, 8].map((at) => m.slice(at, at + 3));
  const cross = (u, v) => [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  return [...cross(b, c), ...cross(c, a), ...cross(a, b)];
}

function eye(camera) {
  const { right, up, back, place } = axes(camera);
  const along = (axis) => -(axis[0] * place[0] + axis[1] * place[1] + axis[2] * place[2]);
  const columns = [0, 1, 2].flatMap((k) => [right[k], up[k], back[k], 0]);
  return [...columns, along(right), along(up), along(back), 1];
}

function perspective({ distance, radius }, aspect) {
  const scale = 1 / Math.tan(FIELD / 2);
  const [near, far] = [Math.max(distance - radius * 3, distance / 100), distance + radius * 3];
  const [x, y] = aspect < 1 ? [scale, scale * aspect] : [scale / aspect, scale];
  return [x, 0, 0, 0, 0, y, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
}

