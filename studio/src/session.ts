// An open document in this page: what editors share.

import * as api from "./api";

export interface Editor<View> {
  /** The drawing. */
  stage: HTMLElement;
  /** What stands beside it, above what all editors have. */
  panel: HTMLElement;
  /** Shows the document as it is now. */
  show(doc: api.Doc<View>): void;
  /** Lets go of what is selected. */
  clear?(): void;
  /** Lets go of what it holds. */
  close(): void;
}

/** True for a command that draws from a seed. */
function draws(command: unknown): boolean {
  return typeof command === "object" && command !== null && "seed" in command;
}

/** A document, its commands, and who is told of changes. */
export class Session<View = never> {
  doc: api.Doc<View>;
  seed = 1;
  busy = false;
  /** What is worked on, here or from another tab. */
  job: api.Job | null;
  /** Why the last command was refused. */
  failure = "";
  private listeners: (() => void)[] = [];
  private watchers: (() => void)[] = [];
  private say: (text: string, kind: "note" | "error") => void;
  private wish: { commands: unknown[]; show: (view: View) => void } | null = null;
  private asking = false;
  /** The commands that drew last, and the revision that they made. */
  private drawn: { commands: unknown[]; revision: number } | null = null;
  private pending: (() => unknown[])[] = [];

  constructor(doc: api.Doc<View>, say: (text: string, kind: "note" | "error") => void) {
    this.doc = doc;
    this.say = say;
    this.job = doc.job;
  }

  onChange(listener: () => void) {
    this.listeners.push(listener);
  }

  /** Told when work begins, goes on and ends, and after every change. */
  onWork(watcher: () => void) {
    this.watchers.push(watcher);
  }

  private tell() {
    for (const listener of this.listeners) listener();
    this.watch();
  }

  /** Draws again what only the page knows. */
  redraw() {
    this.tell();
  }

  private watch() {
    for (const watcher of this.watchers) watcher();
  }

  private take(doc: api.Doc<unknown>) {
    this.doc = doc as api.Doc<View>;
    this.job = doc.job;
    this.tell();
  }

  /** Stops what is worked on, whoever began it. */
  async stop() {
    const job = this.job;
    if (job) await this.calmly(async () => void (await api.stop(job.id)));
  }

  /** Asks the server about the document. */
  async ask<T>(question: unknown): Promise<T | null> {
    try {
      return await api.question<T>(this.doc.id, question);
    } catch (error) {
      this.say(error instanceof Error ? error.message : String(error), "error");
      return null;
    }
  }

  /** Shows what commands would make of the document, without doing them. While the server works only the last wish waits, and
   * nothing is shown once the document has changed. */
  async preview(commands: unknown[], show: (view: View) => void) {
    this.wish = { commands, show };
    if (this.asking) return;
    this.asking = true;
    try {
      while (this.wish) {
        const { commands: wanted, show: shown } = this.wish;
        this.wish = null;
        const { revision } = this.doc;
        const { view } = await api.question<{ view: View }>(this.doc.id, { preview: wanted });
        if (!this.busy && revision === this.doc.revision) shown(view);
      }
    } catch {
      // What cannot be done is told when it is done, not while it is dragged.
      this.wish = null;
    } finally {
      this.asking = false;
    }
  }

  /** Tells the user something. */
  note(text: string) {
    this.say(text, "note");
  }

  /** Does commands, made when their turn comes: an edit that waits sees what the one before came to. */
  async run(commands: () => unknown[]): Promise<void> {
    this.wish = null;
    this.pending.push(commands);
    if (this.busy) return;
    this.busy = true;
    this.failure = "";
    this.watch();
    const working = (job: api.Job) => {
      this.job = job;
      this.watch();
    };
    try {
      while (this.pending.length > 0) {
        // Of several that wait, each is done: none is lost while the server works.
        const next = this.pending.shift()!();
        if (next.length > 0) {
          this.take(await api.edit(this.doc as api.Doc, next, working));
          if (next.some(draws)) this.drawn = { commands: next, revision: this.doc.revision };
          this.say(this.doc.warnings.join("; "), "note");
        }
      }
    } catch (error) {
      this.pending = [];
      await this.refused(error);
    } finally {
      this.busy = false;
      this.job = null;
      this.watch();
    }
  }

  /** True if the last thing done drew from the seed. */
  get canDrawAnew(): boolean {
    return !this.busy && this.drawn?.revision === this.doc.revision;
  }

  /** Does the last thing once more with the next seed, in place of what it drew. */
  async anew() {
    const last = this.drawn;
    if (!last || !this.canDrawAnew) return;
    this.seed += 1;
    const { seed } = this;
    await this.undo();
    await this.run(() => last.commands.map((c) => (draws(c) ? { ...(c as object), seed } : c)));
  }

  async undo() {
    await this.calmly(async () => this.take(await api.undo(this.doc as api.Doc)));
  }

  async redo() {
    await this.calmly(async () => this.take(await api.redo(this.doc as api.Doc)));
  }

  /** Goes back or forward to the moment after so many edits. */
  async to(count: number) {
    if (this.busy) return;
    const done = () => this.doc.log.filter((l) => l.done).length;
    await this.calmly(async () => {
      while (done() !== count) {
        const [before, back] = [done(), done() > count];
        this.take(await (back ? api.undo : api.redo)(this.doc as api.Doc));
        if (done() === before) return;
      }
    });
  }

  async save() {
    await this.calmly(async () => {
      let done: { file: string; script: string };
      try {
        done = await api.save(this.doc.id, false);
      } catch (error) {
        const conflict = error instanceof api.Refused && error.status === 409;
        if (!conflict || !confirm(`${error.message}\n\nReplace it?`)) throw error;
        done = await api.save(this.doc.id, true);
      }
      this.say(`Saved ${done.file}, and its commands as ${done.script}`, "note");
      await this.refresh(true);
    });
  }

  /** Another tab may have changed it. */
  async refresh(always = false) {
    if (this.busy) return;
    if (!always) {
      // The list is short; a city is not.
      const all = await api.listing();
      const own = all.documents.find((d) => d.id === this.doc.id);
      if (this.busy) return;
      if (own && JSON.stringify(own.job) !== JSON.stringify(this.job)) {
        this.job = own.job;
        this.watch();
      }
      if (own?.revision === this.doc.revision && own.unsaved === this.doc.unsaved) return;
    }
    const doc = await api.get(this.doc.id, this.doc as api.Doc);
    if (!this.busy) this.take(doc);
  }

  async calmly(work: () => Promise<void>) {
    try {
      await work();
    } catch (error) {
      await this.refused(error);
    }
  }

  private async refused(error: unknown) {
    this.failure = error instanceof Error ? error.message : String(error);
    this.say(this.failure, "error");
    if (error instanceof api.Refused && error.status === 409) {
      this.busy = false;
      await this.refresh(true);
    } else {
      // What was typed and refused goes back to what is.
      this.tell();
    }
  }
}
