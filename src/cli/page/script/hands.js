// What is done when somebody clicks, types or follows a link, and the page as it is at first.

document.addEventListener("click", (event) => {
  const button = event.target.closest("button");
  if (button?.dataset.show) {
    const figures = button.closest(".figures");
    kept.set(`figure ${button.closest("[data-card]").dataset.card}`, button.dataset.show);
    choose(figures, button.dataset.show);
  } else if (button?.dataset.tool === "fit") {
    front(button.closest(".figures"))?.fit();
  } else if (button?.dataset.tool === "large") {
    enlarge(button.closest("article"));
  }
  const row = event.target.closest("tr[data-id]");
  if (row) select(row);
  const jump = event.target.closest("[data-jump]");
  if (jump) {
    event.preventDefault();
    document.getElementById(jump.dataset.jump).scrollIntoView({ behavior: "smooth", block: "start" });
  }
});
document.addEventListener("pointerdown", (event) => {
  if (!event.target.closest(".figures")) activate(null);
});
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") enlarge(null);
  const row = event.target.closest?.("tr[data-id]");
  if (row && event.key === "Enter") select(row);
});
document.addEventListener("toggle", (event) => {
  const name = event.target.dataset?.keep;
  if (name) kept.set(`open ${name}`, event.target.open);
}, true);
document.addEventListener("input", (event) => {
  if (event.target.matches("[data-filter]")) sift();
});
addEventListener("hashchange", () => {
  goto();
  scrollTo(0, 0);
});

attach(document);
reopen(document);
goto();

