// The page of `dismantle serve` in a real browser, as its user has it: drop a file, plan, mark, drag, undo, restart.
// Status 77 (skipped) when there is no browser, or the program was built without the server.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import nodeTest, {after, before} from 'node:test';
import {CHROMIUM, hasChromium, launch} from './chromium.mjs';
import {box, run} from './plans.mjs';

const root = mkdtempSync(join(tmpdir(), 'dismantle-serve-')), folder = join(root, 'products');
if (!hasChromium() || !run(root, [0], '--help').includes(' serve ')) {
  console.log(`skipped: there is no ${CHROMIUM} (Debian: apt-get install chromium), or no 'dismantle serve'`);
  rmSync(root, {recursive: true});
  process.exit(77);
}

let browser, server, page, complaints;

/** A server for the folder, and its page. */
async function start() {
  server = spawn(process.env.DISMANTLE, ['serve', folder, '--no-browser'], {stdio: ['ignore', 'pipe', 'inherit']});
  const address = await new Promise(done => {
    let said = '';
    server.stdout.on('data', bytes => { const found = /http:\S+/.exec(said += bytes); if (found) done(found[0]); });
  });
  page = await browser.newPage({viewport: {width: 1500, height: 900}});
  page.setDefaultTimeout(200_000);
  complaints = [];
  page.on('console', message => { if (message.type() === 'error') complaints.push(message.text()); });
  page.on('pageerror', error => complaints.push(error.message));
  await page.goto(address);
  await page.waitForSelector('#folder:not(:empty)');
}

async function stop() {
  await page.close();
  server.kill('SIGINT');
  assert.equal(await new Promise(done => server.on('exit', done)), 0);
}

before(async () => {
  mkdirSync(folder);
  mkdirSync(join(folder, 'blocks'));
  for (const k of [0, 1, 2]) writeFileSync(join(folder, 'blocks', `block_${k}.obj`), box([3 * k, 0, 1], [3 * k + 2, 2, 3]));
  writeFileSync(join(folder, 'blocks', 'plate.obj'), box([0, 0, 0], [8, 2, 1]));
  browser = await launch();
  await start();
});
after(async () => {
  await browser?.close();
  server?.kill('SIGKILL');
  rmSync(root, {recursive: true});
});

const test = (title, body) => nodeTest(title, {timeout: 400_000}, body);
const message = () => page.textContent('#message');
const says = what => page.waitForFunction(text => document.querySelector('#message').textContent.includes(text), what);
const steps = () => page.$$eval('#steps li > span', spans => spans.map(s => s.textContent.replace(/^\d+\. /, '')));
const settled = order => page.waitForFunction(
  wanted => JSON.stringify([...document.querySelectorAll('#steps li > span')].map(s => s.textContent.replace(/^\d+\. /, ''))) === wanted, JSON.stringify(order));

const dragStep = (from, to) => page.locator('#steps li').nth(from).dragTo(page.locator('#steps li').nth(to));

test('a dropped file is added, one of a name that is taken is not', async () => {
  const drop = async (name, text) => page.dispatchEvent('#drop', 'drop', {dataTransfer: await page.evaluateHandle(([n, t]) => {
    const data = new DataTransfer();
    data.items.add(new File([t], n));
    return data;
  }, [name, text])});
  await drop('pair.obj', `o a\n${box([0, 0, 0], [1, 1, 1])}o b\n${box([0, 0, 2], [1, 1, 3]).replace(/^f .*$/gm, line => line.replace(/\d+/g, n => Number(n) + 8))}`);
  await page.waitForFunction(() => document.querySelector('#name').textContent === 'pair.obj');
  await drop('pair.obj', 'other');
  await page.waitForFunction(() => document.querySelector('#note').textContent.includes('already'));
  assert.equal(readFileSync(join(folder, 'pair.obj'), 'utf8').startsWith('o a'), true);
  complaints = [];  // the browser reports the refusal, too
});

test('a product is planned, its steps and its page are shown', async () => {
  await page.click('#products button:has-text("blocks")');
  await page.waitForFunction(() => document.querySelector('#name').textContent === 'blocks');
  await page.click('#plan');
  await says('Planned in');
  assert.equal((await steps()).length, 3);
  const shows = step => page.waitForFunction(s => document.querySelector('#page').src.endsWith(`#step=${s}&mode=assembly`), step);
  await shows(1);  // with the numbers of the list
  await page.locator('#steps li > span').nth(2).click();
  await shows(3);
});

test('a click on a part in the picture finds it in the list', async () => {
  const area = await (await page.$('#page')).boundingBox();
  await page.waitForTimeout(2000);
  let picked = [];
  for (let x = 0.25; x < 0.55 && picked.length === 0; x += 0.05)
    for (let y = 0.35; y < 0.65 && picked.length === 0; y += 0.05) {
      await page.mouse.click(area.x + area.width * x, area.y + area.height * y);
      await page.waitForTimeout(300);
      picked = await page.$$eval('#parts li.picked span', spans => spans.map(s => s.textContent));
    }
  assert.equal(picked.length, 1);
  assert.match(picked[0], /^(block_\d|plate)$/);
});

test('a dragged step is verified in its place, and undone', async () => {
  const order = await steps();
  await dragStep(2, 0);
  await says('Verified in');
  assert.deepEqual(await steps(), [order[2], order[0], order[1]]);
  assert.match(await message(), /it costs .* \(before: /);
  await page.click('#undo');
  await settled(order);
});

test('marks are planned, and all of it is there after a restart', async () => {
  const mark = (part, role) => page.selectOption(`#parts select[data-part="${part}"]`, role);
  await mark('plate', 'base');
  await mark('block_2', 'with block_1');
  await page.click('#mark');
  await page.waitForFunction(() => document.querySelectorAll('#steps li').length === 2 && document.querySelector('#message').textContent.startsWith('Planned'));
  assert.ok((await steps()).includes('block_1, block_2'));
  assert.deepEqual(complaints, []);
  await stop();
  await start();
  await page.click('#products button:has-text("blocks")');
  await page.waitForFunction(() => document.querySelectorAll('#parts select').length === 4);
  assert.equal((await steps()).length, 2);
  assert.equal(await page.$eval('#parts select[data-part="plate"]', s => s.value), 'base');
  await page.click('#undo');
  await page.waitForFunction(() => document.querySelectorAll('#steps li').length === 3);
  assert.deepEqual(complaints, []);
  await stop();
});
