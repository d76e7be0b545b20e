// The step in the address of the page: #step=5, or #step=5&mode=assembly; numbers are those of the plan.

/** {mode, step} of an address, null if it names no step. */
export function stepOfAddress(hash) {
  const said = new URLSearchParams(hash.replace(/^#/, '')), step = Number(said.get('step'));
  if (!Number.isInteger(step) || step < 1) return null;
  return {mode: said.get('mode') === 'assembly' ? 'assembly' : 'disassembly', step};
}

export const addressOfStep = (mode, step) => `#step=${step}${mode === 'assembly' ? '&mode=assembly' : ''}`;

/** Goes to the step that the address names, now and when it changes. A step that the plan lacks changes nothing. */
export function followAddress(app) {
  const go = () => {
    const said = stepOfAddress(location.hash);
    if (!said) return;
    const index = app.model.lines[said.mode].steps.findIndex(s => s.step.step === said.step);
    if (index < 0) return;
    if (said.mode !== app.mode) app.setMode(said.mode);
    app.play(false);
    app.goToStep(index);
    app.follow();
  };
  addEventListener('hashchange', go);
  go();
}
