// Opens reports in a browser as a reader would: node test/report.test.mjs REPORT.html...
// No error on the console and no request, both canvases drawn, colours and turning change both, a
// click on a place moves the camera there. SCREENSHOTS, a folder, keeps pictures.
import assert from "node:assert/strict";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { launch } from "./browser.mjs";

const screenshots = process.env.SCREENSHOTS;

/** Of each canvas: how many colours it shows, and a hash of its pixels. */
async function pixels(page) {
  // Two frames, so that what was asked for is drawn.
  await page.evaluate(() => new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r))));
  return page.evaluate(() =>
    ["before", "after"].map((id) => {
      const source = document.getElementById(id);
      const copy = document.createElement("canvas");
      copy.width = 160;
      copy.height = 120;
      const context = copy.getContext("2d");
      context.drawImage(source, 0, 0, 160, 120);
      const data = context.getImageData(0, 0, 160, 120).data;
      const colors = new Set();
      let hash = 0;
      for (let i = 0; i < data.length; i += 4) {
        const color = (data[i] << 16) | (data[i + 1] << 8) | data[i + 2];
        colors.add(color);
        hash = (Math.imul(hash, 31) + color) | 0;
      }
      return { colors: colors.size, hash };
    }),
  );
}

const camera = (page) => page.evaluate(() => window.nonobtuseReport.camera());

/** Where the camera is once it stands still. */
async function settled(page) {
  await page.waitForFunction(() => !window.nonobtuseReport.flying(), null, { timeout: 60000 });
  return camera(page);
}

async function look(browser, file) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 } });
  const errors = [];
  page.on("console", (m) => m.type() === "error" && errors.push(m.text()));
  page.on("pageerror", (e) => errors.push(String(e)));
  page.on("request", (r) => /^(file|data|blob):/.test(r.url()) || errors.push(`asks for ${r.url()}`));
  await page.goto(pathToFileURL(resolve(file)).href);
  await page.waitForFunction(() => window.nonobtuseReport, null, { timeout: 60000 });
  const shot = async (name) => {
    if (screenshots)
      await page.screenshot({ path: join(screenshots, `${basename(file, ".html")}-${name}.png`), fullPage: name === "page" });
  };

  const first = await pixels(page);
  for (const { colors } of first) assert.ok(colors > 20, `a canvas shows ${colors} colours`);
  await shot("page");
  for (const section of ["figures", "histograms", "convergence", "certificate", "options"])
    assert.ok((await page.locator(`#${section} > div > *`).count()) > 0, `#${section} is empty`);

  for (const mode of await page.locator("#modes input").all()) {
    await mode.check();
    for (const { colors } of await pixels(page)) assert.ok(colors > 20);
    await shot(await mode.inputValue());
  }
  await page.locator("#modes input").first().check();
  assert.deepEqual(await pixels(page), first, "the same mode gives the same picture");

  // A drag in one view turns both.
  const box = await page.locator("#before").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 120, box.y + box.height / 2 + 30, { steps: 6 });
  await page.mouse.up();
  const turned = await pixels(page);
  assert.notEqual(turned[0].hash, first[0].hash);
  assert.notEqual(turned[1].hash, first[1].hash);

  // A click on a place flies there: near to it, and the target is in the middle of both views.
  const before = await settled(page);
  const places = page.locator("#places button");
  assert.ok((await places.count()) > 0, "no places are listed");
  for (const place of [places.first(), places.last()]) {
    await place.click();
    const after = await settled(page);
    const moved = Math.hypot(...[0, 1, 2].map((k) => after[k] - before[k]));
    const distance = (c) => Math.hypot(...[0, 1, 2].map((k) => c[k] - c[k + 3]));
    assert.ok(moved > 0.1 * distance(before), "the camera has not moved");
    assert.ok(distance(after) < distance(before), "the camera is no nearer");
    assert.equal(await page.locator(".ring:visible").count(), 2);
    for (const { colors } of await pixels(page)) assert.ok(colors > 5);
  }
  await shot("place");

  // A click on the surface names a triangle.
  await page.locator("#before").click();
  await page.waitForFunction(() => /triangle \d+/.test(document.getElementById("picked").textContent));
  await page.locator("#reset").click();
  await settled(page);
  assert.deepEqual(errors, []);

  // And on a small screen.
  await page.setViewportSize({ width: 390, height: 800 });
  for (const { colors } of await pixels(page)) assert.ok(colors > 20);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(overflow <= 1, `the page is ${overflow} pixels too wide on a small screen`);
  await shot("small");
  await page.close();
}

const browser = await launch();
try {
  for (const file of process.argv.slice(2)) {
    await look(browser, file);
    console.log(`${file}: fine`);
  }
} finally {
  await browser.close();
}
