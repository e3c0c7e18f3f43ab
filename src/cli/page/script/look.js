// Looking at the page: which spec, which figure of a card, how large, and hands on pictures and solids.

const viewers = new WeakMap();

// A wheel over a figure scrolls the page until the figure has been touched.
let active = null;

function activate(figures) {
  if (active === figures) return;
  active?.removeAttribute("data-active");
  active = figures;
  active?.setAttribute("data-active", "");
}

const toSee = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    if (!isIntersecting) continue;
    toSee.unobserve(target);
    load(target);
  }
}, { rootMargin: "200px" });

// Loads what a canvas is to show. The newest source counts.
async function load(canvas) {
  const viewer = viewers.get(canvas);
  const source = canvas.dataset.src;
  viewer.wanted = source;
  try {
    const buffer = source ? await fetched(source) : decoded(canvas.parentElement.querySelector("[data-solids]"));
    if (viewer.wanted !== source) return;
    await viewer.show(buffer);
    const still = canvas.parentElement.querySelector(".still");
    if (still) still.hidden = true;
    canvas.removeAttribute("data-failed");
  } catch (error) {
    // A file that is gone already belongs to a build that has been overtaken.
    canvas.dataset.failed = error.message;
  }
}

async function fetched(source) {
  const response = await fetch(source);
  if (!response.ok) throw new Error(`${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}

function decoded(template) {
  const text = atob(template.content.textContent.trim());
  const bytes = new Uint8Array(text.length);
  for (let at = 0; at < text.length; at += 1) bytes[at] = text.charCodeAt(at);
  return bytes.buffer;
}

// Gives every figure below a node its viewer, and every card its handles.
function attach(root) {
  for (const element of root.querySelectorAll("canvas[data-viewer], img[data-viewer]")) {
    if (viewers.has(element)) continue;
    const figure = element.closest("[data-figure]");
    const name = figure.dataset.figure;
    if (element instanceof HTMLCanvasElement) {
      viewers.set(element, new Turn(element, name));
      element.hidden = false;
      toSee.observe(element);
    } else if (!element.classList.contains("still")) {
      viewers.set(element, new Pan(element, name));
    }
  }
  for (const figures of root.querySelectorAll(".figures")) {
    if (figures.dataset.handled) continue;
    figures.dataset.handled = "yes";
    if (figures.querySelector("[data-viewer]")) handle(figures);
    const card = figures.closest("[data-card]").dataset.card;
    choose(figures, kept.get(`figure ${card}`));
  }
}

// The viewer that is in front.
function front(figures) {
  const figure = figures.querySelector(".figure:not([hidden])");
  return viewers.get(figure?.querySelector("canvas[data-viewer]") ?? figure?.querySelector("img[data-viewer]"));
}

// Brings a figure of a card to the front, by default the first.
function choose(figures, name) {
  const all = [...figures.querySelectorAll(".figure")];
  const chosen = all.find((figure) => figure.dataset.figure === name) ?? all[0];
  for (const figure of all) figure.hidden = figure !== chosen;
  const tabs = figures.querySelector(".tabs");
  if (!tabs) return;
  tabs.hidden = false;
  for (const tab of tabs.children) tab.setAttribute("aria-pressed", String(tab.dataset.show === chosen.dataset.figure));
}

// Gives the figures of a card what hands need.
function handle(figures) {
  figures.tabIndex = 0;
  addTools(figures);
  followPointers(figures);
  figures.addEventListener("contextmenu", (event) => {
    if (event.target instanceof HTMLCanvasElement) event.preventDefault();
  });
  figures.addEventListener("wheel", (event) => {
    if (active !== figures && !event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 20 : 1;
    const factor = Math.exp(-event.deltaY * lines * (event.ctrlKey ? 0.01 : 0.0015));
    front(figures)?.zoom(factor, within(figures, { x: event.clientX, y: event.clientY }));
  }, { passive: false });
  figures.addEventListener("dblclick", (event) => {
    if (!event.target.closest("button")) front(figures)?.fit();
  });
  figures.addEventListener("keydown", (event) => steer(figures, event));
}

function addTools(figures) {
  const tools = document.createElement("div");
  tools.className = "tools";
  for (const [tool, sign, what] of [["fit", "⤢", "show all of it"], ["large", "□", "enlarge"]]) {
    const button = document.createElement("button");
    Object.assign(button, { type: "button", textContent: sign, title: what });
    button.dataset.tool = tool;
    button.setAttribute("aria-label", what);
    tools.append(button);
  }
  figures.append(tools);
}

// A point of the window as one of the frame.
function within(figures, { x, y }) {
  const box = figures.getBoundingClientRect();
  return { x: x - box.x, y: y - box.y };
}

// One pointer turns, or moves with Shift or another button; two enlarge.
function followPointers(figures) {
  const pointers = new Map();
  const at = ({ clientX, clientY }) => ({ x: clientX, y: clientY });
  figures.addEventListener("pointerdown", (event) => {
    if (event.target.closest("button")) return;
    // The first touch of a finger scrolls the page, as everywhere else.
    const isFirst = event.pointerType === "touch" && active !== figures;
    activate(figures);
    if (isFirst) return;
    figures.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, at(event));
  });
  figures.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const [now, viewer] = [at(event), front(figures)];
    const [dx, dy] = [now.x - before.x, now.y - before.y];
    if (pointers.size === 2) {
      const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
      const span = (point) => Math.max(Math.hypot(point.x - other.x, point.y - other.y), 1);
      const middle = { x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 };
      viewer?.zoom(span(now) / span(before), within(figures, middle));
      viewer?.move(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons & 6) {
      viewer?.move(dx, dy);
    } else {
      viewer?.turn(dx, dy);
    }
    pointers.set(event.pointerId, now);
  });
  for (const end of ["pointerup", "pointercancel"]) {
    figures.addEventListener(end, (event) => pointers.delete(event.pointerId));
  }
}

// Keys on a figure: arrows turn or move, plus and minus enlarge, 0 shows all, Enter makes it large.
function steer(figures, event) {
  if (event.target !== figures || event.ctrlKey || event.metaKey || event.altKey) return;
  const viewer = front(figures);
  const step = 20;
  const deeds = {
    ArrowLeft: () => viewer?.turn(-step, 0),
    ArrowRight: () => viewer?.turn(step, 0),
    ArrowUp: () => viewer?.turn(0, -step),
    ArrowDown: () => viewer?.turn(0, step),
    "+": () => viewer?.zoom(1.2),
    "-": () => viewer?.zoom(1 / 1.2),
    0: () => viewer?.fit(),
    Enter: () => enlarge(figures.closest("article")),
  };
  const deed = deeds[event.key];
  if (!deed) return;
  event.preventDefault();
  deed();
}

// Makes a card fill the window, or gives it back its place.
function enlarge(card) {
  const large = document.querySelector("article[data-large]");
  large?.removeAttribute("data-large");
  const isNew = card && card !== large;
  if (isNew) card.setAttribute("data-large", "");
  document.body.toggleAttribute("data-enlarged", Boolean(isNew));
  if (isNew) activate(card.querySelector(".figures"));
}

// Shows the spec that the address names, or all of them.
function goto() {
  const path = decodeURIComponent(location.hash.slice(1));
  const sections = [...document.querySelectorAll("[data-spec-section]")];
  const isKnown = sections.some((section) => section.dataset.specSection === path);
  for (const section of sections) {
    section.toggleAttribute("data-away", isKnown && section.dataset.specSection !== path);
  }
  document.body.toggleAttribute("data-single", isKnown || sections.length === 1);
  for (const link of document.querySelectorAll("[data-goto]")) {
    const isHere = link.dataset.goto === (isKnown ? path : "");
    if (isHere) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
    if (isHere) reveal(link);
  }
  sift();
}

// Scrolls the list of specs, and nothing else, to a link.
function reveal(link) {
  const list = link.closest("aside");
  const beyond = link.offsetTop - list.scrollTop;
  if (beyond < 0 || beyond > list.clientHeight - 30) list.scrollTop = link.offsetTop - list.clientHeight / 2;
}

// Shows the links of specs whose path holds what is looked for.
function sift() {
  const filter = document.querySelector("[data-filter]");
  if (!filter) return;
  filter.hidden = false;
  const sought = filter.value.trim().toLowerCase();
  for (const link of document.querySelectorAll("[data-goto]")) {
    const isFound = !link.dataset.goto || link.dataset.goto.toLowerCase().includes(sought);
    link.toggleAttribute("data-away", !isFound);
  }
}

// Marks a node of a graph with what it needs and what needs it.
function select(row) {
  const table = row.closest("table");
  const isOff = row.hasAttribute("data-selected");
  const rows = [...table.rows];
  for (const other of rows) {
    const needs = other.dataset.needs.split(" ");
    const isNear = row.dataset.needs.split(" ").includes(other.dataset.id) || needs.includes(row.dataset.id);
    other.toggleAttribute("data-selected", !isOff && other === row);
    other.toggleAttribute("data-near", !isOff && isNear);
  }
}

// Opens again what a reader has opened.
function reopen(root) {
  for (const details of root.querySelectorAll("details[data-keep]")) {
    if (kept.get(`open ${details.dataset.keep}`)) details.open = true;
  }
}

