// Notes of the user on steps: kept by the browser, written as YAML for the book.
import {keyOf, notesYaml} from '../plan/notes.js';
import {titleOf} from '../plan/words.js';
import {element, icon} from './dom.js';

export class Notes {
  constructor(app) {
    this.app = app;
    this.key = `dismantle.notes ${app.model.plan.assembly.sha256 ?? titleOf(app.model.plan)}`;
    this.kept = true;  // false: the browser keeps nothing for this page
    this.texts = {};
    try {
      this.texts = JSON.parse(localStorage.getItem(this.key) ?? '{}');
    } catch (error) {
      this.kept = false;
    }
  }

  of(step) {
    return this.texts[keyOf(step)] ?? '';
  }

  set(step, text) {
    if (text.trim() === '') delete this.texts[keyOf(step)];
    else this.texts[keyOf(step)] = text;
    try {
      localStorage.setItem(this.key, JSON.stringify(this.texts));
    } catch (error) {
      this.kept = false;
    }
    this.app.tell('notes');
  }

  get count() {
    return Object.keys(this.texts).length;
  }

  yaml() {
    return notesYaml(this.app.model.plan, this.texts);
  }

  save() {
    const link = element('a', {href: URL.createObjectURL(new Blob([this.yaml()], {type: 'application/yaml'})), download: 'notes.yaml'});
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
}

/** The field for the note on a step, and the button that writes all notes. */
export function makeNote(app, step) {
  const {notes} = app, save = element('button.chip', {type: 'button', title: 'Write all notes as YAML, for `dismantle book --notes`', onclick: () => notes.save()});
  const warning = element('p.note', {}, 'This browser does not keep the notes: save them before you leave.');
  const refresh = () => {
    save.replaceChildren(icon('note'), `Save ${notes.count === 1 ? 'the note' : `${notes.count} notes`}`);
    save.hidden = notes.count === 0;
    warning.hidden = notes.kept || notes.count === 0;
  };
  const field = element('textarea.note', {rows: 2, placeholder: 'Your note on this step', 'aria-label': 'Your note on this step', value: notes.of(step),
    oninput: () => { notes.set(step, field.value); refresh(); }});
  refresh();
  return element('div.own', {}, field, save, warning);
}
