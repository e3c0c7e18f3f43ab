// Pictures that are moved and enlarged in their frames. A picture is told where to stand in parts of its frame, so that it stays there
// when the frame changes.

class Pan {
  constructor(image, name) {
    this.image = image;
    this.name = name;
    this.place = kept.get(`place ${name}`) ?? { x: 0, y: 0, scale: 1 };
    this.draw();
  }

  // Shows another picture once it is there; where several follow one another, the last.
  async show(source) {
    const next = new Image();
    next.src = source;
    this.next = next;
    try {
      await next.decode();
    } catch {
      // What cannot be shown is not: the browser says so in its place.
    }
    if (this.next === next) this.image.src = source;
  }

  fit() {
    this.place = { x: 0, y: 0, scale: 1 };
    this.changed();
  }

  changed() {
    kept.set(`place ${this.name}`, this.place);
    this.draw();
  }

  draw() {
    const { x, y, scale } = this.place;
    this.image.style.transform = `translate(${x * 100}%, ${y * 100}%) scale(${scale})`;
  }

  turn(dx, dy) {
    this.move(dx, dy);
  }

  move(dx, dy) {
    const { clientWidth, clientHeight } = this.image;
    this.place = { ...this.place, x: this.place.x + dx / clientWidth, y: this.place.y + dy / clientHeight };
    this.changed();
  }

  // Enlarges by a factor about a point of the frame, by default its middle.
  zoom(factor, point) {
    const { clientWidth, clientHeight } = this.image;
    const scale = Math.min(Math.max(this.place.scale * factor, 0.2), 400);
    const real = scale / this.place.scale;
    const [px, py] = point ? [point.x / clientWidth, point.y / clientHeight] : [0.5, 0.5];
    const { x, y } = this.place;
    this.place = { x: px - (px - x) * real, y: py - (py - y) * real, scale };
    this.changed();
  }
}

