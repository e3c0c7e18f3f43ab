// The page in Chromium, looked at from outside. Arguments: the part to run, the folder of packages, the browser, and what that
// part needs. Ends with 1 at the first thing that is not as it should be.

import assert from "node:assert/strict";
import { readFileSync, readdirSync, renameSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const [part, packages, executablePath, ...rest] = process.argv.slice(2);
const { chromium } = createRequire(join(packages, "none.js"))("playwright-core");
// There is no graphics card where tests run, so that the processor draws.
const args = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const browser = await chromium.launch({ executablePath, args });

// A page that notes what goes wrong on it and what it asks for.
async function open(options = {}) {
  const context = await browser.newContext({ viewport: { width: 1200, height: 800 }, ...options });
  const page = await context.newPage();
  const wrong = [];
  const asked = [];
  page.on("console", (message) => message.type() === "error" && wrong.push(message.text()));
  page.on("pageerror", (error) => wrong.push(error.message));
  page.on("request", (request) => asked.push(request.url()));
  return { context, page, wrong, asked };
}

const build = (page) => page.evaluate(() => Number(document.body.dataset.build));
const after = (page, number) => page.waitForFunction((n) => Number(document.body.dataset.build) > n, number, { timeout: 20000 });
const triangles = (page) => page.locator("canvas[data-viewer=glb]").getAttribute("data-triangles").then(Number);
const source = (page) => page.locator("img[data-viewer=svg]").getAttribute("src");

// How many pixels of a canvas are drawn, and a sum that tells pictures apart.
const drawn = (page) =>
  page.locator("canvas[data-viewer=glb]").evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let [count, sum] = [0, 0];
    for (let at = 0; at < data.length; at += 4) {
      if (data[at + 3] > 0) count += 1;
      sum = (sum * 31 + data[at] + data[at + 3]) % 1000003;
    }
    return { count, sum };
  });

// What the reader has set up.
const view = (page) =>
  page.evaluate(() => ({
    camera: kept.get("camera spec/block.stl"),
    place: document.querySelector("img[data-viewer=svg]").style.transform,
    isOpen: document.querySelector("details.graph").open,
    selected: document.querySelector("tr[data-selected]")?.dataset.node,
  }));

async function live(address, folder) {
  const { page, wrong, asked } = await open();
  const spec = join(folder, "specs/spec.yaml");
  const edit = (from, to) => {
    const text = readFileSync(spec, "utf8");
    assert(text.includes(from), from);
    return text.replace(from, to);
  };
  await page.goto(address);
  await page.waitForSelector("canvas[data-triangles]", { timeout: 20000 });
  await page.waitForSelector("[data-artifact='spec/plate.svg']");
  const picture = await page.locator("img[data-viewer=svg]").evaluate((image) => image.decode().then(() => image.naturalWidth));
  assert(picture > 0, "the drawing is shown");
  const first = await drawn(page);
  assert(first.count > 1000, `solids are drawn: ${JSON.stringify(first)}`);
  console.log(`${await triangles(page)} triangles, ${first.count} pixels`);

  // A hand on the solids and on the drawing.
  const canvas = page.locator("canvas[data-viewer=glb]");
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox();
  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(...middle);
  await page.mouse.down();
  await page.mouse.move(middle[0] + 90, middle[1] + 30, { steps: 5 });
  await page.mouse.up();
  await page.mouse.wheel(0, -200);
  await page.waitForTimeout(400);
  const turned = await drawn(page);
  assert.notEqual(turned.sum, first.sum, "solids turn");
  const image = page.locator("img[data-viewer=svg]");
  await image.scrollIntoViewIfNeeded();
  const frame = await image.boundingBox();
  await page.mouse.click(frame.x + 50, frame.y + 50);
  await page.mouse.wheel(0, -300);
  await page.locator("details.graph summary").click();
  await page.locator("tr[data-node=plate]").click();
  await page.waitForTimeout(200);
  const setUp = await view(page);
  assert(setUp.isOpen && setUp.selected === "plate" && setUp.place.includes("scale(1."), JSON.stringify(setUp));

  // A control.
  const files = () => readdirSync(join(folder, "out/spec")).map((name) => [name, statSync(join(folder, "out/spec", name)).mtimeMs]);
  const before = { build: await build(page), files: files(), source: await source(page) };
  await page.locator("input[data-param=size][data-spec='specs/spec.yaml']").fill("80");
  await after(page, before.build);
  await page.waitForFunction((old) => document.querySelector("img[data-viewer=svg]").getAttribute("src") !== old, before.source);
  assert.deepEqual(await view(page), setUp, "the view is kept by a control");
  assert.deepEqual(files(), before.files, "nothing is written");
  assert.match(await page.locator("[data-command]").textContent(), /--set size=80$/);
  assert.equal(await page.locator("[data-exact=size]").inputValue(), "80");
  await page.locator("input[data-param=size]").evaluate((slider) => {
    // A hand that goes over many values at once.
    for (let value = 81; value <= 120; value += 1) {
      slider.value = value;
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    }
  });
  await page.waitForFunction(() => document.querySelector("[data-command]")?.textContent.includes("size=120"));
  assert.equal(await page.locator("input[data-param=size]").inputValue(), "120");
  await page.locator("[data-exact=turns]").fill("77");
  await page.locator("[data-exact=turns]").press("Enter");
  await page.waitForSelector("[data-refused]:not([hidden])");
  assert.match(await page.locator("[data-refused]").textContent(), /turns/);
  await page.locator("select[data-param=paper]").selectOption("lined");
  await page.waitForFunction(() => document.querySelector("[data-command]")?.textContent.includes("paper=lined"));
  await page.locator("[data-reset-all]").click();
  await page.waitForFunction(() => !document.querySelector("[data-command]"));
  assert.equal(await page.locator("input[data-param=size]").inputValue(), "60");
  console.log("controls");

  // Edits, by writing and by renaming.
  let number = await build(page);
  writeFileSync(spec, edit("radius: 10", "radius: 12"));
  await after(page, number);
  assert.deepEqual(await view(page), setUp, "the view is kept by an edit");
  const written = await triangles(page);
  for (const radius of [13, 14, 15]) {
    number = await build(page);
    const old = await source(page);
    writeFileSync(join(folder, "specs/.spec.swp"), edit(`radius: ${radius - 1}`, `radius: ${radius}`));
    renameSync(join(folder, "specs/.spec.swp"), spec);
    await after(page, number);
    await page.waitForFunction((was) => document.querySelector("img[data-viewer=svg]").getAttribute("src") !== was, old);
  }
  assert.equal(await triangles(page), written);
  assert.deepEqual(await view(page), setUp, "the view is kept by a rename");
  assert((await drawn(page)).count > 1000);

  // A build that fails.
  const good = await source(page);
  writeFileSync(spec, edit("radius: 15", "radius: wrong"));
  await page.waitForSelector("[data-diagnostic]");
  assert.match(await page.locator("[data-diagnostic] pre").first().textContent(), /radius: wrong/);
  assert.equal(await source(page), good, "the last good drawing stays");
  assert.match(await page.title(), /✗/);
  assert.deepEqual(await view(page), setUp, "the view is kept by a failure");
  writeFileSync(spec, edit("radius: wrong", "radius: 15"));
  await page.waitForFunction(() => !document.querySelector("[data-diagnostic]"));

  // A reload, and a spec that is added.
  await page.reload();
  await page.waitForSelector("canvas[data-triangles]");
  const again = await view(page);
  assert.deepEqual([again.camera, again.place], [setUp.camera, setUp.place], "the view is kept by a reload");
  writeFileSync(join(folder, "specs/more.yaml"), "fretwork: 1\nregions: { r: { circle: { radius: 9 } } }\nartifacts: { r.dxf: { from: r } }\n");
  await page.waitForSelector("[data-artifact='more/r.dxf']");
  await page.waitForSelector("img[data-viewer=svg][src*='as=svg']");
  await page.locator("a[data-goto='specs/more.yaml']").click();
  await page.locator("[data-spec-section='specs/spec.yaml']").waitFor({ state: "hidden" });
  await page.locator("a[data-goto='']").first().click();
  await page.locator("[data-spec-section='specs/spec.yaml']").waitFor({ state: "visible" });

  // On a phone.
  await page.setViewportSize({ width: 390, height: 800 });
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  assert(width <= 390, `a phone scrolls sideways: ${width}`);
  const others = asked.filter((url) => !url.startsWith(address) && !url.startsWith("data:") && !url.startsWith("blob:"));
  assert.deepEqual(others, [], "nobody else is asked");
  const unexpected = wrong.filter((text) => !text.includes("422"));
  assert.deepEqual(unexpected, [], "nothing goes wrong on the page");
}

async function report(path) {
  const { context, page, wrong, asked } = await open();
  await context.setOffline(true);
  await page.goto(`file://${path}`);
  await page.waitForSelector("canvas[data-triangles]:not([hidden])", { timeout: 20000 });
  assert((await drawn(page)).count > 1000, "solids are drawn");
  const picture = await page.locator("img[data-viewer=svg]").evaluate((image) => image.decode().then(() => image.naturalWidth));
  assert(picture > 0);
  assert.equal(await page.locator("input[data-param]").count(), 0, "nobody listens to a control");
  assert.deepEqual(asked.filter((url) => !url.startsWith("file:") && !url.startsWith("data:") && !url.startsWith("blob:")), []);
  assert.deepEqual(wrong, []);
  const silent = await open({ javaScriptEnabled: false });
  await silent.page.goto(`file://${path}`);
  const still = silent.page.locator("img.still");
  assert(await still.isVisible(), "solids have a picture where no script runs");
  assert(await silent.page.locator("[data-artifact='spec/block.stl']").isVisible());
}

// How long it takes until a page has all pictures that are to be seen, in milliseconds.
async function measure(address) {
  const { page } = await open();
  const begun = performance.now();
  await page.goto(address);
  await page.waitForFunction(() => [...document.images].filter((i) => i.clientHeight && i.getBoundingClientRect().top < innerHeight).every((i) => i.complete));
  await page.waitForFunction(() => [...document.querySelectorAll("canvas")].filter((c) => c.clientHeight && c.getBoundingClientRect().top < innerHeight).every((c) => c.dataset.triangles));
  console.log(Math.round(performance.now() - begun));
}

try {
  await { live, report, measure }[part](...rest);
} catch (error) {
  console.error(error);
  process.exitCode = 1;
}
await browser.close();
