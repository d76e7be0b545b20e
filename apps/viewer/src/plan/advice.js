// Advice for parts that did not come out. `dismantle explain` (lib/plan_io) gives the same advice and knows the run's configuration.

/** Quotes a name with spaces or quotes as a shell word. */
export const quoted = text => /^[\w./-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`;

/**
 * @param group parts of the plan's `unsolved` with one outcome and message
 * @returns texts; text between backquotes is a command or a key
 */
export function adviceOn(group, plan) {
  const [{part, outcome, message}] = group, input = quoted(plan.assembly.source), out = [];
  const overlapping = plan.assembly.overlaps.some(o => group.some(u => [o.a, o.b].includes(u.part) && u.blocked_by.includes(o.a === u.part ? o.b : o.a)));
  const tolerance = why => out.push(`${why}: a larger \`verify.max_penetration\` than ${plan.verified_max_penetration} lets parts cut deeper into each other. The plan then says how deep.`);
  if (message.includes('constraints hold it back')) {
    out.push('The order that you asked for holds it back: look at `constraints` in the configuration.');
  } else if (outcome === 'timeout') {
    if (/whole run|not tried|not begun/.test(message)) out.push(`Give the whole run more time: \`dismantle plan ${input} --timeout 14400\`.`);
    else out.push(`Give its search more time: \`dismantle plan ${input} --part ${quoted(part)} --path-timeout 600\` tries just this part.`);
    out.push('Run it with another planner: `--path-planner guided` combines several.');
  } else if (outcome === 'depth_limit') {
    out.push('Search deeper: `--set sequence_planner.max_depth=N` with a larger N than in `resolved.yaml`.');
    out.push('The default sequence planner, `--sequence-planner blocking`, has no such limit.');
  } else if (outcome === 'exhausted') {
    out.push('Run it with another planner: `--path-planner guided` combines several.');
    tolerance('If the fit is tight or snaps');
  } else if (outcome === 'infeasible') {
    out.push('No other planner and no more time changes this: the parts as they are drawn cannot be separated as rigid bodies.');
    tolerance('If they are meant to snap or to bend');
    out.push('Keep what holds together as one (`constraints: {together: [[...]]}`), or plan without one of them (`constraints: {ignore: [...]}`).');
  } else if (outcome === 'cancelled') {
    out.push('Run it again without interrupting it.');
  } else if (outcome === 'unsupported') {
    out.push('Choose another simulator or path planner: `dismantle plugins list`.');
  } else if (outcome === 'crashed') {
    out.push('The plugin is faulty: `dismantle plugins check ID` tries it.');
  }
  if (overlapping || outcome === 'invalid_start') out.push(`Parts overlap when assembled: \`dismantle check ${input}\` says where. What is drawn into each other often cannot leave.`);
  return out;
}
