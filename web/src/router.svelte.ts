// The address of the page: every view has one, so that Back works and addresses can be shared. "#/runs/steer?at=3" is the page
// `runs`, its parts ["steer"], and the values { at: "3" }. The part behind # is not sent to the server, so that any address
// loads the page.

/** The pages of the navigation bar. */
export const kTabs = ['lab', 'gallery', 'experiments', 'runs', 'analyse', 'jobs', 'bench'] as const;
export const kPages = [...kTabs, 'coils', 'optics', 'own', 'result', 'tracks', 'video'] as const;
export type PageName = (typeof kPages)[number];

export interface Place {
  page: PageName;
  /** Names below the page, such as that of an experiment; decoded. */
  parts: string[];
  values: Record<string, string>;
}

/** The place that an address names; an address without a known page names the lab. */
export function parsePlace(hash: string): Place {
  const [path, query = ''] = hash.replace(/^#\/?/, '').split('?', 2);
  const [first, ...parts] = path.split('/').filter(Boolean).map(decoded);
  const page = kPages.find((p) => p === first);
  return { page: page ?? 'lab', parts: page ? parts : [], values: Object.fromEntries(new URLSearchParams(query)) };
}

/** The address of a place, "#/runs/steer". */
export function addressOf(page: PageName, parts: string[] = [], values: Record<string, string> = {}): string {
  const query = new URLSearchParams(values).toString();
  return `#/${[page, ...parts].map(encodeURIComponent).join('/')}${query ? `?${query}` : ''}`;
}

function decoded(part: string): string {
  try {
    return decodeURIComponent(part);
  } catch {
    return part; // typed by hand
  }
}

export class Router {
  place = $state.raw<Place>(parsePlace(location.hash));

  constructor() {
    addEventListener('hashchange', () => {
      this.place = parsePlace(location.hash);
      scrollTo(0, 0);
    });
  }
  /** Goes to a place; `replace`: without an entry in the history. */
  go(page: PageName, parts: string[] = [], values: Record<string, string> = {}, replace = false) {
    const address = addressOf(page, parts, values);
    if (address === location.hash) return;
    if (replace) {
      history.replaceState(null, '', address);
      this.place = parsePlace(address);
    } else {
      location.hash = address;
    }
  }
}
