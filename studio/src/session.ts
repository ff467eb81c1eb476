// An open document in this page: what editors share.

import * as api from "./api";

export interface Editor<View> {
  /** The drawing. */
  stage: HTMLElement;
  /** What stands beside it, above what all editors have. */
  panel: HTMLElement;
  /** Shows the document as it is now. */
  show(doc: api.Doc<View>): void;
  /** Lets go of what it holds. */
  close(): void;
}

/** A document, its commands, and who is told of changes. */
export class Session<View = never> {
  doc: api.Doc<View>;
  seed = 1;
  busy = false;
  private listeners: (() => void)[] = [];
  private say: (text: string, kind: "note" | "error") => void;
  private pending: (() => unknown[])[] = [];

  constructor(doc: api.Doc<View>, say: (text: string, kind: "note" | "error") => void) {
    this.doc = doc;
    this.say = say;
  }

  onChange(listener: () => void) {
    this.listeners.push(listener);
  }

  private tell() {
    for (const listener of this.listeners) listener();
  }

  private take(doc: api.Doc<unknown>) {
    this.doc = doc as api.Doc<View>;
    this.tell();
  }

  /** Does commands, made when their turn comes: an edit that waits sees what the one before came to. */
  async run(commands: () => unknown[]): Promise<void> {
    this.pending.push(commands);
    if (this.busy) return;
    this.busy = true;
    this.tell();
    try {
      while (this.pending.length > 0) {
        // Of several that wait, each is done: none is lost while the server works.
        const next = this.pending.shift()!();
        if (next.length > 0) {
          this.take(await api.edit(this.doc.id, next, this.doc.revision));
          this.say(this.doc.warnings.join("; "), "note");
        }
      }
    } catch (error) {
      this.pending = [];
      await this.refused(error);
    } finally {
      this.busy = false;
      this.tell();
    }
  }

  async undo() {
    await this.calmly(async () => this.take(await api.undo(this.doc.id)));
  }

  async redo() {
    await this.calmly(async () => this.take(await api.redo(this.doc.id)));
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
      if (own?.revision === this.doc.revision && own.unsaved === this.doc.unsaved) return;
    }
    const doc = await api.get(this.doc.id);
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
    this.say(error instanceof Error ? error.message : String(error), "error");
    if (error instanceof api.Refused && error.status === 409) {
      this.busy = false;
      await this.refresh(true);
    } else {
      this.tell();
    }
  }
}
