// A report as a part of the page. The program writes reports, but a file can be replaced: nothing of a parsed report is
// inserted. Reports are well-formed XML and are parsed as XML, in which no element has a meaning. From the parsed tree a new
// one is built with allowed elements, attributes and addresses; all else is dropped with its content. The content security
// policy of the page, which forbids inline scripts, inline styles and other origins, is a second barrier.

import { translated, type Translate } from './translate';

/** What is read of a parsed document. */
export interface Source {
  nodeType: number;
  localName?: string;
  nodeValue?: string | null;
  attributes?: ArrayLike<{ name: string; value: string }>;
  childNodes: ArrayLike<Source>;
}
export interface Clean {
  tag: string;
  svg: boolean;
  attributes: [string, string][];
  children: (Clean | string)[];
}

const kSvg = 'http://www.w3.org/2000/svg';
const words = (text: string) => new Set(text.split(' '));
const kHtmlTags = words('h1 h2 h3 h4 p div section span small b strong i em sub sup br code pre table caption thead tbody tfoot tr th td figure figcaption dl dt dd ul ol li details summary img video a');
const kSvgTags = words('svg g path rect circle ellipse line polygon polyline text tspan title desc');
const kHtmlAttributes = words('title scope colspan rowspan alt width height role aria-label open controls');
const kSvgAttributes = words(
  'viewBox width height x y x1 y1 x2 y2 cx cy r rx ry d points transform fill fill-opacity stroke stroke-width stroke-opacity stroke-dasharray stroke-linecap stroke-linejoin opacity paint-order text-anchor font-family font-size font-weight role aria-label data-x data-y data-lo data-hi data-at data-of data-log data-right data-equal data-kind data-layer data-legend data-axis data-ticks',
);
const kClasses = words('faba-plot lead details note warning cards figures frames wide video numbers facts');
const isClass = (name: string) => kClasses.has(name) || /^[sf]-[a-z]+$/.test(name);
// The page has the first heading.
const kTagInPage: Record<string, string> = { h1: 'h2', h2: 'h3', h3: 'h4' };

const kPicture = /^data:image\/(png|jpeg);base64,[A-Za-z0-9+/=\s]*$/;
const kFileBeside = /^[\w%~+=,-][\w.%~+=, -]*(\/[\w%~+=,-][\w.%~+=, -]*)*$/;

/** The address of a file in the folder of the report, or below it; null for other addresses. */
export function addressBeside(folder: string, name: string): string | null {
  return kFileBeside.test(name) && !/%(2f|5c|2e|00)/i.test(name) ? `/${folder}/${name}` : null;
}

function allowedAttribute(tag: string, svg: boolean, name: string, value: string, folder: string): [string, string] | null {
  if (name === 'class') {
    const classes = value.split(/\s+/).filter(isClass).join(' ');
    return classes ? ['class', classes] : null;
  }
  if (svg) return kSvgAttributes.has(name) && !/url\s*\(|[\\:]/i.test(name === 'aria-label' ? '' : value) ? [name, value] : null;
  if (kHtmlAttributes.has(name)) return [name, value];
  const isAddress = (tag === 'img' && name === 'src') || (tag === 'video' && (name === 'src' || name === 'poster')) || (tag === 'a' && name === 'href');
  if (!isAddress) return null;
  if (tag !== 'a' && name !== 'href' && kPicture.test(value)) return [name, value];
  const address = addressBeside(folder, value);
  return address === null ? null : [name, address];
}

/** The allowed content of a node. `folder`: that of the report, "runs/study"; `inDrawing`: the node is in an <svg>. */
export function sanitised(node: Source, folder: string, inDrawing = false): (Clean | string)[] {
  const out: (Clean | string)[] = [];
  for (const child of Array.from(node.childNodes)) {
    if (child.nodeType === 3) out.push(child.nodeValue ?? '');
    if (child.nodeType !== 1) continue;
    const tag = child.localName ?? '', svg = inDrawing || tag === 'svg';
    // The content of a page is in these.
    if (!svg && /^(html|body|main)$/.test(tag)) out.push(...sanitised(child, folder));
    if (!(svg ? kSvgTags : kHtmlTags).has(tag)) continue;
    const attributes = Array.from(child.attributes ?? [])
      .map((a) => allowedAttribute(tag, svg, a.name, a.value, folder))
      .filter((a) => a !== null);
    out.push({ tag: svg ? tag : (kTagInPage[tag] ?? tag), svg, attributes, children: sanitised(child, folder, svg) });
  }
  return out;
}

/** The elements of sanitised content. */
export function built(content: (Clean | string)[], document: Document): DocumentFragment {
  const fragment = document.createDocumentFragment();
  for (const one of content) {
    if (typeof one === 'string') {
      fragment.append(one);
      continue;
    }
    const element = one.svg ? document.createElementNS(kSvg, one.tag) : document.createElement(one.tag);
    for (const [name, value] of one.attributes) element.setAttribute(name, value);
    element.append(built(one.children, document));
    fragment.append(element);
  }
  return fragment;
}

/** A report as elements of the page, with its texts translated; null if it is not well-formed XML. */
export function reportElements(xml: string, folder: string, translate: Translate): DocumentFragment | null {
  const parsed = new DOMParser().parseFromString(xml, 'application/xml');
  return parsed.querySelector('parsererror') ? null : built(translated(sanitised(parsed as unknown as Source, folder), translate), document);
}
