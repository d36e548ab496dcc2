// The explorer: sends how the controls stand, shows what comes back. It knows no system and computes nothing.
"use strict";

{
  const { all, make } = Elements;
  /** @type {(id: string) => any} */
  const element = (id) => document.getElementById(id);
  const places = new Map();
  // What the address holds, but for window and cursor, which the clock has. `a` is what is compared with.
  let state = { system: "", recording: "", settings: {}, a: null, how: "over" };
  let [sources, controls, disabled, windows] = [[], [], new Map(), {}];

  const clock = new Clock(element("clock"), () => { written(); if (looked !== seen()) ask(); });
  // The window of the last question.
  let looked = "null";
  const seen = () => JSON.stringify(clock.window);

  // --- what comes back

  function show(answer) {
    tell("facts", answer.facts);
    element("warnings").replaceChildren(...answer.warnings.map((text) => make("li", { textContent: text })));
    showFindings(answer.findings);
    disabled = new Map(answer.disabled);
    Controls.disable(disabled);
    for (const said of ["command", "firmware"]) element(said).textContent = answer[said];
    element("again").hidden = !answer.command;
    element("differences").hidden = !answer.changed?.length;
    const differs = answer.figures.some(({ data }) => state.how === "difference" || data.some(({ name }) => name.startsWith("A: ")));
    element("same").hidden = !answer.changed || differs;
    element("changed").tBodies[0].replaceChildren(...(answer.changed ?? []).map(([name, a, b]) => make("tr", {},
      make("th", { scope: "row", textContent: name }), make("td", { textContent: a }), make("td", { textContent: b }))));
    // A figure of differences is another one than that of what differs.
    const how = answer.changed ? state.how : "alone";
    const kind = ({ id, equal, seconds }) => JSON.stringify([id, equal, seconds, how === "difference"]);
    const known = new Set(answer.figures.map(kind));
    for (const [key, { place }] of places) {
      if (known.has(key)) continue;
      Figures.forget(place);
      place.remove();
      places.delete(key);
    }
    clock.see(answer.figures);
    for (const table of answer.tables) tabulate(table, answer.changed ? ", of B" : "");
    // All places first: each is then drawn as wide as it stays.
    for (const figure of answer.figures) {
      if (places.has(kind(figure))) continue;
      const place = make("figure", { id: `figure-${figure.id}` }, make("h3", { textContent: figure.title }));
      places.set(kind(figure), { place, caption: make("figcaption"), text: "" });
      element("figures").append(place);
    }
    for (const figure of answer.figures) {
      const text = JSON.stringify(figure);
      const entry = places.get(kind(figure));
      if (entry.text === text) continue;
      entry.text = text;
      Figures.draw(entry.place, figure, { clock, zoomed });
      entry.caption.replaceChildren(figure.caption, ...(sources.length ? ["svg", "csv"] : []).map((ending) =>
        giver(`figure-${figure.id}.${ending}`, ending.toUpperCase(), `${figure.title} as ${ending.toUpperCase()}`)));
      entry.place.append(entry.caption);
    }
  }

  // Names, and what is told of each.
  const tell = (id, told) => element(id).replaceChildren(...told.map(([name, text, className = ""]) =>
    make("div", { className }, make("dt", { textContent: name }), make("dd", { textContent: text }))));

  function showFindings(findings) {
    tell("findings", findings.map(([fault, about, text]) => [about, text, fault ? "fault" : ""]));
    element("check").hidden = !findings.length && !element("taken").children.length;
  }

  // What files that were dropped were taken for.
  function showTaken({ taken = [], left = [], others = [] }) {
    const unused = left.length ? [["not used", left.join(", ")]] : [];
    const also = others.length ? [["could be of", `${others.join(", ")} as well: choose the system first`]] : [];
    tell("taken", [...taken, ...unused, ...also]);
    if (taken.length) element("check").open = true;
  }

  // Rows are made for who looks at them.
  function tabulate(table, whose) {
    const id = `table-${table.id}`;
    if (!element(id)) {
      const box = make("div", { className: "scroll rows", tabIndex: 0, role: "region", ariaLabel: table.title });
      element("tables").append(make("details", { id }, make("summary"), make("p", { className: "soft" }), box));
      element(id).addEventListener("toggle", () => element(id).fill());
    }
    const [summary, caption, box] = element(id).children;
    [summary.textContent, caption.textContent] = [table.title + whose, table.caption];
    const text = JSON.stringify(table);
    element(id).fill = () => {
      if (!element(id).open || box.text === text) return;
      box.text = text;
      const row = (tag, cells) => make("tr", {}, ...cells.map((textContent) => make(tag, { textContent })));
      const rows = table.rows.map((cells) => row("td", cells));
      table.times?.forEach((time, place) => { rows[place].dataset.time = time; });
      box.replaceChildren(make("table", {}, make("thead", {}, row("th", table.header)), make("tbody", {}, ...rows)));
      clock.follow(box.firstChild);
    };
    element(id).fill();
  }

  // What a refusal asks for by the name of an option is where the page asks for it, and is shown there.
  function complain(sentence) {
    element("alert").textContent = sentence;
    const asked = new Set([...sentence.matchAll(/--([a-z][a-z-]*)/g)].map(([, name]) => name));
    let first = null;
    // A control answers at once, a field of the files when they are opened again.
    for (const part of all("[data-option], [data-setting]")) {
      const is = asked.has(part.dataset.setting ?? part.dataset.option) && !part.classList.contains("disabled");
      part.classList.toggle("asked", is);
      if (is && (!first || (part.dataset.setting && !first.dataset.setting))) first = part;
    }
    if (first?.dataset.setting) element("settings").open = true;
    first?.scrollIntoView({ block: "nearest" });
  }

  async function request(path, body, read) {
    try {
      const response = await fetch(path, { method: "POST", body });
      if (response.ok) return await read(response);
      complain((await response.text()) || `${path}: ${response.status}`);
    } catch {
      complain("the program no longer answers: is it still running?");
    }
    return null;
  }
  const post = (path, body) => request(path, body, (response) => response.json());

  // --- one request at a time; what happens meanwhile is asked for afterwards

  const question = () => JSON.stringify({
    settings: state.settings, windows, window: clock.window, a: state.a && { ...state.a, how: state.how },
  });
  const path = (what, { system, recording }) => `api/${what}/${system}/${encodeURIComponent(recording)}`;
  const of = (what) => path(what, state);

  let [asking, again] = [false, false];
  async function ask() {
    if (!state.recording) return;
    if (asking) { again = true; return; }
    complain("");
    asking = true;
    document.body.dataset.asking = "yes";
    const [began, asked] = [performance.now(), of("answer")];
    looked = seen();
    try {
      const answer = await post(asked, question());
      // What was opened meanwhile has an answer of its own.
      if (answer && asked === of("answer")) {
        show(answer);
        document.body.dataset.milliseconds = String(Math.round(performance.now() - began));
        document.body.dataset.answers = String(Number(document.body.dataset.answers ?? 0) + 1);
      }
    } finally {
      asking = false;
      delete document.body.dataset.asking;
      if (again) { again = false; ask(); }
    }
  }

  // A figure that is zoomed in and has no time gets its points from there.
  function zoomed(id, range) {
    if (JSON.stringify(windows[id] ?? null) === JSON.stringify(range)) return;
    if (range) windows[id] = range; else delete windows[id];
    ask();
  }

  // --- the address holds all of it

  let writing = null;
  function written() {
    clearTimeout(writing);
    writing = setTimeout(() => history.replaceState(null, "", `#${address()}`), 150);
  }

  function address() {
    const query = new URLSearchParams();
    const say = (name, value) => { if (value) query.set(name, value); };
    if (!state.recording) return state.system;
    say("recording", state.recording === source(state.system)?.bundled[0][0] ? "" : state.recording);
    say("settings", Object.keys(state.settings).length && JSON.stringify(state.settings));
    say("a", state.a && JSON.stringify(state.a));
    say("how", state.a && state.how);
    say("window", clock.window?.join());
    say("cursor", clock.cursor !== null && String(Number(clock.cursor.toFixed(6))));
    return String(query) ? `${state.system}?${query}` : state.system;
  }

  // What an address says; what it does not say is at first.
  function read(hash) {
    const [system, query] = hash.replace(/^#/, "").split(/\?(.*)/s);
    const found = source(system) ?? sources[0];
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
  }

  // --- what was before can be had again

  const [past, future] = [[], []];
  let [turned, when] = ["", 0];
  // Before something changes. One movement of a control is one change.
  function remember(what = "") {
    if (!state.recording) return;
    const [now, before] = [performance.now(), JSON.stringify(state)];
    if (past[past.length - 1] !== before && (!what || what !== turned || now - when > 1000)) past.push(before);
    [turned, when] = [what, now];
    future.length = 0;
    offerHistory();
  }

  const offerHistory = () => { element("undo").disabled = !past.length; element("redo").disabled = !future.length; };

  function travel(from, to) {
    if (!from.length || opening) return;
    if (state.recording) to.push(JSON.stringify(state));
    turned = "";
    restore(JSON.parse(from.pop()));
    offerHistory();
  }

  // Shows a state that was.
  function restore(wanted) {
    const same = wanted.system === state.system && wanted.recording === state.recording;
    if (wanted.system !== state.system) offer(wanted.system);
    if (!same) { named(wanted); return; }
    take(wanted);
    if ("window" in wanted) clock.look(wanted.window);
    if ("window" in wanted && wanted.cursor !== null) clock.move(wanted.cursor);
  }

  // --- controls

  function change(name, value) {
    if (opening) return;
    remember(name);
    const settings = { ...state.settings };
    if (value === undefined) delete settings[name]; else settings[name] = value;
    state.settings = settings;
    written();
    ask();
  }

  // Controls and comparison as a state has them.
  function take({ system, recording, settings: given, a, how }) {
    // What cannot be set here is left out.
    const can = ([name, value]) => controls.some((it) => it.name === name && Controls.takes(it, value));
    const settings = Object.fromEntries(Object.entries(given).filter(can));
    const focused = document.activeElement?.id;
    state = { system, recording, settings, a, how };
    Controls.build(element("controls"), controls, settings, change, () => asking);
    // Until the answer comes, as they were.
    Controls.disable(disabled);
    if (focused?.startsWith("control-")) element(focused)?.focus();
    for (const id of ["how", "swap", "end"]) element(id).hidden = !a;
    if (a) element("compare").open = true;
    element("how").value = how;
    element("keep").textContent = a ? "store this as A instead" : "store this as A";
    const named = [...element("bundled").options].find(({ value }) => value === a?.recording)?.textContent ?? a?.recording;
    const ofA = Object.entries(a?.settings ?? {}).map(([name, value]) => `${name} ${value}`).join(", ");
    element("kept").textContent = a ? `A: ${named}; ${ofA || "all as at first"}`
      : "Store one as A, then turn a control or choose another recording: both are drawn, and what changed is listed.";
    written();
    ask();
  }

  function opened(reply, wanted) {
    for (const shown of ["facts", "warnings", "findings", "taken", "figures", "tables"]) element(shown).replaceChildren();
    for (const hidden of ["check", "again", "give"]) element(hidden).hidden = true;
    element("differences").hidden = true;
    for (const { place } of places.values()) Figures.forget(place);
    places.clear();
    windows = {};
    // Another recording has another time, unless an address says which.
    [clock.span, clock.window, clock.cursor] = [null, wanted.window ?? null, wanted.cursor ?? null];
    if (!reply) {
      state = { ...state, recording: "", a: null };
      controls = [];
      clock.see([]);
      element("controls").replaceChildren();
      written();
      return;
    }
    [controls, disabled] = [reply.controls, new Map()];
    element("downloads").replaceChildren(...reply.downloads.map((name) => giver(name, name)));
    element("give").hidden = false;
    showTaken(reply);
    showFindings(reply.findings);
    if (reply.files) {
      const bundled = element("bundled");
      const known = [...bundled.options].some(({ value }) => value === reply.recording);
      if (!known) bundled.prepend(make("option", { value: reply.recording, textContent: reply.files }));
    }
    element("bundled").value = reply.recording;
    askForFiles(false);
    take({ ...wanted, recording: reply.recording });
  }

  // --- recordings

  const askForFiles = (does) => { for (const id of ["any", "files", "upload"]) element(id).hidden = !does; };

  const source = (system) => sources.find((source) => source.system === system);

  // What can be opened of a system.
  function offer(name) {
    const { system, bundled, files, reading } = source(name);
    element("system").value = system;
    element("bundled").replaceChildren(
      ...bundled.map(([value, text]) => make("option", { value, textContent: text })),
      make("option", { value: "", textContent: "your own files …" }));
    const option = (name, ...parts) => {
      const made = make("div", {}, ...parts);
      made.dataset.option = name;
      return made;
    };
    element("files").replaceChildren(...files.map((file) => option(file.name,
      make("label", { htmlFor: `file-${file.name}`, textContent: `${file.label}${file.required ? "" : " (optional)"}` }),
      make("input", { type: "file", id: `file-${file.name}`, name: file.name, required: file.required, multiple: file.several }),
    )), ...(files.some((file) => file.imported) ? reading : []).map(([name, help]) => option(name,
      make("label", { htmlFor: `reading-${name}`, textContent: help }),
      make("input", { type: "text", id: `reading-${name}`, name }),
    )));
  }

  // The last that was asked for is opened, however long another takes.
  // Until it is there nothing else can be changed.
  let [openings, opening] = [0, false];
  async function open(path, body, wanted) {
    const number = ++openings;
    opening = true;
    complain("");
    element("warnings").replaceChildren(make("li", { textContent: "reading …" }));
    const reply = await post(path, body);
    if (number !== openings) return;
    opening = false;
    if (!reply) {
      // Where to choose them again.
      element("bundled").value = "";
      askForFiles(true);
    }
    const system = reply?.system ?? wanted.system;
    if (system !== wanted.system) {
      offer(system);
      wanted = { ...wanted, system, settings: {}, a: null };
    }
    if (system !== state.system) state = { ...state, system, settings: {}, a: null };
    opened(reply, wanted);
  }

  const named = (wanted) => { dropped = []; return open(path("open", wanted), undefined, wanted); };

  element("system").addEventListener("input", () => {
    remember();
    const system = element("system").value;
    offer(system);
    named({ system, recording: source(system).bundled[0][0], settings: {}, a: null, how: "over" });
  });
  element("bundled").addEventListener("input", () => {
    const recording = element("bundled").value;
    askForFiles(recording === "");
    if (!recording) return;
    remember();
    named({ ...state, recording });
  });
  element("open").addEventListener("submit", (event) => {
    event.preventDefault();
    const files = new FormData(element("open"));
    for (const [name, file] of [...files]) if (file instanceof File && !file.size && !file.name) files.delete(name);
    if (opening) return;
    remember();
    open(`api/open/${state.system}`, files, state);
  });

  // Files of which nobody says what they are; those that a recording still lacks are added to them.
  let dropped = [];
  async function drop(files) {
    if (opening || !files.length) return;
    remember();
    const isAnew = (old) => !files.some(({ name, size }) => name === old.name && size === old.size);
    dropped = [...dropped.filter(isAnew), ...files];
    const body = new FormData();
    for (const file of dropped) body.append("file", file);
    await open(`api/drop/${element("system").value}`, body, state);
    if (!element("alert").textContent.includes("needed as well")) dropped = [];
  }
  for (const field of all("#any input")) {
    field.addEventListener("change", () => { drop([...field.files].filter(({ name }) => !name.startsWith("."))); field.value = ""; });
  }

  // --- undo, comparison, downloads

  element("undo").addEventListener("click", () => travel(past, future));
  element("redo").addEventListener("click", () => travel(future, past));
  addEventListener("keydown", (event) => {
    const typing = event.target instanceof Element && event.target.matches("input[type=text]");
    if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z" || typing) return;
    event.preventDefault();
    if (event.shiftKey) travel(future, past); else travel(past, future);
  });
  const put = (changed) => {
    if (opening || !state.recording) return;
    remember();
    take({ ...state, ...changed });
  };
  element("reset").addEventListener("click", () => put({ settings: {} }));
  element("controls").addEventListener("submit", (event) => event.preventDefault());
  const shown = () => ({ recording: state.recording, settings: state.settings });
  element("keep").addEventListener("click", () => put({ a: shown() }));
  element("how").addEventListener("input", () => put({ how: element("how").value }));
  element("end").addEventListener("click", () => put({ a: null }));
  element("swap").addEventListener("click", () => {
    if (opening || !state.a) return;
    remember();
    restore({ ...state, ...state.a, a: shown() });
  });
  for (const button of all(".copy")) {
    button.addEventListener("click", () => navigator.clipboard.writeText(element(button.dataset.of).textContent)
      .then(() => { button.textContent = "copied"; }));
  }

  // A button that gives a file of this session.
  function giver(file, text, label = text) {
    const button = make("button", { type: "button", className: "give", textContent: text, ariaLabel: `download ${label}` });
    button.addEventListener("click", async () => {
      complain("");
      const blob = await request(`${of("download")}/${file}`, question(), (response) => response.blob());
      if (!blob) return;
      const href = URL.createObjectURL(blob);
      make("a", { href, download: `${state.system}-${state.recording.slice(0, 16)}-${file}` }).click();
      setTimeout(() => URL.revokeObjectURL(href), 10_000);
    });
    return button;
  }

  // A stream: one picture at a time, of now or of what was, as the controls stand.
  function live({ controls: offered, settings }) {
    const socket = new WebSocket(`ws://${location.host}/live`);
    const [after, pause] = [element("after"), element("pause")];
    let [paused, busy, due, asked] = [false, true, false, null];
    state.settings = settings;
    for (const part of all(offered.length ? "#open, #compare, #settings .buttons" : ".controls, #compare")) part.hidden = true;
    element("back").hidden = false;
    // Five times a second would be too much to be read out.
    element("facts").ariaLive = "off";
    if (!offered.length) all(".explorer")[0].style.gridTemplateColumns = "minmax(0, 1fr)";
    const want = () => {
      due = busy;
      if (busy) return;
      busy = true;
      asked = paused ? Number(after.value) : null;
      socket.send(JSON.stringify({ settings: state.settings, after: asked }));
    };
    const stop = (does) => { paused = does; pause.textContent = does ? "go on" : "pause"; want(); };
    Controls.build(element("controls"), offered, settings, (name, value) => {
      const { [name]: _, ...others } = state.settings;
      state.settings = value === undefined ? others : { ...others, [name]: value };
      want();
    }, () => busy);
    socket.addEventListener("open", () => { busy = false; want(); });
    socket.addEventListener("message", ({ data }) => {
      const answer = JSON.parse(data);
      busy = false;
      if (element("alert").textContent !== (answer.refused ?? "")) complain(answer.refused ?? "");
      if (!answer.refused) {
        show(answer);
        after.max = String(answer.bytes);
        if (!paused) after.value = after.max;
        element("of").textContent = `${Math.round((100 * (asked ?? answer.bytes)) / Math.max(answer.bytes, 1))} %`;
      }
      if (due || !paused) want();
    });
    socket.addEventListener("close", () => complain("the stream has ended"));
    pause.addEventListener("click", () => stop(!paused));
    after.addEventListener("input", () => stop(true));
  }

  if (matchMedia("(max-width: 800px)").matches) element("settings").open = false;
  fetch("api/sources").then((response) => response.json()).then((reply) => {
    if (reply.live) return live(reply.live);
    sources = reply.sources;
    element("system").replaceChildren(...sources.map((source) =>
      make("option", { value: source.system, textContent: `${source.system}: ${source.title}` })));
    restore(read(location.hash));
    Drop.listen(drop);
    addEventListener("hashchange", () => { if (location.hash.slice(1) !== address() && !opening) { remember(); restore(read(location.hash)); } });
  }).catch((error) => complain(`the program does not answer (${error}): is it still running?`));
}
