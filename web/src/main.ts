import { mount } from 'svelte';
import App from './App.svelte';
import type { Language } from './i18n';
import { loadTexts } from './i18n/program/catalogue';
import { remembered } from './settings';
import './style.css';

const language = remembered<Language>('language', navigator.language.startsWith('pt') ? 'pt' : 'en');
// Without its texts the page speaks English.
void loadTexts(language)
  .catch(() => undefined)
  .then(() => mount(App, { target: document.getElementById('app')!, props: { chosen: language } }));
