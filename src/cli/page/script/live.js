// Following the builds of a page that is served. A new build is taken over where it differs, so that whatever a reader has set up
// stays as it is.

// What tells an element among its neighbours.
const KEYS = ["data-spec-section", "data-card", "data-figure", "data-param-row", "data-id", "data-goto", "data-artifact", "data-part"];
// What belongs to the reader.
const OURS = new Set(["style", "open", "tabindex", "aria-pressed", "aria-current", "data-active", "data-large", "data-away", "data-handled",
  "data-selected", "data-near", "data-triangles", "data-failed", "data-changed"]);

function keyOf(element) {
  const name = KEYS.find((key) => element.hasAttribute?.(key));
  return name && `${name} ${element.getAttribute(name)}`;
}

const isOurs = (element, name) =>
  OURS.has(name) || (name === "hidden" && element.matches(".figure, .tabs, canvas, [data-filter], [data-refused], [data-progress]"));

function takeAttributes(old, made) {
  for (const { name } of [...old.attributes]) {
    if (!made.hasAttribute(name) && !isOurs(old, name)) old.removeAttribute(name);
  }
  for (const { name, value } of made.attributes) {
    if (!isOurs(old, name) && old.getAttribute(name) !== value) old.setAttribute(name, value);
  }
}

// Makes `old` say what `made` says. Elements with the same key, or of the same kind in the same place, stay.
function take(old, made) {
  if (old.isEqualNode(made)) return;
  if (old.matches("[data-viewer]")) {
    takeViewer(old, made);
    return;
  }
  if (old.matches("input, select")) {
    for (const name of ["min", "max", "step", "data-default", "data-step"]) {
      if (made.hasAttribute(name)) old.setAttribute(name, made.getAttribute(name));
    }
    return;
  }
  takeAttributes(old, made);
  takeChildren(old, made);
}

function takeChildren(old, made) {
  const known = new Map();
  for (const child of old.children) if (keyOf(child)) known.set(keyOf(child), child);
  let place = old.firstChild;
  for (const next of [...made.childNodes]) {
    const key = keyOf(next);
    while (place?.classList?.contains("tools")) place = place.nextSibling;
    const isLike = place && !keyOf(place) && !key && place.nodeName === next.nodeName;
    const same = key ? known.get(key) : isLike && place;
    if (same && same.nodeName === next.nodeName) {
      if (same !== place) old.insertBefore(same, place);
      else place = place.nextSibling;
      if (same.nodeType === Node.ELEMENT_NODE) take(same, next);
      else if (same.nodeValue !== next.nodeValue) same.nodeValue = next.nodeValue;
    } else {
      old.insertBefore(document.importNode(next, true), place);
    }
  }
  while (place) {
    const after = place.nextSibling;
    if (!place.classList?.contains("tools")) place.remove();
    place = after;
  }
}

function takeViewer(old, made) {
  const name = old.matches("canvas") ? "data-src" : "src";
  const source = made.getAttribute(name);
  if (old.getAttribute(name) === source || viewers.get(old)?.coming === source) return;
  const viewer = viewers.get(old);
  if (old.matches("canvas")) {
    old.dataset.src = source;
    // One that nobody has seen yet is loaded when somebody does.
    if (viewer?.wanted) load(old);
  } else if (viewer) {
    viewer.coming = source;
    viewer.show(source);
  } else {
    old.src = source;
  }
}

const following = { isBusy: false, isStale: false };

async function refresh() {
  following.isStale = true;
  if (following.isBusy) return;
  following.isBusy = true;
  try {
    while (following.isStale) {
      following.isStale = false;
      const response = await fetch("/");
      if (response.ok) takeOver(new DOMParser().parseFromString(await response.text(), "text/html"));
    }
  } catch {
    // The stream of events says whether the server is there.
  }
  following.isBusy = false;
}

function takeOver(made) {
  const { scrollX, scrollY } = window;
  document.title = made.title;
  if (Number(made.body.dataset.build) < Number(document.body.dataset.build)) forget();
  document.body.dataset.build = made.body.dataset.build;
  for (const part of ["header", "aside", "main"]) {
    take(document.querySelector(`body > ${part}`), made.querySelector(`body > ${part}`));
  }
  attach(document);
  for (const form of document.querySelectorAll("[data-params]")) {
    const next = made.querySelector(`[data-params="${CSS.escape(form.dataset.params)}"]`);
    if (next) follow(form, next);
  }
  for (const figures of document.querySelectorAll(".figures")) {
    if (!front(figures)) choose(figures, kept.get(`figure ${figures.closest("[data-card]").dataset.card}`));
  }
  goto();
  scrollTo(scrollX, scrollY);
  document.querySelector("[data-progress]").hidden = true;
  send();
}

function tellProgress({ done, total, running }) {
  const line = document.querySelector("[data-progress]");
  line.hidden = false;
  line.textContent = `${done} of ${total} ${running.join(", ")}`;
  line.style.setProperty("--done", `${total ? (done / total) * 100 : 0}%`);
}

const stream = {
  open() {
    clearTimeout(this.later);
    if (this.source) return;
    this.source = new EventSource("/events");
    this.source.addEventListener("build", refresh);
    this.source.addEventListener("progress", ({ data }) => tellProgress(JSON.parse(data)));
    this.source.addEventListener("open", () => document.body.removeAttribute("data-alone"));
    this.source.addEventListener("error", () => {
      document.body.setAttribute("data-alone", "");
      // A browser that was turned away does not try again by itself.
      if (this.source?.readyState === EventSource.CLOSED) {
        this.close();
        this.later = setTimeout(() => this.open(), 2000);
      }
    });
  },

  close() {
    this.source?.close();
    this.source = null;
  },
};

if (document.body.dataset.build !== undefined) {
  stream.open();
  // Pages in the background leave their connection to others, of which a browser has only six.
  document.addEventListener("visibilitychange", () => {
    if (document.hidden) stream.later = setTimeout(() => stream.close(), 20000);
    else stream.open();
  });
}
