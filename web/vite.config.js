// Built beside the sources' other products, below build/; bundle.mjs makes one file of it.
import { defineConfig } from "vite";

export default defineConfig({
  base: "./",
  logLevel: "warn",
  build: {
    outDir: "../build/web",
    emptyOutDir: true,
    target: "es2022",
    modulePreload: false,
    assetsInlineLimit: 1_000_000,
    chunkSizeWarningLimit: 1000,
  },
  esbuild: { charset: "ascii", legalComments: "none" },
});
