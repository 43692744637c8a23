import { resolve } from 'node:path';
import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig } from 'vite';

// The demonstration: one classic script with the engine in it, because a page that is opened from a folder can neither load
// modules nor fetch files. The program tools/demo.sh sets FABA_ENGINE, the file of the engine.
export default defineConfig({
  plugins: [svelte()],
  base: './',
  publicDir: 'demo',
  resolve: { alias: { 'faba-engine': resolve(process.env.FABA_ENGINE ?? '../build/engine-wasm/faba_demo.js') } },
  worker: { format: 'iife' },
  build: {
    target: 'es2022',
    modulePreload: false,
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 8192, // kB
    rollupOptions: {
      input: 'src/demo/main.ts',
      output: { format: 'iife', inlineDynamicImports: true, entryFileNames: 'demo.js', assetFileNames: 'demo.[ext]' },
    },
  },
});
