// Tests the page in a real browser. Status 77 (skipped) when there is none.
import assert from 'node:assert/strict';
import {mkdirSync, mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import nodeTest, {after, before} from 'node:test';
import {distance, placed, randomNumbers} from '../cases.mjs';
import {CHROMIUM, hasChromium, launch, open} from './chromium.mjs';
import {box, changed, changedPlan, explained, planBoxes, planSample, run} from './plans.mjs';

if (!hasChromium()) {
  console.log(`skipped: there is no ${CHROMIUM} (Debian: apt-get install chromium)`);
  process.exit(77);
}

const folder = mkdtempSync(join(tmpdir(), 'dismantle-viewer-'));
let browser, bolt, boxes, closed, shelf;
const EVIL = ['<img src=x onerror=alert(1)>', "a&amp;b'\"<b>c", '<!--<script>x'];

before(async () => {
  bolt = planSample(folder, 'bolt_and_nut');
  closed = planSample(folder, 'closed_box');
  shelf = planSample(folder, 'stacked_box');
  boxes = planBoxes(folder, 'boxes', EVIL);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  rmSync(folder, {recursive: true});
});

/** A test that hangs fails by its name, and the others go on. */
const test = (title, body) => nodeTest(title, {timeout: 240_000}, body);

/** A test with a page that must cause no console errors and load nothing but itself. */
function onPage(title, file, body, options) {
  test(title, async () => {
    const page = await open(browser, file(), options);
    try {
      await body(page);
      assert.deepEqual(page.complaints, []);
      assert.deepEqual(page.requests.filter(url => !/^(file:\/\/|data:|blob:)/.test(url)), []);
      assert.equal(new Set(page.requests.filter(url => url.startsWith('file://'))).size, 1);
    } finally {
      await page.close();
    }
  });
}

/** Waits until a part is drawn at a pose. */
const arrives = (page, part, pose) => page.waitForFunction(
  ([n, goal]) => Math.hypot(...window.dismantle.shownPoint(n, [1, 2, 3]).map((x, k) => x - goal[k])) < 1e-6, [part, placed(pose, [1, 2, 3])]);

/** Compares the drawn pose of each part with plan.json, at all poses of some steps. */
async function comparePoses(page, plan, mode) {
  const r = randomNumbers(9), steps = mode === 'disassembly' ? plan.disassembly : plan.assembly_steps, box = plan.assembly.bbox;
  const size = Math.max(...box[1].map((x, k) => x - box[0][k]));
  const points = [0, 1, 2].map(() => box[0].map((x, k) => r.between(x, box[1][k])));
  await page.evaluate(m => window.dismantle.setMode(m), mode);
  for (const [s, {moves}] of steps.entries())
    for (const {part, poses} of moves)
      for (const k of new Set([0, 1, Math.floor(poses.length / 2), poses.length - 2, poses.length - 1])) {
        const [seen, told] = await page.evaluate(([m, s_, k_, name, points_]) => {
          const d = window.dismantle, time = d.timeOf(m, s_, k_);
          d.seek(time);
          return [points_.map(p => d.shownPoint(name, p)), d.poseOf(name, time)];
        }, [mode, s, k, part, points]);
        points.forEach((p, i) => {
          // Matrices are computed in double precision throughout.
          assert.ok(distance(seen[i], placed(poses[k], p)) < 1e-9 * size, `${mode}, step ${s + 1}, ${part}, pose ${k}: off by ${distance(seen[i], placed(poses[k], p))}`);
          assert.ok(distance(placed(told, p), placed(poses[k], p)) < 1e-9 * size);
        });
      }
}

for (const [name, get] of [['a nut that turns', () => bolt], ['a box with a stack of plates', () => shelf]])
  for (const mode of ['disassembly', 'assembly'])
    onPage(`${name}: scrubbing brings each part to the pose that plan.json says (${mode})`, () => get().file, page => comparePoses(page, get().plan, mode));

onPage('the scrubber and the keys set the time that the scene shows', () => bolt.file, async page => {
  const state = () => page.evaluate('window.dismantle.state()');
  const {plan} = bolt, part = plan.disassembly[0].moves[0].part, point = [1, 2, 3], poses = plan.disassembly[0].moves[0].poses;
  const shown = () => page.evaluate(([n, p]) => window.dismantle.shownPoint(n, p), [part, point]);
  assert.equal((await state()).step, -1);
  await page.keyboard.press('ArrowRight');
  assert.equal((await state()).step, 0);
  assert.ok(distance(await shown(), placed(poses[poses.length - 1], point)) < 1e-6, 'one step on, it is where the step ends');
  await page.keyboard.press('Home');
  assert.ok(distance(await shown(), point) < 1e-6, 'at the beginning it is assembled');
  await page.locator('input.scrub').evaluate(e => { e.value = e.max / 2; e.dispatchEvent(new Event('input')); });
  assert.ok(Math.abs((await state()).time - await page.evaluate('window.dismantle.duration()') / 2) < 1e-6);
  await page.keyboard.press('Space');
  assert.equal((await state()).playing, true);
  await page.waitForFunction(() => !window.dismantle.state().playing);
  assert.equal((await state()).time, await page.evaluate('window.dismantle.duration()'));
  assert.ok(distance(await shown(), placed(poses[poses.length - 1], point)) < 1e-6, 'played to the end, it is where the plan ends');
});

onPage('the lists show each step and part by name', () => shelf.file, async page => {
  const {plan} = shelf;
  assert.deepEqual(await page.locator('.steps .name').allTextContents(), plan.disassembly.map(s => s.moves.map(m => m.part).join(', ')));
  assert.deepEqual((await page.locator('.parts .part .name').allTextContents()).sort(), plan.assembly.parts.map(p => p.name).sort());
  assert.match(await page.locator('.summary').textContent(), /Complete/);
  for (const run of await page.locator('.steps .run > .step').all()) await run.click();
  await page.locator('.steps li:not(.run) > .step').nth(1).click();
  assert.equal((await page.evaluate('window.dismantle.state()')).step, 1);
});

onPage('how a step was found is a detail, and not a headline of every good step', () => shelf.file, async page => {
  const seen = () => page.locator('body').innerText();
  for (const key of ['Home', 'ArrowRight', 'ArrowRight']) {
    await page.keyboard.press(key);
    assert.doesNotMatch(await seen(), /cuts in|found by/);
  }
  const step = page.locator('.steps li:not(.run) > .step:visible');  // lines of several steps open by a click
  await step.last().click();
  assert.doesNotMatch(await seen(), /cuts in|found by/);
  await page.locator('.steps li.open summary').click();
  assert.match(await page.locator('.steps li.open').innerText(), /cuts in\s+at most [\s\S]*found by/);
  await step.first().click();
  assert.match(await page.locator('.steps li.open').innerText(), /found by/, 'they stay open for the next step');
});

onPage('put together: other steps, and the layout first', () => shelf.file, async page => {
  const {plan} = shelf;
  await page.getByRole('button', {name: 'Put together'}).click();
  assert.deepEqual(await page.locator('.steps .name').allTextContents(), plan.assembly_steps.map(s => s.moves.map(m => m.part).join(', ')));
  const {part, poses} = plan.assembly_steps[plan.assembly_steps.length - 1].moves[0];
  await page.evaluate('window.dismantle.seek(0)');
  const seen = await page.evaluate(n => window.dismantle.shownPoint(n, [1, 2, 3]), part);
  const first = plan.assembly_steps.flatMap(s => s.moves).find(m => m.part === part).poses[0];
  assert.ok(distance(seen, placed(first, [1, 2, 3])) < 1e-6);
  await page.keyboard.press('End');
  assert.ok(distance(await page.evaluate(n => window.dismantle.shownPoint(n, [1, 2, 3]), part), placed(poses[poses.length - 1], [1, 2, 3])) < 1e-6);
  await page.keyboard.press('a');
  assert.equal((await page.evaluate('window.dismantle.state()')).mode, 'disassembly');
});

onPage('exploded, parts are apart; back at zero they are assembled', () => shelf.file, async page => {
  const names = shelf.plan.assembly.parts.map(p => p.name);
  const corners = () => page.evaluate(list => list.map(n => window.dismantle.box(n).map(p => window.dismantle.shownPoint(n, p))), names);
  const assembled = await corners();
  await page.locator('#explode').fill('1');
  const apart = await corners();
  for (let i = 0; i < names.length; ++i)
    for (let j = 0; j < i; ++j)
      assert.ok([0, 1, 2].some(k => apart[i][0][k] >= apart[j][1][k] - 1e-6 || apart[j][0][k] >= apart[i][1][k] - 1e-6), `${names[i]} and ${names[j]}`);
  await page.locator('#explode').fill('0');
  assert.deepEqual(await corners(), assembled);
});

onPage('hide, isolate, transparent, show all', () => shelf.file, async page => {
  const names = shelf.plan.assembly.parts.map(p => p.name), opacities = () => page.evaluate(list => list.map(n => window.dismantle.opacity(n)), names);
  const row = page.locator(`.parts li[data-part="${names[1]}"]`);
  await page.getByRole('tab', {name: 'Parts'}).click();
  await row.getByRole('button', {name: 'Hide or show'}).click();
  assert.deepEqual(await opacities(), names.map((_, i) => i === 1 ? 0 : 1));
  await row.getByRole('button', {name: 'Isolate'}).click();
  assert.deepEqual(await opacities(), names.map((_, i) => i === 1 ? 1 : 0));
  await page.getByRole('button', {name: 'Show all'}).click();
  await row.getByRole('button', {name: 'Transparent'}).click();
  const seen = await opacities();
  assert.ok(seen[1] > 0 && seen[1] < 0.5 && seen[0] === 1);
  await page.keyboard.press('Shift+H');
  assert.deepEqual(await opacities(), names.map(() => 1));
  await page.locator('.find').fill(names[2]);
  assert.deepEqual(await page.locator('.parts li:visible .name').allTextContents(), names.filter(n => n.includes(names[2])));
});

onPage('a click on a part selects it', () => bolt.file, async page => {
  const view = await page.locator('.view canvas').boundingBox();
  await page.evaluate('window.dismantle.fit()');
  await page.waitForTimeout(100);
  await page.mouse.click(view.x + view.width / 2, view.y + view.height / 2);
  const {selected} = await page.evaluate('window.dismantle.state()');
  assert.ok(bolt.plan.assembly.parts.some(p => p.name === selected), `${selected}`);
  assert.match(await page.locator('.selected').textContent(), new RegExp(selected));
  await page.mouse.click(view.x + 4, view.y + 300);
  assert.equal((await page.evaluate('window.dismantle.state()')).selected, null);
});

onPage('names with markup in them are text', () => boxes.file, async page => {
  assert.deepEqual((await page.locator('.parts .part .name').allTextContents()).sort(), [...EVIL].sort());
  for (const name of EVIL) {
    await page.evaluate(n => window.dismantle.select(n), name);
    assert.equal(await page.locator('.selected .name').textContent(), name);
  }
  await page.keyboard.press('End');
  assert.equal(await page.locator('img, b, body script').count(), 0, 'no element came of a name');
});

test('a part called </script> ends no script', async () => {
  const name = '</script><img src=x onerror=alert(1)>';
  const file = changed(bolt.file, 'script.html', ({plan}) => {
    const old = plan.assembly.parts[0].name, text = JSON.stringify(plan).replaceAll(JSON.stringify(old), JSON.stringify(name));
    Object.assign(plan, JSON.parse(text));
  });
  const page = await open(browser, file);
  assert.ok((await page.evaluate('window.dismantle.partNames()')).includes(name));
  assert.deepEqual(page.complaints, []);
  await page.close();
});

onPage('a partial plan shows each reason, what was in the way and the best pose', () => closed.file, async page => {
  const {plan} = closed;
  assert.equal(plan.status, 'partial');
  assert.match(await page.locator('.summary').textContent(), /Partial/);
  const advice = explained(folder, 'closed_box').left.flatMap(reason => reason.advice), shown = page.locator('.problems .advice li');
  assert.ok(advice.length > 0);
  assert.deepEqual((await shown.allTextContents()).sort(), advice.map(text => text.replaceAll('`', '')).sort(), 'the advice of explain');
  for (const u of plan.unsolved) {
    const card = page.locator('article').filter({has: page.locator(`[data-part="${u.part}"]`)}), text = await card.textContent();
    const own = page.locator(`[data-part="${u.part}"].attempt`);
    if (u.message) assert.ok(text.includes(u.message));
    for (const name of u.blocked_by) assert.ok(text.includes(name));
    assert.equal(await page.evaluate(n => window.dismantle.colour(n), u.part), '#e5484d');
    const moved = distance(placed(u.best_pose, [1, 2, 3]), [1, 2, 3]) > 1e-3;
    await own.getByRole('button', {name: moved ? 'Show how far it got' : 'Show what holds it'}).click();
    assert.equal((await page.evaluate('window.dismantle.state()')).best, u.part);
    await arrives(page, u.part, u.best_pose);
    await page.keyboard.press('Escape');
    assert.equal((await page.evaluate('window.dismantle.state()')).best, null);
  }
});

test('best poses, forced steps and certificates, as plans to come may have them', async () => {
  const pose = [3, -4, 12, Math.cos(0.4), 0, Math.sin(0.4), 0];
  const file = changedPlan(folder, 'stacked_box', 'forced', plan => {
    const last = plan.disassembly[plan.disassembly.length - 1], stays = plan.remaining[0];
    last.forced = {pair: [last.moves[0].part, stays], depth: 0.4, assembled: 0, at: [0, 0, 0], reason: 'depth_limit'};
    plan.status = 'partial';
    plan.unsolved.push({part: stays, outcome: 'timeout', blocked_by: [last.moves[0].part], best_pose: pose, message: 'the budget <i>ended</i>'});
    plan.certificates = [{kind: 'ring', parts: [stays, last.moves[0].part], full_tolerance: true, margin: 0.01, numbers: {diameter: [2]}, text: 'it is <b>closed</b>'}];
    Object.assign(plan.unsolved.at(-1), {planner: 'guided', attempts: 2, seconds: 3, depth: 4, certificate: 0, places: [{part: last.moves[0].part, at: [1, 2, 3]}]});
    plan.assembly.parts[0].color = '#123456';
  });
  const page = await open(browser, file), stays = shelf.plan.remaining[0];
  assert.equal(await page.locator('.steps .pill.bad').count(), 1);
  await page.keyboard.press('End');
  // 0.4 input units, as a share of the largest edge in input units.
  const box = shelf.plan.assembly.bbox, deepest = 100 * 0.4 / Math.max(...box[1].map((x, k) => x - box[0][k]));
  const told = /forced: cuts in by ([\d.]+) % of the size/.exec(await page.locator('.words .detail').textContent());
  assert.ok(Math.abs(Number(told[1]) - deepest) < 0.01 * deepest, `${told[1]} % for ${deepest} %`);
  await page.getByRole('tab', {name: 'Problems'}).click();
  assert.match(await page.locator('.problems').textContent(), /the budget <i>ended<\/i>.*is forced.*Proof: ring/s);
  await page.getByRole('button', {name: 'Show how far it got'}).click();
  await arrives(page, stays, pose);
  // The card shows attempts, blocking places, proof and advice; the scene shows the places as dots.
  assert.match(await page.locator('article').filter({has: page.locator(`[data-part="${stays}"]`)}).textContent(),
    /Proof \(ring\): it is <b>closed<\/b>.*2 searches by guided, 3 s, to depth 4.*at \(1, 2, 3\).*What you can do.*--path-timeout/s);
  const places = await page.evaluate('window.dismantle.places()');
  assert.equal(places.length, 1);
  assert.ok(distance(places[0], [1, 2, 3]) < 1e-9);
  await page.keyboard.press('Escape');
  assert.deepEqual(await page.evaluate('window.dismantle.places()'), []);
  assert.equal(await page.evaluate(n => window.dismantle.colour(n), shelf.plan.assembly.parts[0].name),
    shelf.plan.assembly.parts[0].name === stays ? '#e5484d' : '#123456');
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('the model lies as each step says, on the same ground, and the step says so', async () => {
  const file = changedPlan(folder, 'stacked_box', 'lying', plan => plan.disassembly.forEach((step, k) => { if (k > 0) step.up = [0, 0, -1]; }));
  const page = await open(browser, file), {assembly, disassembly, assembly_steps: back} = shelf.plan;
  const lies = (mode, step, pose) => page.evaluate(([m, s, k]) => {
    const d = window.dismantle;
    d.setMode(m);
    d.seek(d.timeOf(m, s, k));
    return d.lies();
  }, [mode, step, pose]);
  const low = async () => (await page.evaluate(names => names.flatMap(n => {
    const [lo, hi] = window.dismantle.box(n);
    return [0, 1, 2, 3, 4, 5, 6, 7].map(c => window.dismantle.shownPoint(n, lo.map((x, k) => c >> k & 1 ? hi[k] : x))[2]);
  }), assembly.parts.map(p => p.name))).reduce((a, b) => Math.min(a, b));
  assert.deepEqual((await lies('disassembly', 0, 0)).map(x => x + 0), [0, 0, 0, 1, 0, 0, 0]);
  assert.ok(Math.abs(await low() - assembly.bbox[0][2]) < 1e-6);
  assert.match(await page.locator('.words .lies').textContent(), /^lies: as drawn/);
  assert.ok(Math.abs((await lies('disassembly', 1, 0))[3]) < 1e-9);
  assert.equal(await page.locator('.words .lies').textContent(), 'lies: upside down (-Z up)');
  assert.match(await page.locator('.steps li.open').textContent(), /turn the assembly.*upside down/s);
  // Backwards it lies alike, and when the last step ends all stands on the ground.
  const {length: n} = disassembly;
  assert.ok(Math.abs((await lies('assembly', 0, back[0].moves[0].poses.length - 1))[3]) < 1e-9);
  assert.equal((await lies('assembly', n - 1, back[n - 1].moves[0].poses.length - 1))[3], 1);
  assert.ok(Math.abs(await low() - assembly.bbox[0][2]) < 1e-6);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('equal steps that follow each other are one line, which opens where time or the user is', async () => {
  // Boxes of one shape, which leave the stack upwards one by one.
  const {file, plan} = planBoxes(folder, 'equal', ['base', 'a', 'b', 'c', 'd'], [20, 10, 10, 10, 10]);
  const page = await open(browser, file), numbers = () => page.locator('.steps > li:visible > .step .count').allTextContents();
  const n = plan.disassembly.length;
  assert.equal(n, 4);
  assert.deepEqual(await numbers(), ['1–4']);
  assert.match(await page.locator('.steps .run > .step .title').textContent(), /^4x [abcd]$/);
  assert.equal(await page.locator('.steps .run ol').isVisible(), false);
  await page.locator('.steps .run > .step').click();
  assert.deepEqual(await page.locator('.steps .run ol .count').allTextContents(), ['1', '2', '3', '4']);
  await page.locator('.steps .run ol .step').nth(2).click();
  assert.equal((await page.evaluate('window.dismantle.state()')).step, 2);
  await page.locator('.steps .run > .step').click();
  assert.equal(await page.locator('.steps .run ol').isVisible(), false);
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('ArrowLeft');
  assert.equal(await page.locator('.steps .run ol').isVisible(), true, 'the step that runs is seen');
  await page.getByRole('button', {name: 'Put together'}).click();
  assert.deepEqual(await numbers(), ['1–4']);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

/** The shelf's plan with a check's note on its second step: a part to hold. */
const heldPlan = name => changedPlan(folder, 'stacked_box', name, plan => {
  const held = plan.remaining[0];
  plan.objective = {up: [0, 0, 1], cost: 1, checks: [{type: 'gravity', weight: 1, parameters: {}, cost: 1}]};
  plan.disassembly.forEach((step, k) => {
    step.checks = [{type: 'gravity', weight: 1, cost: k === 1 ? 1 : 0, allowed: true, ...k === 1 ? {reason: '1 part must be held', notes: [
      {kind: 'gravity', text: `Hold '${held}': it tips.`, data: {hold: [{part: held, when: 'during', newton: 2}], hands: 2}}]} : {}}];
  });
});

test('a step says what has to come before and after it, the summary which check costs what, with the numbers of the mode', async () => {
  const page = await open(browser, heldPlan('ordered')), {plan} = shelf, n = plan.disassembly.length;
  const waiting = plan.disassembly.find(s => s.after?.length > 0), [first] = waiting.after;
  const openStep = (mode, number) => page.evaluate(([m, i]) => { window.dismantle.setMode(m); window.dismantle.seek(window.dismantle.timeOf(m, i, 0)); }, [mode, number - 1]);
  await openStep('disassembly', waiting.step);
  assert.match(await page.locator('.steps li.open').textContent(), new RegExp(`orderafter steps? .*\\b${first}\\b.*: parts are in the way otherwise`));
  await openStep('assembly', n + 1 - waiting.step);
  assert.match(await page.locator('.steps li.open').textContent(), new RegExp(`order(after .*, )?before steps? .*\\b${n + 1 - first}\\b`));
  await page.getByRole('tab', {name: 'Summary'}).click();
  const why = page.locator('.account', {hasText: 'Why this order'});
  assert.match(await why.textContent(), new RegExp(`gravity: costs 1 of 1, in step ${n - 1}\\D`));
  await page.evaluate('window.dismantle.setMode("disassembly")');
  assert.match(await why.textContent(), /gravity: costs 1 of 1, in step 2\D/);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('a step shows what moves, what must be held, and the notes; how it was found is behind "Details"', async () => {
  const page = await open(browser, heldPlan('held')), {plan} = shelf, [held] = plan.remaining, state = () => page.evaluate('window.dismantle.state()');
  assert.deepEqual(await page.locator('.steps .pill.held').count(), 1);
  await page.evaluate('window.dismantle.seek(window.dismantle.timeOf("disassembly", 1, 0))');
  assert.deepEqual((await state()).moving, plan.disassembly[1].moves.map(m => m.part));
  assert.deepEqual((await state()).held, [held]);
  const step = page.locator('.steps li.open');
  assert.match(await step.textContent(), new RegExp(`hold${held}.*Hold '${held}': it tips`, 's'));
  assert.equal(await step.getByText('found by').isVisible(), false);
  await step.locator('summary').click();
  assert.equal(await step.getByText('found by').isVisible(), true);
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowRight');
  assert.deepEqual((await state()).held, []);
  assert.equal(await page.locator('.steps li.open').getByText('found by').isVisible(), true, 'details stay open');
  // Backwards it is the same operation.
  const n = plan.disassembly.length;
  await page.keyboard.press('a');
  await page.evaluate(s => window.dismantle.seek(window.dismantle.timeOf('assembly', s, 0)), n - 2);
  assert.deepEqual((await state()).held, [held]);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('what falls without hands is played with the forces on it, and stops', async () => {
  const {plan} = shelf, part = plan.remaining[0], [lo, hi] = plan.assembly.bbox, center = lo.map((x, k) => (x + hi[k]) / 2);
  const picture = {when: 'after', falls: [{parts: [part], center, v: [0, 0, -1], w: [0, 0, 0]}],
    arrows: [{kind: 'weight', part, at: center, force: [0, 0, -2]}, {kind: 'hold', part, at: center, force: [0, 0, 2]}]};
  const page = await open(browser, changedPlan(folder, 'stacked_box', 'falls', other => {
    other.objective = {up: [0, 0, 1], cost: 1, checks: [{type: 'gravity', weight: 1, parameters: {}, cost: 1}]};
    other.disassembly.forEach((step, k) => {
      step.checks = [{type: 'gravity', weight: 1, cost: k === 1 ? 1 : 0, allowed: true, ...k === 1 ? {notes: [{kind: 'hold', text: `Hold '${part}'.`, data: {hold: [{part, when: 'after', newton: 2}], hands: 2, picture}}]} : {}}];
    });
  })), fall = () => page.evaluate('window.dismantle.fall()');
  const height = () => page.evaluate(n => window.dismantle.shownPoint(n, [0, 0, 0])[2], part);
  await page.keyboard.press('d');
  assert.equal(await fall(), null, 'nothing is said before the first step');
  for (const [mode, at, keys] of [['disassembly', 1, 2], ['assembly', plan.disassembly.length - 2, 3]]) {
    await page.evaluate(m => window.dismantle.setMode(m), mode);
    await page.evaluate(([m, s]) => window.dismantle.seek(window.dismantle.timeOf(m, s, 1)), [mode, at]);
    const before = await height();
    await page.getByRole('button', {name: 'Show what falls without hands'}).click({timeout: 60_000});
    const {parts, arrows} = await fall();
    assert.deepEqual(parts, [part]);
    assert.deepEqual(arrows.map(a => a.kind), ['weight', 'hold']);
    assert.ok(distance(arrows[0].at, center) < 1e-9);
    await page.evaluate('window.dismantle.fallAt(1)');
    const size = Math.max(...hi.map((x, k) => x - lo[k])), way = before - await height();
    assert.ok(way > 0.03 * size && way < 0.2 * size, `${mode}: it falls by ${way} of ${size}`);
    assert.match(await page.locator('.banner').textContent(), new RegExp(`Without a hand ${part} falls.*weight.*hand`));
    await page.keyboard.press(keys === 2 ? 'd' : 'Escape');
    assert.equal(await fall(), null);
    assert.ok(Math.abs(await height() - before) < 1e-9 * size);
  }
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('a page of a pile says whether it stands, and shows what falls', async () => {
  mkdirSync(join(folder, 'sign'));
  const corners = {leg: [[0, 0, 0], [10, 10, 20]], plate: [[0, 0, 20], [60, 10, 25]]};
  for (const [name, [lo, hi]] of Object.entries(corners)) writeFileSync(join(folder, 'sign', `${name}.obj`), box(lo, hi));
  run(folder, [1], 'stability', 'sign', '-o', 'sign.out', '-q');
  const page = await open(browser, join(folder, 'sign.out', 'index.html'));
  assert.match(await page.locator('.summary').textContent(), /^It falls2 parts$/);
  assert.match(await page.locator('article.card').first().textContent(), /'plate' tips towards \+x: nothing is under its half towards \+x\. Hold plate\./);
  const corner = () => page.evaluate(() => window.dismantle.shownPoint('plate', [60, 5, 20])[2]);
  await page.keyboard.press('d');
  await page.evaluate('window.dismantle.fallAt(1)');
  assert.deepEqual((await page.evaluate('window.dismantle.fall()')).parts, ['plate']);
  assert.ok(await corner() < 19, 'its free end goes down');
  await page.keyboard.press('s');
  assert.equal((await page.evaluate('window.dismantle.section()')).axis, 'x', 'the section works as before');
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('a forced step is shown where it begins to cut in', async () => {
  const {plan} = shelf, last = plan.disassembly.length - 1, [name, other] = [plan.disassembly[last].moves[0].part, plan.remaining[0]];
  let reached;
  const page = await open(browser, changedPlan(folder, 'stacked_box', 'reached', changed_ => {
    const steps = [changed_.disassembly[last], changed_.assembly_steps[0]];
    for (const step of steps) step.forced = {pair: [name, other], depth: 0.5, assembled: 0, at: [0, 0, 0], reason: 'it is too wide'};
    const [{poses}] = steps[0].moves, [first, second] = poses;
    reached = first.map((x, k) => k < 3 ? 0.75 * x + 0.25 * second[k] : x);
    steps[0].valid_to = 1;
    changed_.status = 'forced';
    const back = steps[1].moves[0].poses;
    poses.splice(1, 0, reached);
    back.splice(back.length - 1, 0, reached);
  }));
  for (const mode of ['disassembly', 'assembly']) {
    await page.evaluate(m => window.dismantle.setMode(m), mode);
    await page.evaluate(([m, s]) => window.dismantle.seek(window.dismantle.timeOf(m, s, 1)), [mode, mode === 'assembly' ? 0 : last]);
    assert.match(await page.locator('.steps li.open').textContent(), /how far.*comes .* without cutting in/);
    await page.locator('.steps li.open').getByRole('button', {name: 'Show how far it comes'}).click({timeout: 60_000});
    const seen = await page.evaluate(n => window.dismantle.shownPoint(n, [1, 2, 3]), name);
    assert.ok(distance(seen, placed(reached, [1, 2, 3])) < 1e-6, `${mode}: ${seen}`);
    assert.equal((await page.evaluate('window.dismantle.places()')).length, 1);
  }
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('the tool of a step is drawn where its note says, follows its part, and can be hidden', async () => {
  const {plan} = shelf, [{part, poses}] = plan.disassembly[1].moves, [box] = [plan.assembly.bbox];
  const origin = box[1], along = poses.at(-1).slice(0, 3).map((x, k) => x - poses[0][k]), far = Math.hypot(...along);
  const axis = along.map(x => x / far), x = Math.abs(axis[0]) > 0.9 ? [0, 1, 0] : [1, 0, 0];
  const page = await open(browser, changedPlan(folder, 'stacked_box', 'tool', changed_ => {
    changed_.objective = {up: [0, 0, 1], cost: 0, checks: [{type: 'tool_access', weight: 1, parameters: {}, cost: 0}]};
    changed_.disassembly.forEach((step, k) => {
      step.checks = [{type: 'tool_access', weight: 1, cost: 0, allowed: true, ...k === 1 ? {notes: [{kind: 'tool_access.tool', text: 'A key.', data: {
        part, tool: 'key', name: 'key', use: '', at: origin, from: axis, handle: x.map((v, i) => v - axis[i] * x.reduce((sum, w, j) => sum + w * axis[j], 0)), swing: 1,
        picture: {origin, mm: 1, travel: 0.5 * far, tool: [{tube: {radius: 1, inner: 0, z: [0, 20]}}], hand: [{box: {x: [5, 9], y: [-2, 2], z: [10, 14]}}]}}}]} : {}}];
    });
  })), tools = () => page.evaluate('window.dismantle.tools()');
  assert.deepEqual(await tools(), []);
  await page.evaluate('window.dismantle.seek(window.dismantle.timeOf("disassembly", 1, 0))');
  const [seated] = await tools();
  assert.deepEqual([seated.name, seated.part, seated.turns], ['key', part, true]);
  assert.ok(distance(seated.at, origin) < 1e-6 * far);
  // A little later it has gone along with the part; at the end of the step it is gone.
  await page.evaluate('window.dismantle.seek(window.dismantle.timeOf("disassembly", 1, 0) + 0.02)');
  const [moved] = await tools(), shift = moved.at.map((v, k) => v - origin[k]);
  assert.ok(shift.reduce((sum, v, k) => sum + v * axis[k], 0) > 0);
  await page.keyboard.press('w');
  assert.deepEqual(await tools(), []);
  await page.keyboard.press('w');
  assert.equal((await tools()).length, 1);
  await page.evaluate('window.dismantle.seek(window.dismantle.timeOf("disassembly", 1, 0) + 1e-9)');
  await page.evaluate(`window.dismantle.seek(window.dismantle.timeOf("disassembly", 1, ${poses.length - 1}))`);
  assert.deepEqual(await tools(), []);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('an address opens the page at a step, and follows its changes', async () => {
  const page = await open(browser, `${shelf.file}#step=2`), state = () => page.evaluate('window.dismantle.state()');
  assert.equal((await state()).step, 1);
  assert.equal(await page.locator('.steps li.open a').getAttribute('href'), '#step=2');
  await page.evaluate(() => { location.hash = '#step=3&mode=assembly'; });
  await page.waitForFunction(() => window.dismantle.state().mode === 'assembly');
  assert.equal((await state()).step, 2);
  await page.evaluate(() => { location.hash = '#step=99'; });
  await page.waitForTimeout(100);
  assert.equal((await state()).step, 2, 'there is no such step');
  assert.deepEqual(page.complaints, []);
  await page.close();
});

onPage('the camera follows the step if asked to', () => shelf.file, async page => {
  const view = () => page.evaluate('window.dismantle.camera()'), seek = k => page.evaluate(s => window.dismantle.seek(window.dismantle.timeOf('disassembly', s, 0)), k);
  await seek(0);
  await page.waitForFunction(() => !window.dismantle.flying());
  const before = await view();
  await seek(1);
  const still = await view();  // but for rounding
  assert.ok(distance(still.target, before.target) < 1e-9 && distance(still.position, before.position) < 1e-9, 'it stays by itself');
  await page.keyboard.press('v');
  assert.equal((await page.evaluate('window.dismantle.state()')).following, true);
  await page.waitForFunction(() => !window.dismantle.flying());
  const then = await view();
  assert.ok(distance(then.target, before.target) > 1e-3);
  await seek(2);
  await page.waitForFunction(() => !window.dismantle.flying());
  assert.ok(distance((await view()).target, then.target) > 1e-3);
});

onPage('the print of a step has its picture and its words, and nothing else', () => shelf.file, async page => {
  await page.evaluate('window.dismantle.seek(window.dismantle.timeOf("disassembly", 1, 0))');
  await page.evaluate(() => {
    window.print = () => {
      const sheet = document.querySelector('.sheet'), image = sheet.querySelector('img');
      window.printed = {title: sheet.querySelector('h1').textContent, width: image.naturalWidth};
    };
  });
  await page.keyboard.press('p');
  const {title, width} = await (await page.waitForFunction('window.printed')).jsonValue();
  assert.match(title, new RegExp(`^Step 2 of ${shelf.plan.disassembly.length}: ${shelf.plan.disassembly[1].moves[0].part}`));
  assert.ok(width > 100);
  assert.equal(await page.locator('.sheet').count(), 0, 'it is gone afterwards');
  await page.emulateMedia({media: 'print'});
  assert.equal(await page.locator('.page').isVisible(), true, 'without a sheet the page itself is printed');
  await page.emulateMedia({media: null});
});

onPage('a section cuts parts open, and what is cut away is not picked', () => shelf.file, async page => {
  const [lo, hi] = shelf.plan.assembly.bbox, middle = lo.map((x, k) => (x + hi[k]) / 2);
  const hovered = async at => {
    const names = shelf.plan.assembly.parts.map(p => p.name);
    await page.mouse.click(...at);
    return names.includes((await page.evaluate('window.dismantle.state()')).selected) ? (await page.evaluate('window.dismantle.state()')).selected : null;
  };
  await page.evaluate('window.dismantle.view("top")');
  const outer = await page.evaluate(p => window.dismantle.onScreen(window.dismantle.partNames()[0], p), [middle[0], middle[1], hi[2]]);
  const above = await hovered(outer);
  assert.ok(above);
  await page.keyboard.press('Escape');
  for (const axis of ['x', 'y', 'z', null]) {
    await page.keyboard.press('s');
    assert.equal((await page.evaluate('window.dismantle.section()')).axis, axis);
    if (axis !== 'z') continue;
    const shown = await page.locator('.inspect .state').first().textContent();
    assert.match(shown, new RegExp(`^Z = ${Number(((lo[2] + hi[2]) / 2).toPrecision(3))} `));
    const below = await hovered(outer);
    assert.ok(below && below !== above, 'the lid is cut away; something below it is selected');
    await page.keyboard.press('Escape');
  }
  assert.equal(await hovered(outer), above);
});

onPage('two points are measured from corner to corner, and move with their parts', () => shelf.file, async page => {
  const [[lo, hi], name] = await page.evaluate(() => {
    const names = window.dismantle.partNames(), name = names.reduce((a, b) => window.dismantle.box(a)[1][2] > window.dismantle.box(b)[1][2] ? a : b);
    window.dismantle.view('corner');
    return [window.dismantle.box(name), name];
  });
  await page.keyboard.press('m');
  const ends = [[lo[0], lo[1], hi[2]], [hi[0], lo[1], hi[2]]];
  for (const [k, end] of ends.entries()) {
    const [x, y] = await page.evaluate(([n, p]) => window.dismantle.onScreen(n, p), [name, end]);
    await page.mouse.click(x + (k === 0 ? 5 : -5), y - 1);  // beside the corner, on the top
  }
  const {distance: length, along} = await page.evaluate('window.dismantle.measured()');
  assert.ok(Math.abs(length - (hi[0] - lo[0])) < 1e-4 * length, `${length} is the length of the edge, ${hi[0] - lo[0]}`);
  assert.ok(along[1] < 1e-4 * length && along[2] < 1e-4 * length);
  assert.match(await page.locator('.inspect [role=status]').textContent(), new RegExp(`^${Number(length.toPrecision(3))} `));
  await page.keyboard.press('End');
  assert.ok(Math.abs((await page.evaluate('window.dismantle.measured()')).distance - length) < 1e-4 * length, 'a part is rigid');
  await page.keyboard.press('Escape');
  assert.equal(await page.evaluate('window.dismantle.measured()'), null);
});

onPage('notes on steps are kept, belong to the parts, and are written as YAML', () => shelf.file, async page => {
  const part = shelf.plan.disassembly[0].moves[0].part, text = 'Grease: "thin"\nand wipe';
  await page.keyboard.press('ArrowRight');
  await page.locator('.steps li.open textarea').fill(text);
  assert.equal((await page.evaluate('window.dismantle.state()')).step, 0, 'keys that are typed are no shortcuts');
  assert.equal(await page.locator('.noted:visible').count(), 1);
  assert.equal(await page.evaluate('window.dismantle.notesYaml()'), `notes:\n  - {parts: ["${part}"], text: ${JSON.stringify(text)}}\n`);
  await page.reload();
  await page.waitForFunction('window.dismantle?.drawn');
  assert.match(await page.evaluate('window.dismantle.notesYaml()'), /Grease/);
  await page.evaluate('window.dismantle.setMode("assembly")');
  await page.keyboard.press('End');
  assert.equal(await page.locator('.steps li.open textarea').inputValue(), text, 'put together, it is the same step');
  const [saved] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', {name: 'Save the note'}).click()]);
  assert.equal(saved.suggestedFilename(), 'notes.yaml');
  const yaml = await page.evaluate('window.dismantle.notesYaml()'), field = page.locator('.steps li.open textarea');
  await field.fill('');
  assert.equal(await page.evaluate('window.dismantle.notesYaml()'), 'notes: []\n');
  // And back from the file.
  const choose = (name, words) => page.locator('.steps li.open input[type=file]').setInputFiles({name, mimeType: 'application/yaml', buffer: Buffer.from(words)});
  await choose('notes.yaml', yaml);
  await page.getByText('1 note read.').waitFor({timeout: 60_000});
  assert.equal(await field.inputValue(), text);
  assert.equal(await page.evaluate('window.dismantle.notesYaml()'), yaml);
  await choose('other.yaml', 'notes:\n  - text\n');
  await page.getByText('other.yaml: line 2').waitFor({timeout: 60_000});
  assert.equal(await page.evaluate('window.dismantle.notesYaml()'), yaml, 'nothing of it is taken');
});

onPage('help, theme, up axis, fading, paths', () => shelf.file, async page => {
  const state = () => page.evaluate('window.dismantle.state()');
  await page.keyboard.press('?');
  assert.ok(await page.locator('dialog.help').isVisible());
  assert.match(await page.locator('dialog.help').textContent(), /Space.*play/s);
  await page.keyboard.press('Escape');
  assert.ok(!await page.locator('dialog.help').isVisible());
  assert.equal((await state()).theme, 'dark');
  await page.keyboard.press('l');
  assert.equal((await state()).theme, 'light');
  await page.keyboard.press('u');
  assert.deepEqual((await state()).up, [0, 1, 0]);
  const last = shelf.plan.disassembly[shelf.plan.disassembly.length - 1].moves[0].part;
  await page.keyboard.press('End');
  assert.equal(await page.evaluate(n => window.dismantle.opacity(n), last), 1, 'few parts stay');
  await page.keyboard.press('r');
  assert.equal(await page.evaluate(n => window.dismantle.opacity(n), last), 0);
  assert.equal(await page.evaluate(n => window.dismantle.opacity(n), shelf.plan.remaining[0]), 1);
  for (const trails of ['all', 'none', 'step']) {
    await page.keyboard.press('t');
    assert.equal((await state()).trails, trails);
  }
}, {colorScheme: 'dark'});

onPage('on a phone nothing is wider than the screen and all is within reach', () => bolt.file, async page => {
  assert.ok(await page.evaluate('document.documentElement.scrollWidth <= innerWidth && document.documentElement.scrollHeight <= innerHeight'));
  for (const name of ['Play or pause', 'Put together', 'Fit into view', 'Next step']) {
    const box = await page.getByRole('button', {name}).boundingBox();
    assert.ok(box.x >= 0 && box.x + box.width <= 390 && box.y >= 0 && box.y + box.height <= 780, name);
  }
  const view = await page.locator('.view canvas').boundingBox();
  assert.ok(view.height > 300);
}, {viewport: {width: 390, height: 780}, hasTouch: true, isMobile: true, deviceScaleFactor: 2});

test('without WebGL the page says so, and lists steps and parts all the same', async () => {
  const plain = await launch({webgl: false});
  try {
    const page = await open(plain, shelf.file);
    assert.match(await page.locator('.nowebgl').textContent(), /cannot draw in 3D.*WebGL/s);
    assert.equal(await page.locator('.steps li:not(.run)').count(), shelf.plan.disassembly.length);
    await page.keyboard.press('ArrowRight');
    await page.keyboard.press('e');
    await page.keyboard.press('a');
    await page.keyboard.press('f');
    assert.equal(page.complaints.filter(c => !/webgl/i.test(c)).length, 0, page.complaints.join('\n'));
  } finally {
    await plain.close();
  }
});

test('damaged data is an error that is shown', async () => {
  const page = await open(browser, changed(bolt.file, 'version.html', data => { data.version = 99; }));
  assert.match(await page.locator('.failure').textContent(), /version 99/);
  await page.close();
});
