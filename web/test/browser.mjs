// Chromium, as the tests and pictures of this folder want it. CHROMIUM says where it is.
import { existsSync } from "node:fs";
import { chromium } from "playwright-core";

export function launch() {
  return chromium.launch({
    executablePath:
      process.env.CHROMIUM ??
      ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync),
    // Drawn by the processor: there may be no graphics card, or not the same one.
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
}
