// Controls of parameters: what a hand sets is sent at once, and never more than one value is on its way; of those that follow, the
// newest wins. What has been set here is not put back by a build that does not know of it yet.

const tuning = {
  // By spec: values that wait to be sent.
  waiting: new Map(),
  // By spec and name: what was set here, and the first build that shows it.
  set: new Map(),
  // The build that shows what was sent last; a new value is sent when it is there, or has been long in coming.
  coming: 0,
  since: 0,
  isSending: false,
};

// A build that takes longer is given up for a newer value.
const PATIENCE = 250;

const controlOf = (row) => row.querySelector("[data-param]");

// What a control stands at, as `--set` takes it.
function valueOf(control) {
  if (control.type === "checkbox") return String(control.checked);
  if (control.type !== "range" || control.step !== "any") return control.value;
  const step = Number(control.dataset.step);
  const digits = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  return String(Number((Math.round(Number(control.value) / step) * step).toFixed(digits)));
}

function put(control, value) {
  if (control.type === "checkbox") control.checked = value === "true";
  else control.value = value;
}

// Shows beside a control what it stands at, and whether that is its default.
function mark(row, value) {
  const control = controlOf(row);
  const exact = row.querySelector("[data-exact]");
  if (exact && document.activeElement !== exact) exact.value = value;
  row.toggleAttribute("data-changed", value !== control.dataset.default);
}

function wish(control, value) {
  const { spec, param } = control.dataset;
  const values = tuning.waiting.get(spec) ?? {};
  values[param] = value === control.dataset.default ? null : value;
  tuning.waiting.set(spec, values);
  tuning.set.set(`${spec} ${param}`, { value, build: Infinity });
  mark(control.closest("[data-param-row]"), value);
  send();
}

async function send() {
  const wait = tuning.coming > Number(document.body.dataset.build) ? PATIENCE - (performance.now() - tuning.since) : 0;
  if (tuning.isSending || tuning.waiting.size === 0) return;
  if (wait > 0) {
    clearTimeout(tuning.later);
    tuning.later = setTimeout(send, wait);
    return;
  }
  const [[spec, values]] = tuning.waiting;
  tuning.waiting.delete(spec);
  tuning.isSending = true;
  try {
    const headers = { "Content-Type": "application/json" };
    const response = await fetch("/set", { method: "POST", headers, body: JSON.stringify({ spec, values }) });
    const answer = await response.json();
    if (response.ok) {
      tuning.coming = answer.build;
      tuning.since = performance.now();
    }
    settle(spec, values, response.ok ? answer.build : 0, answer);
  } catch {
    settle(spec, values, 0, {});
  }
  tuning.isSending = false;
  send();
}

// Notes which build shows what was sent; what was refused stays in its control, with the reason below.
function settle(spec, values, build, { diagnostics = [] }) {
  for (const name of Object.keys(values)) {
    const set = tuning.set.get(`${spec} ${name}`);
    if (!(name in (tuning.waiting.get(spec) ?? {})) && set) set.build = build || Infinity;
  }
  const form = document.querySelector(`[data-params="${CSS.escape(spec)}"]`);
  const refused = form?.querySelector("[data-refused]");
  if (!refused) return;
  refused.hidden = diagnostics.length === 0;
  refused.textContent = diagnostics.map(({ message }) => message).join("\n");
}

// Puts the controls of a form at what a build was made with, but for those that a hand has set since.
function follow(form, next) {
  const build = Number(document.body.dataset.build);
  for (const row of form.querySelectorAll("[data-param-row]")) {
    const control = controlOf(row);
    const name = row.dataset.paramRow;
    const made = next.querySelector(`[data-param-row="${CSS.escape(name)}"] [data-param]`);
    if (!control || !made) continue;
    const key = `${control.dataset.spec} ${name}`;
    const set = tuning.set.get(key);
    if (set && set.build > build) continue;
    tuning.set.delete(key);
    const value = made.type === "checkbox" ? String(made.checked) : made.getAttribute("value") ?? made.value;
    if (document.activeElement !== control || control.type !== "text") put(control, value);
    mark(row, value);
  }
}

// A server that was started anew knows of nothing that was set before.
function forget() {
  tuning.set.clear();
  tuning.waiting.clear();
  tuning.coming = 0;
}

function reset(spec) {
  const form = document.querySelector(`[data-params="${CSS.escape(spec)}"]`);
  for (const row of form.querySelectorAll("[data-param-row]")) {
    const control = controlOf(row);
    put(control, control.dataset.default);
    wish(control, control.dataset.default);
  }
}

document.addEventListener("input", ({ target }) => {
  // A word is not sent letter by letter.
  if (target.matches("[data-param]") && target.type !== "text") wish(target, valueOf(target));
});
document.addEventListener("change", ({ target }) => {
  if (target.matches("[data-param][type=text]")) wish(target, target.value);
  if (!target.matches("[data-exact]")) return;
  const control = controlOf(target.closest("[data-param-row]"));
  // A slider does not know of units; the build that follows puts it where it belongs.
  if (target.value.trim() !== "" && Number.isFinite(Number(target.value))) put(control, target.value);
  wish(control, target.value.trim());
});
document.addEventListener("submit", (event) => event.preventDefault());
document.addEventListener("click", ({ target }) => {
  const button = target.closest("button");
  if (button?.dataset.resetAll) reset(button.dataset.resetAll);
  if (button?.dataset.copy) {
    navigator.clipboard?.writeText(button.dataset.copy);
    button.textContent = "copied";
    setTimeout(() => (button.textContent = "copy"), 1200);
  }
});
document.addEventListener("dblclick", ({ target }) => {
  const control = target.matches("label") && target.closest("[data-param-row]")?.querySelector("[data-param]");
  if (!control) return;
  put(control, control.dataset.default);
  wish(control, control.dataset.default);
});
for (const row of document.querySelectorAll("[data-param-row]")) {
  if (controlOf(row)) mark(row, valueOf(controlOf(row)));
}

