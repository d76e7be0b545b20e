// Keyboard shortcuts; ui/help.js lists them.
import {printStep} from './print.js';

const SPEEDS = [0.5, 1, 2, 4, 8];

export function listen(app, display, help) {
  const nudge = seconds => { app.play(false); app.seek(app.time + seconds); };
  const faster = by => app.setSpeed(SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, SPEEDS.indexOf(app.speed) + by))]);
  const selected = f => { if (app.selected >= 0) f(app.selected); };
  const from = view => app.stage?.fit(app.parts.boxes(i => app.opacity(i) > 0), {from: view, margin: 1.2});
  const actions = {
    ' ': () => app.play(), 'ArrowRight': () => app.stepBy(1), 'ArrowLeft': () => app.stepBy(-1),
    'shift ArrowRight': () => nudge(0.1), 'shift ArrowLeft': () => nudge(-0.1),
    'Home': () => { app.play(false); app.seek(0); }, 'End': () => { app.play(false); app.seek(app.line.duration); },
    '<': () => faster(-1), '>': () => faster(1), ',': () => faster(-1), '.': () => faster(1),
    'a': () => app.setMode(app.mode === 'disassembly' ? 'assembly' : 'disassembly'),
    'e': () => app.setExplode(app.explode > 0 ? 0 : 1), 'f': () => app.fit(), '0': () => from('corner'), '1': () => from('front'),
    '2': () => from('right'), '3': () => from('top'), 't': () => display.nextTrails(), 'c': () => display.nextColours(),
    'r': () => app.setFading(!app.fading), 'g': () => display.ground(), 'u': () => display.turnUp(), 'l': () => display.nextTheme(),
    'd': () => app.fall ? app.leaveFall() : app.showFall(), 'v': () => app.setFollowing(!app.following), 'p': () => printStep(app), 'w': () => app.stage && app.setTools(!app.tools.on), 's': () => app.cut?.(), 'm': () => app.measuring?.(),
    'h': () => selected(i => app.toggle('hidden', i)), 'x': () => selected(i => app.toggle('clear', i)),
    'i': () => app.isolated ? app.isolate(null) : selected(i => app.isolate(new Set([i]))),
    'H': () => app.showAll(), '?': () => help.open ? help.close() : help.showModal(),
    'Escape': () => { if (app.measure?.on) app.measuring(false); else if (app.best) app.leaveBest(); else if (app.fall) app.leaveFall(); else app.select(-1); },
  };
  document.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const typing = event.target instanceof HTMLTextAreaElement || event.target instanceof HTMLInputElement && event.target.type === 'search';
    if (typing) {
      if (event.key === 'Escape') event.target.blur();
      return;
    }
    if (help.open && event.key !== '?') return;
    // Space presses the focused button, as usual, instead of its shortcut.
    if (event.key === ' ' && event.target instanceof HTMLButtonElement && !event.target.classList.contains('play')) return;
    const action = actions[(event.shiftKey && event.key.startsWith('Arrow') ? 'shift ' : '') + event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
