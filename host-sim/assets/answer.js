// The presentation of an answer on the page: facts, warnings, findings, figures, tables.
"use strict";
const Answer = (() => {
  const { element, make } = Elements;
  const places = new Map();
  // `how` it is drawn: alone, compared over each other, or as a difference. `gives` makes a figure's download buttons.
  function show(answer, how, { clock, zoomed, gives }) {
    tell("facts", answer.facts);
    element("warnings").replaceChildren(...answer.warnings.map((text) => make("li", { textContent: text })));
    findings(answer.findings);
    for (const said of ["command", "firmware"]) element(said).textContent = answer[said];
    element("again").hidden = !answer.command;
    element("differences").hidden = !answer.changed?.length;
    const differs = answer.figures.some(({ data }) => how === "difference" || data.some(({ name }) => name.startsWith("A: ")));
    element("same").hidden = !answer.changed || differs;
    element("changed").tBodies[0].replaceChildren(...(answer.changed ?? []).map(([name, a, b]) => make("tr", {},
      make("th", { scope: "row", textContent: name }), make("td", { textContent: a }), make("td", { textContent: b }))));
    // A figure of differences is distinct from the figure of the same id itself.
    const kind = ({ id, equal, seconds }) => JSON.stringify([id, equal, seconds, how === "difference"]);
    const known = new Set(answer.figures.map(kind));
    for (const [key, { place }] of places) {
      if (known.has(key)) continue;
      Figures.forget(place);
      place.remove();
      places.delete(key);
    }
    clock.see(answer.figures);
    for (const table of answer.tables) tabulate(table, answer.changed ? ", of B" : "", clock);
    // All places are made first: each figure is then drawn at its final width.
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
      entry.caption.replaceChildren(figure.caption, ...gives(figure));
      entry.place.append(entry.caption);
    }
  }

  // Fills an element with names and the text of each.
  const tell = (id, told) => element(id).replaceChildren(...told.map(([name, text, className = ""]) =>
    make("div", { className }, make("dt", { textContent: name }), make("dd", { textContent: text }))));

  function findings(found) {
    tell("findings", found.map(([fault, about, text]) => [about, text, fault ? "fault" : ""]));
    element("check").hidden = !found.length && !element("taken").children.length;
  }

  // Shows what dropped files were recognised as.
  function taken({ taken: files = [], left = [], others = [] }) {
    const unused = left.length ? [["not used", left.join(", ")]] : [];
    const also = others.length ? [["could be of", `${others.join(", ")} as well: choose the system first`]] : [];
    tell("taken", [...files, ...unused, ...also]);
    if (files.length) element("check").open = true;
  }

  // Rows are only made for tables that are open.
  function tabulate(table, whose, clock) {
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

  // Clears the page before another recording.
  function clear() {
    for (const shown of ["facts", "warnings", "findings", "taken", "figures", "tables"]) element(shown).replaceChildren();
    for (const hidden of ["check", "again", "give", "differences"]) element(hidden).hidden = true;
    for (const { place } of places.values()) Figures.forget(place);
    places.clear();
  }
  return { show, findings, taken, clear };
})();
