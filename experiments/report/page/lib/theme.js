// Light, dark, or as the system says; and the colour map of all value maps on the page.
const query = matchMedia('(prefers-color-scheme: dark)');
const state = { theme: 'auto', palette: 'viridis', printing: false };
const listeners = new Set();

// Storage may be forbidden for files from disk; the page then just forgets.
function recall(key) { try { return localStorage.getItem(`mezzotint-${key}`); } catch { return null; } }
function remember(key, value) { try { localStorage.setItem(`mezzotint-${key}`, value); } catch { /* forgets */ } }

const resolved = () => (state.printing ? 'light' : state.theme === 'auto' ? (query.matches ? 'dark' : 'light') : state.theme);

function apply() {
  document.documentElement.dataset.theme = resolved();
  for (const listener of listeners) listener();
}

export function startTheme() {
  state.theme = recall('theme') ?? 'auto';
  state.palette = recall('palette') ?? 'viridis';
  query.addEventListener('change', apply);
  for (const [event, printing] of [['beforeprint', true], ['afterprint', false]]) {
    window.addEventListener(event, () => { state.printing = printing; apply(); });
  }
  apply();
}

export const theme = () => state.theme;
/// Paper cannot wait: what takes time to draw again stays as it is, and the print style turns it over.
export const printing = () => state.printing;
export const isDark = () => document.documentElement.dataset.theme === 'dark';
export const palette = () => state.palette;
export function setTheme(value) { state.theme = value; remember('theme', value); apply(); }
export function setPalette(value) { state.palette = value; remember('palette', value); apply(); }

/// Calls back at every change of theme or colour map.
export function onThemeChange(listener) { listeners.add(listener); }

/// A colour (or any custom property) of the style sheet, as it is now.
export const token = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
