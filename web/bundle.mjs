// Makes one file of what Vite built: report.html, the template of every report. The tool and the
// Python package put a report's JSON where it says @REPORT@. With --check, only compares it with
// the report.html that is there.
import { readFileSync, writeFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const folder = dirname(fileURLToPath(import.meta.url));
const built = join(folder, "..", "build", "web");
const assets = join(built, "assets");
const asset = (suffix) =>
  readFileSync(join(assets, readdirSync(assets).find((name) => name.endsWith(suffix))), "utf8");

const script = asset(".js").replaceAll("</script", "<\\/script").trim();
const style = asset(".css").trim();
const licence = readFileSync(join(folder, "node_modules/three/LICENSE"), "utf8").trim();
let html = readFileSync(join(built, "index.html"), "utf8");
html = html.replace(/\s*<script type="module"[^>]*><\/script>/, "");
html = html.replace(/\s*<link rel="stylesheet"[^>]*>/, () => `\n<style>${style}</style>`);
html = html.replace(
  "</body>",
  () => `<script type="module">\n/* Holds three.js.\n${licence}\n*/\n${script}\n</script>\n</body>`,
);

// Any reader of bytes can handle it, and the mark is there once.
html = html.replace(/[^\x00-\x7f]/g, (c) => (c === "\u00a9" ? "(c)" : `\\u${c.charCodeAt(0).toString(16).padStart(4, "0")}`));
if (html.split("@REPORT@").length !== 2) throw new Error("@REPORT@ must be in the page exactly once");

const target = join(folder, "report.html");
if (process.argv.includes("--check")) {
  if (readFileSync(target, "utf8") !== html) {
    console.error("web/report.html is not what its sources give: run 'npm run build' in web/.");
    process.exit(1);
  }
  console.log("web/report.html is what its sources give.");
} else {
  writeFileSync(target, html);
  console.log(`report.html: ${html.length} bytes`);
}
