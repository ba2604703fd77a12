// Takes the picture of a report for the documents: node test/picture.mjs REPORT.html PICTURE.png
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { launch } from "./browser.mjs";

const [report, picture] = process.argv.slice(2);
const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1280, height: 1080 } });
await page.goto(pathToFileURL(resolve(report)).href);
await page.waitForFunction(() => window.nonobtuseReport);
await page.waitForTimeout(1000);
// Without the header: its seconds are of the machine that drew the pictures.
const { y } = await page.locator("#views").boundingBox();
await page.screenshot({ path: picture, clip: { x: 0, y: y - 8, width: 1280, height: 1000 - y } });
await browser.close();
console.log(picture);
