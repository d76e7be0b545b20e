// Notes of the user on steps: kept by the browser, written as YAML for the book.
import {keyOf, notesYaml, readNotes} from '../plan/notes.js';
import {counted, titleOf} from '../plan/words.js';
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
    this.#keep();
  }

  /** Adds the notes of a file to those that are there; on the same step, that of the file counts. Returns what was done, as a sentence. */
  load(yaml) {
    const {texts, unknown} = readNotes(this.app.model.plan, yaml);
    Object.assign(this.texts, texts);
    this.#keep();
    const done = `${counted(Object.keys(texts).length, 'note')} read`;
    return unknown.length === 0 ? `${done}.` : `${done}; ${unknown.length} for steps that this plan does not have: ${unknown.map(n => n.parts.join(', ')).join('; ')}.`;
  }

  #keep() {
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
  const said = element('p.note', {role: 'status', hidden: true});
  const file = element('input', {type: 'file', accept: '.yaml,.yml', hidden: true, 'aria-label': 'A file of notes', onchange: async () => {
    const [chosen] = file.files;
    if (!chosen) return;
    try {
      said.textContent = notes.load(await chosen.text());
      field.value = notes.of(step);
    } catch (error) {
      said.textContent = `${chosen.name}: ${error.message}`;
    }
    said.hidden = false;
    file.value = '';  // the same file may be chosen again
    refresh();
  }});
  const load = element('button.chip', {type: 'button', title: 'Read notes from a file that this page has saved', onclick: () => file.click()}, icon('note'), 'Load notes');
  const refresh = () => {
    save.replaceChildren(icon('note'), `Save ${notes.count === 1 ? 'the note' : `${notes.count} notes`}`);
    save.hidden = notes.count === 0;
    warning.hidden = notes.kept || notes.count === 0;
  };
  const field = element('textarea.note', {rows: 2, placeholder: 'Your note on this step', 'aria-label': 'Your note on this step', value: notes.of(step),
    oninput: () => { notes.set(step, field.value); refresh(); }});
  refresh();
  return element('div.own', {}, field, element('div.chips', {}, save, load, file), warning, said);
}
