// The controls of settings: sliders, choices, switches. They know nothing about particular settings and report changes.
"use strict";
const Controls = (() => {
  const { all, make } = Elements;

  // Whether a control accepts a value that was set for another recording.
  function takes(control, value) {
    const offers = (value) => control.options.some(([name]) => name === value);
    const kinds = {
      slider: () => typeof value === "number" && value >= control.min && value <= control.max,
      choice: () => offers(value),
      switch: () => typeof value === "boolean",
      set: () => Array.isArray(value) && value.every(offers),
      text: () => typeof value === "string",
    };
    return kinds[control.kind]();
  }

  function slider(control, given, change, busy) {
    const log = control.logarithmic;
    // Rounded to the digits that are shown.
    const [inward, outward] = log ? [Math.log10, (v) => Number((10 ** v).toPrecision(3))] : [Number, Number];
    const output = make("output");
    const range = make("input", { type: "range", id: `control-${control.name}`, step: control.step });
    [range.min, range.max, range.value] =
      [control.min, control.max, given ?? control.value].map((v) => String(inward(v)));
    const tell = () => {
      const value = outward(Number(range.value));
      output.textContent = `${Number(value.toPrecision(3))} ${control.unit}`;
      range.setAttribute("aria-valuetext", output.textContent);
      return Math.min(Math.max(value, control.min), control.max);
    };
    tell();
    range.addEventListener("input", () => change(tell()));
    // The value at which the slider stands can be taken without moving it.
    const take = make("button", { type: "button", className: "take", textContent: "take this value" });
    take.addEventListener("click", () => range.dispatchEvent(new Event("input")));
    const parts = [make("label", { htmlFor: `control-${control.name}` }, output, control.label), range, take];
    if (control.playable) parts.push(player(range, busy));
    return parts;
  }

  function player(range, busy) {
    const button = make("button", { type: "button", textContent: "play" });
    let timer = null;
    button.addEventListener("click", () => {
      if (timer) { clearInterval(timer); timer = null; button.textContent = "play"; return; }
      button.textContent = "pause";
      // The last step may end below the maximum: the end is reached when the value no longer changes.
      const step = () => { const before = range.value; range.stepUp(); return range.value !== before; };
      if (!step()) range.value = range.min;
      timer = setInterval(() => {
        if (busy() && range.isConnected) return;
        if (!range.isConnected || !step()) { button.click(); return; }
        range.dispatchEvent(new Event("input"));
      }, 120);
    });
    return button;
  }

  function choice(control, given, change) {
    const select = make("select", { id: `control-${control.name}` }, ...control.options.map(([value, text]) =>
      make("option", { value, textContent: text, selected: value === (given ?? control.value) })));
    select.addEventListener("input", () => change(select.value));
    return [make("label", { htmlFor: `control-${control.name}`, textContent: control.label }), select];
  }

  function toggle(control, given, change) {
    const box = make("input", { type: "checkbox", id: `control-${control.name}`, checked: given ?? control.value });
    box.addEventListener("input", () => change(box.checked));
    return [make("label", { className: "switch" }, box, control.label)];
  }

  function set(control, given, change) {
    const chosen = new Set(given ?? []);
    const boxes = control.options.map(([value, text]) => {
      const id = `control-${control.name}-${value}`;
      const box = make("input", { type: "checkbox", id, checked: chosen.has(value) });
      box.addEventListener("input", () => {
        if (box.checked) chosen.add(value); else chosen.delete(value);
        change([...chosen]);
      });
      return make("label", { className: "switch" }, box, text);
    });
    return [make("fieldset", { id: `control-${control.name}` }, make("legend", { textContent: control.label }), ...boxes)];
  }

  function text(control, given, change) {
    const field = make("input", { type: "text", id: `control-${control.name}`, placeholder: control.form, value: given ?? "" });
    field.addEventListener("change", () => change(field.value.trim() || undefined));
    return [make("label", { htmlFor: `control-${control.name}`, textContent: control.label }), field];
  }

  const kinds = { slider, choice, switch: toggle, set, text };

  // Builds the controls in a place with values of `settings`; `change` gets a name and a value, none for the default.
  function build(place, controls, settings, change, busy) {
    place.replaceChildren(...controls.map((control) => {
      const tell = (value) => change(control.name, value);
      const made = make("div", {}, ...kinds[control.kind](control, settings[control.name], tell, busy));
      made.dataset.setting = control.name;
      return made;
    }));
  }

  // Disables controls that have no effect given the others, and shows the reasons.
  function disable(reasons) {
    for (const part of all("[data-setting]")) {
      const reason = reasons.get(part.dataset.setting);
      part.classList.toggle("disabled", reason !== undefined);
      part.title = reason ?? "";
      for (const input of all("input, select, button", part)) input.disabled = reason !== undefined;
    }
  }
  return { build, disable, takes };
})();
