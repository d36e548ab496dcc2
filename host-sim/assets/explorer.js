// The explorer: sends how the controls stand, shows what comes back. It knows no system and computes nothing.
"use strict";

{
  const element = (id) => document.getElementById(id);
  const make = (tag, properties = {}, ...children) => {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
  };
  const places = new Map();
  let [sources, session, settings, windows] = [[], null, {}, {}];

  // --- what comes back

  function show(answer) {
    element("facts").replaceChildren(...answer.facts.map(([name, value]) =>
      make("div", {}, make("dt", { textContent: name }), make("dd", { textContent: value }))));
    element("warnings").replaceChildren(...answer.warnings.map((text) => make("li", { textContent: text })));
    element("findings").replaceChildren(...answer.findings.map(([fault, about, text]) =>
      make("div", { className: fault ? "fault" : "" }, make("dt", { textContent: about }), make("dd", { textContent: text }))));
    element("check").hidden = !answer.findings.length;
    disable(new Map(answer.disabled));
    for (const said of ["command", "firmware"]) element(said).textContent = answer[said];
    element("again").hidden = !answer.command;
    const known = new Set(answer.figures.map((figure) => figure.id));
    for (const [id, { place }] of places) {
      if (known.has(id)) continue;
      Figures.forget(place);
      place.remove();
      places.delete(id);
    }
    // All places first: each is then drawn as wide as it stays.
    for (const { id, title } of answer.figures) {
      if (places.has(id)) continue;
      const place = make("figure", { id: `figure-${id}` }, make("h3", { textContent: title }));
      places.set(id, { place, caption: make("figcaption"), text: "" });
      element("figures").append(place);
    }
    for (const figure of answer.figures) {
      const text = JSON.stringify(figure);
      const entry = places.get(figure.id);
      if (entry.text === text) continue;
      entry.text = text;
      Figures.draw(entry.place, figure, zoomed);
      entry.caption.textContent = figure.caption;
      entry.place.append(entry.caption);
    }
  }

  // What a refusal asks for by the name of an option is where the page asks for it, and is shown there.
  function complain(sentence) {
    element("alert").textContent = sentence;
    const asked = new Set([...sentence.matchAll(/--([a-z][a-z-]*)/g)].map(([, name]) => name));
    let first = null;
    // A control answers at once, a field of the files when they are opened again.
    for (const part of document.querySelectorAll("[data-option], [data-setting]")) {
      const is = asked.has(part.dataset.setting ?? part.dataset.option) && !part.classList.contains("disabled");
      part.classList.toggle("asked", is);
      if (is && (!first || (part.dataset.setting && !first.dataset.setting))) first = part;
    }
    first?.scrollIntoView({ block: "nearest" });
  }

  async function post(path, body) {
    try {
      const response = await fetch(path, { method: "POST", body });
      if (response.ok) return await response.json();
      complain(await response.text());
      // Others were opened since, or the program began anew.
      if (response.status === 410 && element("bundled").value) choose();
    } catch {
      complain("the program no longer answers: is it still running?");
    }
  }

  // --- one request at a time; what happens meanwhile is asked for afterwards

  let [asking, again] = [false, false];
  async function ask() {
    if (session === null) return;
    if (asking) { again = true; return; }
    complain("");
    asking = true;
    document.body.dataset.asking = "yes";
    const [began, asked] = [performance.now(), session];
    try {
      const answer = await post(`api/answer/${session}`, JSON.stringify({ settings, windows }));
      // What was opened meanwhile has an answer of its own.
      if (answer && asked === session) {
        show(answer);
        document.body.dataset.milliseconds = String(Math.round(performance.now() - began));
        document.body.dataset.answers = String(Number(document.body.dataset.answers ?? 0) + 1);
      }
    } finally {
      asking = false;
      delete document.body.dataset.asking;
    }
    if (again) { again = false; ask(); }
  }

  // A figure that is zoomed in gets its points from there.
  function zoomed(id, range) {
    if (JSON.stringify(windows[id] ?? null) === JSON.stringify(range)) return;
    if (range) windows[id] = range; else delete windows[id];
    ask();
  }

  // --- controls

  function slider(control) {
    const log = control.logarithmic;
    const [inward, outward] = log ? [Math.log10, (v) => 10 ** v] : [Number, Number];
    const output = make("output");
    const range = make("input", { type: "range", id: `control-${control.name}`, step: control.step });
    [range.min, range.max, range.value] = [control.min, control.max, control.value].map((v) => String(inward(v)));
    const tell = () => {
      const value = outward(Number(range.value));
      output.textContent = `${Number(value.toPrecision(3))} ${control.unit}`;
      range.setAttribute("aria-valuetext", output.textContent);
      return Math.min(Math.max(value, control.min), control.max);
    };
    tell();
    range.addEventListener("input", () => { settings[control.name] = tell(); ask(); });
    // A slider need not move to be answered.
    const take = make("button", { type: "button", className: "take", textContent: "take this value" });
    take.addEventListener("click", () => range.dispatchEvent(new Event("input")));
    const parts = [make("label", { htmlFor: `control-${control.name}` }, output, control.label), range, take];
    if (control.playable) parts.push(player(range));
    return parts;
  }

  function player(range) {
    const button = make("button", { type: "button", textContent: "play" });
    let timer = null;
    button.addEventListener("click", () => {
      if (timer) { clearInterval(timer); timer = null; button.textContent = "play"; return; }
      button.textContent = "pause";
      // The last step may end below the maximum: the end is where nothing moves any more.
      const step = () => {
        const before = range.value;
        range.stepUp();
        return range.value !== before;
      };
      if (!step()) range.value = range.min;
      timer = setInterval(() => {
        if (asking && range.isConnected) return;
        if (!range.isConnected || !step()) { button.click(); return; }
        range.dispatchEvent(new Event("input"));
      }, 120);
    });
    return button;
  }

  function choice(control) {
    const select = make("select", { id: `control-${control.name}` }, ...control.options.map(([value, text]) =>
      make("option", { value, textContent: text, selected: value === control.value })));
    select.addEventListener("input", () => { settings[control.name] = select.value; ask(); });
    return [make("label", { htmlFor: `control-${control.name}`, textContent: control.label }), select];
  }

  function toggle(control) {
    const box = make("input", { type: "checkbox", id: `control-${control.name}`, checked: control.value });
    box.addEventListener("input", () => { settings[control.name] = box.checked; ask(); });
    return [make("label", { className: "switch" }, box, control.label)];
  }

  function set(control) {
    const chosen = new Set();
    const boxes = control.options.map(([value, text]) => {
      const box = make("input", { type: "checkbox", id: `control-${control.name}-${value}` });
      box.addEventListener("input", () => {
        if (box.checked) chosen.add(value); else chosen.delete(value);
        settings[control.name] = [...chosen];
        ask();
      });
      return make("label", { className: "switch" }, box, text);
    });
    return [make("fieldset", { id: `control-${control.name}` }, make("legend", { textContent: control.label }), ...boxes)];
  }

  function text(control) {
    const field = make("input", { type: "text", id: `control-${control.name}`, placeholder: control.form });
    field.addEventListener("change", () => {
      if (field.value.trim()) settings[control.name] = field.value.trim(); else delete settings[control.name];
      ask();
    });
    return [make("label", { htmlFor: `control-${control.name}`, textContent: control.label }), field];
  }

  // What has no effect as the others stand cannot be turned, and says why.
  function disable(reasons) {
    for (const part of document.querySelectorAll("[data-setting]")) {
      const reason = reasons.get(part.dataset.setting);
      part.classList.toggle("disabled", reason !== undefined);
      part.title = reason ?? "";
      for (const input of part.querySelectorAll("input, select, button")) input.disabled = reason !== undefined;
    }
  }

  function opened(reply) {
    if (!reply) return;
    [session, settings, windows] = [reply.session, {}, {}];
    for (const shown of ["facts", "warnings", "findings", "figures"]) element(shown).replaceChildren();
    element("check").hidden = element("again").hidden = true;
    for (const { place } of places.values()) Figures.forget(place);
    places.clear();
    const kinds = { slider, choice, switch: toggle, set, text };
    const part = (control) => {
      const made = make("div", {}, ...kinds[control.kind](control));
      made.dataset.setting = control.name;
      return made;
    };
    const reset = make("button", { type: "button", textContent: "all as at first" });
    reset.addEventListener("click", () => opened(reply));
    element("controls").replaceChildren(...reply.controls.map(part), reset);
    ask();
  }

  // --- recordings

  const system = () => sources.find((source) => source.system === element("system").value);

  function offer() {
    const source = system();
    element("bundled").replaceChildren(
      ...source.bundled.map(([value, text]) => make("option", { value, textContent: text })),
      make("option", { value: "", textContent: "your own files …" }));
    const option = (name, ...parts) => {
      const made = make("div", {}, ...parts);
      made.dataset.option = name;
      return made;
    };
    element("files").replaceChildren(...source.files.map((file) => option(file.name,
      make("label", { htmlFor: `file-${file.name}`, textContent: `${file.label}${file.required ? "" : " (optional)"}` }),
      make("input", { type: "file", id: `file-${file.name}`, name: file.name, required: file.required, multiple: file.several }),
    )), ...(source.files.some((file) => file.imported) ? source.reading : []).map(([name, help]) => option(name,
      make("label", { htmlFor: `reading-${name}`, textContent: help }),
      make("input", { type: "text", id: `reading-${name}`, name }),
    )));
    location.hash = source.system;
    choose();
  }

  async function choose() {
    const own = element("bundled").value === "";
    element("files").hidden = element("upload").hidden = !own;
    if (!own) await open(`api/open/${system().system}/${element("bundled").value}`);
  }

  // The last that was asked for is opened, however long another takes.
  let openings = 0;
  async function open(path, body) {
    const opening = ++openings;
    complain("");
    element("warnings").replaceChildren(make("li", { textContent: "reading …" }));
    const reply = await post(path, body);
    if (opening !== openings) return;
    if (!reply) element("warnings").replaceChildren();
    opened(reply);
  }

  element("system").addEventListener("input", offer);
  element("bundled").addEventListener("input", choose);
  element("controls").addEventListener("submit", (event) => event.preventDefault());
  element("open").addEventListener("submit", async (event) => {
    event.preventDefault();
    const files = new FormData(element("open"));
    for (const [name, file] of [...files]) if (file instanceof File && !file.size && !file.name) files.delete(name);
    open(`api/open/${system().system}`, files);
  });

  function live() {
    const socket = new WebSocket(`ws://${location.host}/live`);
    document.querySelector(".controls").hidden = true;
    // Five times a second would be too much to be read out.
    element("facts").ariaLive = "off";
    document.querySelector(".explorer").style.gridTemplateColumns = "minmax(0, 1fr)";
    socket.addEventListener("message", ({ data }) => { show(JSON.parse(data)); socket.send("next"); });
    socket.addEventListener("close", () => complain("the stream has ended"));
  }

  fetch("api/sources").then((response) => response.json()).then((reply) => {
    if (reply.live) return live();
    sources = reply.sources;
    element("system").replaceChildren(...sources.map((source) =>
      make("option", { value: source.system, textContent: `${source.system}: ${source.title}` })));
    const wanted = location.hash.slice(1);
    if (sources.some((source) => source.system === wanted)) element("system").value = wanted;
    offer();
    addEventListener("hashchange", () => {
      const wanted = location.hash.slice(1);
      if (wanted === element("system").value || !sources.some((source) => source.system === wanted)) return;
      element("system").value = wanted;
      offer();
    });
  }).catch(() => complain("the program does not answer: is it still running?"));
}
