// A session in an address: system, recording, settings, comparison, and the clock's window and cursor.
"use strict";
const Session = {
  // Initial values are omitted.
  write(state, { window, cursor }, source) {
    const query = new URLSearchParams();
    const say = (name, value) => { if (value) query.set(name, value); };
    if (!state.recording) return state.system;
    say("recording", state.recording === source?.bundled[0][0] ? "" : state.recording);
    say("settings", Object.keys(state.settings).length && JSON.stringify(state.settings));
    say("a", state.a && JSON.stringify(state.a));
    say("how", state.a && state.how);
    say("window", window?.join());
    say("cursor", cursor !== null && String(Number(cursor.toFixed(6))));
    return String(query) ? `${state.system}?${query}` : state.system;
  },

  // Parses an address; what it omits has its initial value. `source` returns the sources of a system, or the first.
  read(hash, source) {
    const [system, query] = hash.replace(/^#/, "").split(/\?(.*)/s);
    const found = source(system) ?? source();
    const said = new URLSearchParams(query);
    const json = (name, otherwise) => { try { return JSON.parse(said.get(name)) ?? otherwise; } catch { return otherwise; } };
    const numbers = (name) => (said.get(name) ?? "").split(",").filter(Boolean).map(Number);
    const [window, [cursor]] = [numbers("window"), numbers("cursor")];
    return {
      system: found.system,
      recording: said.get("recording") ?? found.bundled[0][0],
      settings: json("settings", {}),
      a: json("a", null),
      how: said.get("how") === "difference" ? "difference" : "over",
      window: window.length === 2 && window.every(Number.isFinite) ? window : null,
      cursor: Number.isFinite(cursor) ? cursor : null,
    };
  },
};
