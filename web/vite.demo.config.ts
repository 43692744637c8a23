import { readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { gzipSync } from 'node:zlib';
import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig, type Plugin } from 'vite';

const kEngine = resolve('../build/engine-wasm/faba_demo'); // .js and .wasm, by tools/demo.sh

/** Imports the WebAssembly as text: compressed, then in base64. */
const compressed: Plugin = {
  name: 'faba-engine-wasm',
  enforce: 'pre',
  load: (id) => (id === `${kEngine}.wasm` ? `export default "${gzipSync(readFileSync(id), { level: 9 }).toString('base64')}"` : null),
};

// The demonstration: one classic script with the engine in it, because a page that is opened from a folder can neither load
// modules nor fetch files.
export default defineConfig({
  plugins: [svelte()],
  base: './',
  publicDir: 'demo',
  resolve: { alias: [{ find: /^faba-engine\.wasm$/, replacement: `${kEngine}.wasm` }, { find: /^faba-engine$/, replacement: `${kEngine}.js` }] },
  worker: { format: 'iife', plugins: () => [compressed] },
  build: {
    target: 'es2022',
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 8192, // kB
    rollupOptions: {
      input: 'src/demo/main.ts',
      output: { format: 'iife', inlineDynamicImports: true, entryFileNames: 'demo.js', assetFileNames: 'demo.[ext]' },
    },
  },
});
