import { defineConfig } from 'vite';
import { svelte } from '@sveltejs/vite-plugin-svelte';

// Names without hashes: the program embeds these files, and the same sources give the same bytes. The pages that are not shown at
// first are loaded when they are opened.
export default defineConfig({
  plugins: [svelte()],
  base: './',
  build: {
    target: 'es2022',
    outDir: 'dist',
    modulePreload: false,
    assetsInlineLimit: 0,
    rollupOptions: { output: { entryFileNames: 'app.js', chunkFileNames: '[name].js', assetFileNames: ({ names }) => (names.includes('index.css') || names.includes('style.css') ? 'app.css' : '[name].[ext]') } },
  },
});
