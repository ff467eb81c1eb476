// The server's answers, as src/studio/mod.rs describes them.

export interface Logged {
  said: string;
  commands: unknown[];
  done: boolean;
}

export interface Summary {
  id: string;
  kind: "house" | "completion" | "grammar" | "city";
  name: string;
  revision: number;
  unsaved: boolean;
}

export interface Doc<View = unknown> extends Summary {
  undo: boolean;
  redo: boolean;
  file: string;
  formats: string[];
  warnings: string[];
  log: Logged[];
  milliseconds: number;
  view: View;
}

export interface Example {
  id: string;
  kind: Summary["kind"];
  title: string;
  about: string;
}

export interface Listing {
  version: string;
  readOnly: boolean;
  documents: Summary[];
  examples: Example[];
}

/** An answer that says no. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    message: string,
  ) {
    super(message);
  }
}

const token = new URLSearchParams(location.hash.slice(1)).get("token") ?? "";

async function ask(path: string, body?: unknown): Promise<Response> {
  const headers: Record<string, string> = { "x-edifice-token": token };
  if (body !== undefined) headers["content-type"] = "application/json";
  let response: Response;
  try {
    response = await fetch("/api" + path, {
      method: body === undefined ? "GET" : "POST",
      headers,
      body: body === undefined ? undefined : JSON.stringify(body),
    });
  } catch {
    throw new Refused(0, "The studio has ended. Start it again to go on.");
  }
  if (response.ok) return response;
  const text = await response.text();
  let message = text;
  try {
    message = JSON.parse(text).error ?? text;
  } catch {
    // Refusals before routing are plain text.
  }
  if (response.status === 401) message = "This page was opened without its token: use the address that the command printed.";
  throw new Refused(response.status, message || `status ${response.status}`);
}

async function json<T>(path: string, body?: unknown): Promise<T> {
  return (await ask(path, body)).json();
}

export const listing = () => json<Listing>("/documents");
export const openExample = (example: string) => json<Doc>("/documents", { example });
export const get = (id: string) => json<Doc>(`/documents/${id}`);
export const edit = (id: string, commands: unknown[], revision: number) =>
  json<Doc>(`/documents/${id}/edit`, { commands, revision });
export const undo = (id: string) => json<Doc>(`/documents/${id}/undo`, {});
export const redo = (id: string) => json<Doc>(`/documents/${id}/redo`, {});
export const save = (id: string, overwrite: boolean) =>
  json<{ file: string; script: string }>(`/documents/${id}/save`, { overwrite });
export const script = async (id: string) => (await ask(`/documents/${id}/script`)).blob();
export const exported = async (id: string, format: string) =>
  (await ask(`/documents/${id}/export/${format}`)).blob();
