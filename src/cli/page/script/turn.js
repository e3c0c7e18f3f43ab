// Solids that turn.

// Where frames follow one another more slowly, they have fewer pixels while somebody turns it.
const SLOW = 50;
// From where they are seen at first.
const HOME = { yaw: 0.55, pitch: 0.42 };

// A canvas on which solids turn. Its camera is kept under a name, and stays where it is when the solids change.
class Turn {
  constructor(canvas, name) {
    this.canvas = canvas;
    this.name = name;
    this.camera = kept.get(`camera ${name}`);
    this.fine = 1;
    new ResizeObserver(() => this.ask()).observe(canvas);
  }

  // Shows a file from now on; what was shown stays until it is there.
  async show(buffer) {
    const solids = readSolids(buffer);
    if (!stage.open()) throw new Error("this browser has no WebGL 2");
    this.solids = solids;
    await this.upload();
    this.canvas.dataset.triangles = solids.triangles;
  }

  async upload() {
    const { solids } = this;
    const model = { parts: solids.parts, shapes: new Map(), textures: new Map() };
    for (const { shape, image } of solids.parts) {
      if (!model.shapes.has(shape)) model.shapes.set(shape, stage.hold(shape));
      if (image && !model.textures.has(image)) model.textures.set(image, await stage.picture(image));
    }
    if (this.solids !== solids) {
      stage.drop(model);
      return;
    }
    if (this.model) stage.drop(this.model);
    this.model = model;
    stage.models.add(this);
    const size = solids.high.map((high, axis) => high - solids.low[axis]);
    this.radius = Math.max(Math.hypot(...size) / 2, 1e-6);
    this.half = size.map((length) => length / 2);
    this.middle = solids.low.map((low, axis) => low + size[axis] / 2);
    if (this.camera) this.draw();
    else this.fit();
  }

  // Shows all of it from the front, a little from above: as near as the corners of its box allow.
  fit() {
    if (!this.model) return;
    const { right, up, back } = axes({ ...HOME, distance: 0, target: this.middle });
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const slope = Math.tan(FIELD / 2) * 0.94;
    const [across, along] = width < height ? [slope, (slope * height) / width] : [(slope * width) / height, slope];
    let distance = 0;
    for (let corner = 0; corner < 8; corner += 1) {
      const from = this.half.map((half, axis) => ((corner >> axis) & 1 ? half : -half));
      const [x, y, z] = [right, up, back].map((along) => along[0] * from[0] + along[1] * from[1] + along[2] * from[2]);
      distance = Math.max(distance, z + Math.abs(x) / across, z + Math.abs(y) / along);
    }
    this.camera = { ...HOME, distance: Math.max(distance, this.radius * 1.01), target: this.middle };
    this.draw();
    kept.set(`camera ${this.name}`, undefined);
  }

  changed() {
    kept.set(`camera ${this.name}`, this.camera);
    this.moving = performance.now();
    this.ask();
  }

  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.draw();
    });
  }

  draw() {
    const { clientWidth, clientHeight } = this.canvas;
    if (!this.model || !clientWidth || !clientHeight) return;
    const isMoving = performance.now() - (this.moving ?? -1e9) < 150;
    const density = Math.min(devicePixelRatio || 1, 2) * (isMoving ? this.fine : 1);
    const sizes = [clientWidth, clientHeight].map((size) => Math.max(1, Math.round(size * density)));
    // What lies beyond a solid that has grown is drawn too.
    const beyond = Math.hypot(...this.middle.map((at, axis) => at - this.camera.target[axis]));
    const gap = performance.now() - (this.drawn ?? 0);
    this.drawn = performance.now();
    stage.draw(this.model, { ...this.camera, radius: this.radius + beyond }, this.canvas, ...sizes);
    if (isMoving) {
      if (gap > SLOW && gap < 2000) this.fine = Math.max(this.fine / 2, 0.25);
      clearTimeout(this.later);
      this.later = setTimeout(() => this.ask(), 200);
    }
  }

  turn(dx, dy) {
    if (!this.camera) return;
    const pitch = Math.min(Math.max(this.camera.pitch + dy * 0.01, -1.57), 1.57);
    this.camera = { ...this.camera, yaw: this.camera.yaw - dx * 0.01, pitch };
    this.changed();
  }

  move(dx, dy) {
    if (!this.camera) return;
    const { right, up } = axes(this.camera);
    const step = (this.camera.distance * 2 * Math.tan(FIELD / 2)) / Math.min(this.canvas.clientWidth, this.canvas.clientHeight);
    const target = this.camera.target.map((at, axis) => at + (up[axis] * dy - right[axis] * dx) * step);
    this.camera = { ...this.camera, target };
    this.changed();
  }

  zoom(factor) {
    if (!this.camera) return;
    const distance = Math.min(Math.max(this.camera.distance / factor, this.radius / 200), this.radius * 200);
    this.camera = { ...this.camera, distance };
    this.changed();
  }
}

