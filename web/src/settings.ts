// User settings stored in the browser.

export function remembered<T>(key: string, fallback: T): T {
  try {
    const text = localStorage.getItem(`faba.${key}`);
    return text === null ? fallback : (JSON.parse(text) as T);
  } catch {
    return fallback; // storage is disabled, or has invalid data
  }
}
export function remember(key: string, value: unknown) {
  try {
    localStorage.setItem(`faba.${key}`, JSON.stringify(value));
  } catch {
    // storage is disabled: the setting is lost
  }
}
