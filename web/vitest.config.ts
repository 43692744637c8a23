import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig } from 'vitest/config';

// Unit tests of what needs no browser; tests/e2e/lab_test.mjs tests the page in one.
export default defineConfig({
  plugins: [svelte()],
  test: { include: ['tests/**/*.test.ts'], unstubGlobals: true },
});
