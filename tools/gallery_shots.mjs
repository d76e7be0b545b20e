// node gallery_shots.mjs SHOTS.json: pictures of pages in headless Chromium, for tools/make_gallery.py. $VIEWER_MODULES: the folder with
// node_modules that the build of the viewer makes. A shot: {page, out, up, explode, step, share, mode, problem, section, whole, size}.
import {readFileSync} from 'node:fs';
import {launch} from '../apps/viewer/test/browser/chromium.mjs';

const shots = JSON.parse(readFileSync(process.argv[2], 'utf8')), browser = await launch();
const LOOSE = 'body * { visibility: hidden } .view, .view canvas { visibility: visible !important }';

/** A page of instructions. */
async function book(page, shot) {
  await page.goto(`file://${shot.page}`);
  await page.locator('section').nth(shot.section).screenshot({path: shot.out, type: 'jpeg', quality: 84});
}

/** The viewer, at a moment of a step, exploded, or with a part at its best pose. */
async function viewer(page, shot) {
  await page.goto(`file://${shot.page}`);
  await page.waitForFunction(() => window.dismantle?.drawn);
  if (shot.up === 'y') await page.keyboard.press('u');
  await page.evaluate(s => {
    const d = window.dismantle;
    if (s.mode) d.setMode(s.mode);
    const steps = d.state().mode === 'assembly' ? d.plan.assembly_steps : d.plan.disassembly;
    if (s.step !== undefined) {
      const index = Math.min(s.step, steps.length - 1), end = steps[index].moves[0].poses.length - 1;
      const [a, b] = [d.timeOf(d.state().mode, index, 0), d.timeOf(d.state().mode, index, end)];
      d.seek(a + (s.share ?? 0.6) * (b - a));
    }
    if (s.explode) d.explode(s.explode);
    else if (s.refit) d.fit();
  }, shot);
  if (shot.problem) {
    await page.getByRole('tab', {name: 'Problems'}).click();
    await page.getByRole('button', {name: /Show (how far|what holds)/}).nth(shot.problem - 1).click();
  }
  await page.waitForTimeout(shot.problem ? 3500 : 900);
  if (!shot.whole) await page.addStyleTag({content: LOOSE});
  const what = shot.whole ? page : page.locator('.view');
  await what.screenshot({path: shot.out, type: 'jpeg', quality: 82});
}

for (const shot of shots) {
  const [width, height] = shot.size ?? [1180, 560];
  const page = await browser.newPage({viewport: {width, height}, colorScheme: 'light'});
  await (shot.section === undefined ? viewer : book)(page, shot);
  await page.close();
  console.log(shot.out);
}
await browser.close();
