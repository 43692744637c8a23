import { mount } from 'svelte';
import type { Language } from '../i18n';
import { loadTexts } from '../i18n/program/catalogue';
import { remembered } from '../settings';
import '../style.css';
import Demo from './Demo.svelte';

const language = remembered<Language>('language', navigator.language.startsWith('pt') ? 'pt' : 'en');
void loadTexts(language).then(() => mount(Demo, { target: document.getElementById('app')!, props: { chosen: language } }));
