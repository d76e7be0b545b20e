// Headless Chromium that draws WebGL in software, driven by playwright-core from $VIEWER_MODULES.
import {existsSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';

export const CHROMIUM = process.env.CHROMIUM ?? '/usr/bin/chromium';
export const hasChromium = () => existsSync(CHROMIUM);

const FLAGS = ['--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync'];
const SOFTWARE = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

export async function launch({webgl = true} = {}) {
  const {chromium} = createRequire(join(process.env.VIEWER_MODULES, 'package.json'))('playwright-core');
  return chromium.launch({executablePath: CHROMIUM, headless: true,
    args: [...FLAGS, ...webgl ? SOFTWARE : ['--disable-3d-apis']]});
}

/** Opens a page from the disk and waits for its first picture. `complaints` collects errors and warnings of the console. */
export async function open(browser, file, options = {}) {
  // A quarter of the pixels: they are drawn in software.
  const page = await browser.newPage({viewport: {width: 1280, height: 800}, deviceScaleFactor: 0.5, ...options});
  page.setDefaultTimeout(120_000);  // software rendering on a busy machine is slow
  page.complaints = [];
  page.requests = [];
  page.on('console', message => {
    // The driver of the software renderer warns about a stall at every screenshot.
    if (['error', 'warning'].includes(message.type()) && !message.text().includes('GL Driver Message')) page.complaints.push(message.text());
  });
  page.on('pageerror', error => page.complaints.push(`${error.message}\n${error.stack}`));
  page.on('request', request => page.requests.push(request.url()));
  page.on('dialog', dialog => { page.complaints.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  await page.goto(`file://${file}`);
  await page.waitForFunction(() => window.dismantle === undefined ? document.querySelector('.failure') : window.dismantle.drawn);
  return page;
}
