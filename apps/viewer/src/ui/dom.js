// Creates DOM elements. Text is never parsed as markup, because names of parts come from untrusted files.

/** element('button.primary', {title: 'Play', onclick: f}, child, 'text', null) */
export function element(kind, properties = {}, ...children) {
  const [tag, ...classes] = kind.split('.');
  const node = document.createElement(tag);
  if (classes.length > 0) node.className = classes.join(' ');
  for (const [key, value] of Object.entries(properties)) {
    if (key.startsWith('on')) node.addEventListener(key.slice(2), value);
    else if (key.startsWith('aria-') || key.startsWith('data-') || key === 'role' || key === 'for') node.setAttribute(key, value);
    else if (key === 'style') for (const [name, text] of Object.entries(value)) node.style.setProperty(name, text);
    else node[key] = value;
  }
  node.append(...children.flat(Infinity).filter(c => c !== null && c !== undefined && c !== false));
  return node;
}

const PATHS = {
  play: 'M8 5.5v13l10.5-6.5z!', pause: 'M7 5h3.6v14H7zM13.4 5H17v14h-3.6z!',
  first: 'M7 6v12M18 6.5 10 12l8 5.5z', previous: 'M14.5 6 8.5 12l6 6', next: 'M9.5 6l6 6-6 6',
  fit: 'M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5', colours: 'M12 3a9 9 0 1 0 0 18c1.7 0 2-1.2 1.4-2.2-.7-1.2 0-2.6 1.5-2.6H17a4 4 0 0 0 4-4C21 7 17 3 12 3zM7.5 11.5h.01M10.5 7.5h.01M15 7.5h.01',
  follow: 'M4 8V4h4M16 4h4v4M20 16v4h-4M8 20H4v-4M12 9a3 3 0 1 0 0 6 3 3 0 0 0 0-6z', print: 'M7 9V4h10v5M7 17H4v-7h16v7h-3M7 14h10v6H7z', link: 'M10 14a4 4 0 0 0 5.7.3l3-3a4 4 0 0 0-5.700-5.700l-1 1M14 10a4 4 0 0 0-5.700-.3l-3 3a4 4 0 0 0 5.700 5.700l1-1',
  trails: 'M4 19c6 0 3-12 9-12M10.5 4.5 14 7l-3.5 2.5M19 18.5h.01M18 7h.01', fade: 'M5 12a7 7 0 0 1 7-7M12 19a7 7 0 0 0 7-7M12 5h.01M16.5 6.6h.01M19 11h.01M7.4 17.2h.01M5.2 14h.01',
  up: 'M12 20V5M7 9.5 12 4.5l5 5M5 20h14', theme: 'M20 14.5A8.5 8.5 0 0 1 9.5 4a8.5 8.5 0 1 0 10.5 10.5z',
  help: 'M9.2 9.2a2.9 2.9 0 1 1 4.2 2.6c-1 .5-1.4 1.1-1.4 2.2M12 17.5h.01', eye: 'M2.5 12S6 5.8 12 5.8 21.5 12 21.5 12 18 18.2 12 18.2 2.5 12 2.5 12zM12 9.4a2.6 2.6 0 1 0 0 5.2 2.6 2.6 0 0 0 0-5.2z',
  eyeoff: 'M4 4l16 16M9.9 6.1A9.6 9.6 0 0 1 12 5.8c6 0 9.5 6.2 9.5 6.2a16 16 0 0 1-2.8 3.4M6.2 8A15.500 15.500 0 0 0 2.500 12s3.500 6.200 9.500 6.200a9 9 0 0 0 3.500-.7',
  isolate: 'M12 8.500a3.500 3.500 0 1 0 0 7 3.500 3.500 0 0 0 0-7zM12 2.500v3M12 18.500v3M2.500 12h3M18.500 12h3', ghost: 'M4.500 8 12 4l7.500 4v8L12 20l-7.500-4zM12 12l7.500-4M12 12v8M12 12 4.500 8',
  close: 'M6 6l12 12M18 6 6 18', check: 'M5 12.500l4.500 4.500L19 7.500', warning: 'M12 8.500v4.500M12 16.500h.01M12 3.500 2.500 20h19z', ground: 'M3 16l9-4.500L21 16l-9 4.500zM12 11.500V3.500', explode: 'M12 9.500v5M9.500 12h5M12 6V2.500M12 21.500V18M6 12H2.500M21.500 12H18M10.500 4 12 2.500 13.500 4M10.500 20l1.500 1.500 1.500-1.500M4 10.500 2.500 12 4 13.500M20 10.500l1.500 1.500-1.500 1.500',
  note: 'M5 4h14v11l-5 5H5zM14 20v-5h5M8.500 8.500h7M8.500 12h4', measure: 'M3.500 15.500 15.500 3.500l5 5-12 12zM7 12l2 2M10 9l2.500 2.500M13 6l2 2', section: 'M4 20V8l8-4 8 4v12zM12 4v16M14.500 9.500h3M14.500 13h3M14.500 16.500h3',
  tool: 'M14.500 6.500a4 4 0 0 1 5-2l-2.500 2.500.5 2 2 .5 2-2.500a4 4 0 0 1-5 5L8.500 20a2 2 0 0 1-3-3z',
  reset: 'M4.500 12a7.500 7.500 0 1 0 2.400-5.500M4.500 4v4h4',
};

export function icon(name) {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path'), filled = PATHS[name].endsWith('!');
  path.setAttribute('d', PATHS[name].replace('!', ''));
  path.setAttribute('class', filled ? 'filled' : 'line');
  svg.append(path);
  return svg;
}

/** A button with an icon; `title` describes its function, also for screen readers. */
export function iconButton(name, title, onclick, kind = 'button.icon') {
  return element(kind, {type: 'button', title, 'aria-label': title.replace(/ \(.*\)$/, ''), onclick}, icon(name));
}

export const swatch = colour => element('span.swatch', {style: {'--colour': colour}});
