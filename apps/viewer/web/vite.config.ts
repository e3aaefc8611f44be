// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vite";

export default defineConfig({
  // Names without a hash: the server embeds a fixed list of files, and sends them with "no-store".
  build: {
    target: "es2022",
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1000,
    rollupOptions: {
      output: {
        entryFileNames: "assets/[name].js",
        chunkFileNames: "assets/[name].js",
        assetFileNames: "assets/[name][extname]",
      },
    },
  },
  // `npx vite` for work on the page: the API comes from the mock, or from a real `kontur open --port 8420`.
  server: { proxy: { "/api": { target: "http://127.0.0.1:8420", ws: true } } },
});
