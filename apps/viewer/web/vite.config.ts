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
  // For work on the page: `kontur open --no-browser --port 8420 --token dev`, `npx vite`, http://127.0.0.1:5173/#dev
  server: {
    proxy: { "/api": { target: "http://127.0.0.1:8420", ws: true, changeOrigin: true, headers: { origin: "http://127.0.0.1:8420" } } },
  },
});
