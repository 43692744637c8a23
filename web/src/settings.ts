// What this browser keeps of the user's wishes.

export function remembered<T>(key: string, fallback: T): T {
  try {
    const text = localStorage.getItem(`faba.${key}`);
    return text === null ? fallback : (JSON.parse(text) as T);
  } catch {
    return fallback; // storage is switched off, or holds something else
  }
}
export function remember(key: string, value: unknown) {
  try {
    localStorage.setItem(`faba.${key}`, JSON.stringify(value));
  } catch {
    // then it is asked again next time
  }
}
