// The explorer: sends the state of the controls and shows the answer. It knows no system and computes nothing.
"use strict";
{
  const { all, element, make } = Elements;
  // The state in the address, except for window and cursor, which the clock has. `a` is what is compared with.
  let state = { system: "", recording: "", settings: {}, a: null, how: "over" };
  let [sources, largest, controls, disabled, windows] = [[], 0, [], new Map(), {}];
  const clock = new Clock(element("clock"), () => { written(); if (looked !== seen()) ask(); });
  const seen = () => JSON.stringify(clock.window);
  let looked = "null"; // in the last question

  function show(answer) {
    disabled = new Map(answer.disabled);
    Controls.disable(disabled);
    Answer.show(answer, answer.changed ? state.how : "alone", { clock, zoomed, gives });
  }

  // If an error names an option, its control is highlighted where the page has it.
  function complain(sentence) {
    element("alert").textContent = sentence;
    const asked = new Set([...sentence.matchAll(/--([a-z][a-z-]*)/g)].map(([, name]) => name));
    let first = null;
    // A control takes effect at once, a field of the files when they are opened again.
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
      // A recording opened in the meantime has its own answer.
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

  // A zoomed figure without a time axis requests its points for that range.
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
  const address = () => Session.write(state, clock, source(state.system));
  const read = (hash) => Session.read(hash, source);

  // --- what was before can be had again
  const [past, future] = [[], []];
  let [turned, when] = ["", 0];
  // Called before a change. One movement of a control counts as one change.
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

  // Shows an earlier state.
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
    const { [name]: _, ...others } = state.settings;
    state.settings = value === undefined ? others : { ...others, [name]: value };
    written();
    ask();
  }

  // Sets controls and comparison to those of a state.
  function take({ system, recording, settings: given, a, how }) {
    // Settings that this recording does not accept are dropped.
    const can = ([name, value]) => controls.some((it) => it.name === name && Controls.takes(it, value));
    const settings = Object.fromEntries(Object.entries(given).filter(can));
    const focused = document.activeElement?.id;
    state = { system, recording, settings, a, how };
    Controls.build(element("controls"), controls, settings, change, () => asking);
    // Until the answer arrives, the same controls as before stay disabled.
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
    Answer.clear();
    windows = {};
    // Another recording has its own time, unless the address states a window.
    [clock.span, clock.window, clock.cursor] = [null, wanted.window ?? null, wanted.cursor ?? null];
    if (!reply) {
      [state, controls] = [{ ...state, recording: "", a: null }, []];
      clock.see([]);
      element("controls").replaceChildren();
      return written();
    }
    [controls, disabled] = [reply.controls, new Map()];
    element("downloads").replaceChildren(...reply.downloads.map((name) => giver(name, name)));
    element("give").hidden = false;
    Answer.taken(reply);
    Answer.findings(reply.findings);
    if (reply.files) {
      const bundled = element("bundled");
      const isKnown = [...bundled.options].some(({ value }) => value === reply.recording);
      if (!isKnown) bundled.prepend(make("option", { value: reply.recording, textContent: reply.files }));
    }
    element("bundled").value = reply.recording;
    askForFiles(false);
    take({ ...wanted, recording: reply.recording });
  }

  // --- recordings
  const askForFiles = (does) => { for (const id of ["any", "files", "upload"]) element(id).hidden = !does; };
  // The sources of a system; those of the first one by default.
  const source = (system = sources[0]?.system) => sources.find((source) => source.system === system);

  // Offers what can be opened of a system.
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

  // The last requested recording is opened, however long another takes; until then nothing else can be changed.
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
      // Offers to choose the files again.
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
    if (opening || !fits([...files.values()])) return;
    remember();
    open(`api/open/${state.system}`, files, state);
  });
  const fits = (files) => files.reduce((sum, { size = 0 }) => sum + size, 0) <= largest
    || complain(`more than ${largest >> 20} MiB at once: replay, on the command line, takes more`);
  // Files of unknown kind; those that a recording still lacks are added to them.
  let dropped = [];
  async function drop(files) {
    if (opening || !files.length || !fits(files)) return;
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

  // A button that downloads a file of this session.
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
  // A stream offers no downloads.
  const gives = ({ id, title }) => (sources.length ? ["svg", "csv"] : []).map((ending) =>
    giver(`figure-${id}.${ending}`, ending.toUpperCase(), `${title} as ${ending.toUpperCase()}`));

  if (matchMedia("(max-width: 800px)").matches) element("settings").open = false;
  fetch("api/sources").then((response) => response.json()).then((reply) => {
    if (reply.live) return follow(reply.live, { show, complain });
    ({ sources, largest } = reply);
    element("system").replaceChildren(...sources.map((source) =>
      make("option", { value: source.system, textContent: `${source.system}: ${source.title}` })));
    restore(read(location.hash));
    Drop.listen(drop, complain);
    addEventListener("hashchange", () => { if (location.hash.slice(1) !== address() && !opening) { remember(); restore(read(location.hash)); } });
  }).catch((error) => complain(`the program does not answer (${error}): is it still running?`));
}
