// What a reader has set up on the page, by name: kept through rebuilds, and through a reload where the browser lets us.

const kept = {
  memory: new Map(),

  get(name) {
    if (this.memory.has(name)) return this.memory.get(name);
    try {
      return JSON.parse(sessionStorage.getItem(`fretwork ${name}`)) ?? undefined;
    } catch {
      return undefined;
    }
  },

  set(name, value) {
    this.memory.set(name, value);
    try {
      sessionStorage.setItem(`fretwork ${name}`, JSON.stringify(value));
    } catch {
      // A page opened from a file, or a full store: it is kept until the page is closed.
    }
  },
};

