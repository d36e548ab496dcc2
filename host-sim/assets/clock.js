// The common time of a page's figures: a window that all show, and a cursor moved by a bar, a mouse, a finger or a key.
"use strict";
class Clock {
  static SPEEDS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];

  // The figures' extent, the part shown and the cursor, all in seconds; and the animation frame of a running play.
  /** @type {[number, number] | null} */ span = null;
  /** @type {number[] | null} */ window = null;
  /** @type {number | null} */ cursor = null;
  /** @type {number | null} */ playing = null;
  /** @type {Set<any>} */ members = new Set();
  /** @type {Set<any>} */ tables = new Set();

  // `changed` is called for every new window and cursor.
  /** @param {Element} place @param {(clock: Clock) => void} changed */
  constructor(place, changed = () => {}) {
    const { make } = Elements;
    this.changed = changed;
    this.bar = make("div", { className: "clock", hidden: true });
    this.bar.setAttribute("role", "group");
    this.bar.setAttribute("aria-label", "time");
    this.play = make("button", { type: "button", textContent: "play", className: "play" });
    this.speed = make("select", { className: "speed", ariaLabel: "speed" });
    this.speed.append(...Clock.SPEEDS.map((speed) =>
      make("option", { value: String(speed), textContent: `${speed} ×`, selected: speed === 1 })));
    this.slider = make("input", { type: "range", ariaLabel: "time" });
    // The slider announces the time itself: announcements sixty times a second would be a nuisance.
    this.told = make("span", { className: "told", ariaHidden: "true" });
    this.all = make("button", { type: "button", textContent: "whole time", className: "whole", hidden: true });
    this.play.addEventListener("click", () => this.#toggle());
    this.slider.addEventListener("input", () => this.move(Number(this.slider.value)));
    this.all.addEventListener("click", () => this.look(null));
    this.bar.append(this.play, this.speed, this.slider, this.told, this.all);
    place.append(this.bar);
  }

  // The time range of a figure in seconds: of one over time, or of a map whose points have times; null without times.
  static reach({ seconds, data }) {
    const ends = Elements.extent(data.flatMap(({ x, customdata }) => (seconds ? x : customdata) ?? []));
    return ends && ends[0] < ends[1] ? ends.map((end) => end * (seconds ?? 1)) : null;
  }

  // Takes in all figures that are shown, before they are drawn.
  see(figures) {
    const reaches = figures.filter((figure) => figure.seconds).map(Clock.reach).filter(Boolean);
    let low = Math.min(...reaches.map(([low]) => low));
    let high = Math.max(...reaches.map(([, high]) => high));
    // Figures of a zoomed window lack the data outside it.
    if (this.window && this.span) [low, high] = [Math.min(low, this.span[0]), Math.max(high, this.span[1])];
    this.span = low < high ? [low, high] : null;
    this.bar.hidden = !this.span || !this.members.size;
    this.#limit();
  }

  // The range that is shown, in seconds.
  range() {
    return this.window ?? this.span;
  }

  // The range of a figure's time axis; null if it has none.
  axis({ seconds, layout }) {
    // A figure's own initial range holds until the window is changed.
    if (!seconds || !this.span || (!this.window && layout.xaxis.range)) return null;
    return this.range().map((end) => end / seconds);
  }

  join(entry) {
    this.members.add(entry);
    this.bar.hidden = !this.span;
    entry.plot.addEventListener("pointermove", (event) => {
      if (event.pointerType === "mouse" && !event.buttons && !this.playing) this.#point(entry, event);
    });
    // A moving finger zooms.
    entry.plot.addEventListener("pointerdown", (event) => {
      if (event.pointerType !== "mouse") this.#point(entry, event);
    });
  }

  // Called once the figure is drawn.
  listen(entry) {
    const { plot, figure } = entry;
    if (figure.seconds) plot.on("plotly_relayout", () => this.#zoomed(entry));
    else plot.on("plotly_relayout", () => this.mark([entry]));
    plot.on("plotly_hover", ({ points: [{ customdata }] }) => {
      if (typeof customdata === "number" && !this.playing) this.move(customdata);
    });
  }

  leave(entry) {
    this.members.delete(entry);
  }

  // A table whose rows have times: a click or Enter moves the cursor to a row, arrow keys move between rows.
  /** @param {any} table */
  follow(table) {
    const rows = Elements.all("[data-time]", table);
    // Tab stops once in a table, at the row that last had the focus.
    const stop = (at) => rows.forEach((row) => { row.tabIndex = row === at ? 0 : -1; });
    stop(rows[0]);
    table.addEventListener("focusin", ({ target }) => { if (rows.includes(target)) stop(target); });
    const go = ({ target }) => { if (target.closest("[data-time]")) this.move(Number(target.closest("[data-time]").dataset.time)); };
    table.addEventListener("click", go);
    table.addEventListener("keydown", (event) => {
      const next = { ArrowUp: "previousElementSibling", ArrowDown: "nextElementSibling" }[event.key];
      if (event.key === "Enter") go(event);
      if (!next) return;
      event.preventDefault();
      event.target[next]?.focus();
    });
    this.tables.add({ table, rows, times: rows.map((row) => Number(row.dataset.time)) });
    this.mark([]);
  }

  #point({ plot, figure }, { clientX }) {
    const axis = plot._fullLayout?.xaxis;
    if (!figure.seconds || !axis) return;
    const pixel = clientX - plot.getBoundingClientRect().left - axis._offset;
    if (pixel >= 0 && pixel <= axis._length) this.move(axis.p2l(pixel) * figure.seconds);
  }

  #zoomed({ plot, figure: { seconds } }) {
    const known = this.range();
    if (!known || !this.span) return;
    const { autorange, range } = plot._fullLayout.xaxis;
    const [low, high] = range.map((end) => Number(end) * seconds);
    const close = (a, b) => Math.abs(a - b) <= 1e-6 * (known[1] - known[0]);
    if (close(low, known[0]) && close(high, known[1])) return this.mark();
    const is_all = autorange || (low <= this.span[0] && high >= this.span[1]);
    this.look(is_all ? null : [low, high]);
  }

  // Shows another window, or the whole time.
  look(window) {
    // Rounded to the digits that an address holds: microseconds.
    this.window = window && window.map((end) => Number(end.toFixed(6)));
    for (const { plot, figure } of this.members) {
      const range = this.axis(figure) ?? (figure.seconds && figure.layout.xaxis.range);
      const shown = plot._fullLayout?.xaxis.range;
      if (range && shown && range.some((end, i) => end !== shown[i])) Plotly.relayout(plot, { "xaxis.range": range });
    }
    this.#limit();
    this.mark();
    this.changed(this);
  }

  // Moves the cursor to a time.
  move(time) {
    this.cursor = time;
    this.mark();
    this.changed(this);
  }

  // Moves the cursor by a key press, as far as an arrow of the bar does.
  step(by) {
    if (!this.range()) return;
    const [low, high] = this.range();
    this.move(Math.min(Math.max((this.cursor ?? low) + (by * (high - low)) / 200, low), high));
  }

  #limit() {
    if (!this.span) return;
    const [low, high] = this.range();
    [this.slider.min, this.slider.max, this.slider.step] = [low, high, (high - low) / 1000].map(String);
    this.all.hidden = !this.window;
    this.slider.value = String(this.cursor ?? low);
  }

  #toggle() {
    if (this.playing) { cancelAnimationFrame(this.playing); this.playing = null; this.play.textContent = "play"; return; }
    this.play.textContent = "pause";
    const [low, high] = this.range();
    if (this.cursor === null || this.cursor < low || this.cursor >= high) this.move(low);
    let before = performance.now();
    const step = (now) => {
      // The figures that were played may have been removed.
      if (!this.range()) return this.#toggle();
      const [, end] = this.range();
      this.move(Math.min(this.cursor + ((now - before) / 1000) * Number(this.speed.value), end));
      before = now;
      this.playing = requestAnimationFrame(step);
      if (this.cursor >= end) this.#toggle();
    };
    this.playing = requestAnimationFrame(step);
  }

  // The longer the span, the coarser the text.
  static #words(time, length) {
    if (length < 7200) return `${time.toFixed(length < 20 ? 3 : 2)} s`;
    const whole = Math.floor(time);
    return `${Math.floor(whole / 3600)}:${new Date((whole % 3600) * 1000).toISOString().slice(14, 19)} h`;
  }

  // Draws the cursor at its position without notifying `changed`.
  /** @param {Iterable<any>} entries */
  mark(entries = this.members) {
    if (this.cursor !== null && this.span) {
      // From now on the legends reserve room for values.
      document.body.classList.add("timed");
      this.slider.value = String(this.cursor);
      this.told.textContent = Clock.#words(this.cursor, this.span[1] - this.span[0]);
      this.slider.setAttribute("aria-valuetext", this.told.textContent);
    }
    for (const entry of this.tables) this.#row(entry);
    for (const entry of entries) {
      if (entry.figure.seconds) this.#line(entry);
      else if (entry.figure.data.some((series) => series.customdata)) this.#places(entry);
    }
  }

  #line(entry) {
    const { xaxis, yaxis } = entry.plot._fullLayout ?? {};
    if (!xaxis || this.cursor === null) return;
    const time = this.cursor / entry.figure.seconds;
    const pixel = xaxis.l2p(time);
    entry.cursor ??= Clock.#mark(entry, "cursor");
    entry.cursor.hidden = !(pixel >= 0 && pixel <= xaxis._length);
    entry.cursor.style.height = `${yaxis._length}px`;
    entry.cursor.style.transform = `translate(${xaxis._offset + pixel}px, ${yaxis._offset}px)`;
    entry.figure.data.forEach(({ x, y }, index) => {
      const place = Clock.#at(x, time);
      const value = place === null ? null : y[place.share < 0.5 ? place.before : place.after];
      entry.values[index].textContent = value === null ? "" : String(Number(value.toPrecision(4)));
    });
  }

  // Marks the row at the cursor and scrolls it into view within its box.
  #row(entry) {
    if (!entry.table.isConnected) return void this.tables.delete(entry);
    const place = this.cursor === null ? null : Clock.#at(entry.times, this.cursor);
    const now = place && entry.rows[place.share < 0.5 ? place.before : place.after];
    if (now === entry.now) return;
    entry.now?.removeAttribute("aria-current");
    entry.now = now;
    if (!now) return;
    now.setAttribute("aria-current", "true");
    const [box, top] = [entry.table.parentElement, now.offsetTop - entry.table.parentElement.scrollTop];
    if (top < 2 * now.offsetHeight || top + now.offsetHeight > box.clientHeight) box.scrollTop += top - box.clientHeight / 2;
  }

  #places(entry) {
    const { xaxis, yaxis } = entry.plot._fullLayout ?? {};
    if (!xaxis || this.cursor === null) return;
    entry.dots ??= new Map();
    for (const dot of entry.dots.values()) dot.hidden = true;
    const ellipses = [];
    entry.figure.data.forEach(({ name, x, y, customdata, visible, line, mode, meta }) => {
      const place = customdata && visible === true ? Clock.#at(customdata, this.cursor) : null;
      if (!place) return;
      // Between points that are not joined by a line there is no value.
      if (!mode.includes("lines")) place.share = 0;
      const between = (values) => values[place.before] === null || values[place.after] === null ? NaN
        : values[place.before] + place.share * (values[place.after] - values[place.before]);
      const [left, top] = [xaxis.l2p(between(x)), yaxis.l2p(between(y))];
      if (meta?.ellipses) ellipses.push(Clock.#ellipse(entry.plot._fullLayout, meta.ellipses.map(between), [left, top], line.color));
      if (!(left >= 0 && left <= xaxis._length && top >= 0 && top <= yaxis._length)) return;
      if (!entry.dots.has(name)) entry.dots.set(name, Clock.#mark(entry, "here"));
      const dot = entry.dots.get(name);
      dot.hidden = false;
      dot.style.setProperty("--series", line.color);
      dot.style.transform = `translate(${xaxis._offset + left}px, ${yaxis._offset + top}px)`;
    });
    if (!entry.ellipses && !ellipses.length) return;
    entry.ellipses ??= Clock.#mark(entry, "ellipses");
    entry.ellipses.style.transform = `translate(${xaxis._offset}px, ${yaxis._offset}px)`;
    entry.ellipses.innerHTML = `<svg width="${xaxis._length}" height="${yaxis._length}">${ellipses.join("")}</svg>`;
  }

  // The unit circle's point (u, v) lies at (a u, b u + c v) from the centre, in units of the axes; empty if unknown.
  static #ellipse({ xaxis, yaxis }, [a, b, c], [left, top], colour) {
    const [across, up] = [xaxis, yaxis].map((axis) => axis.l2p(1) - axis.l2p(0));
    const matrix = [across * a, up * b, 0, up * c, left, top];
    return matrix.every(Number.isFinite) ? `<circle r="1" stroke="${colour}" transform="matrix(${matrix})"/>` : "";
  }

  static #mark(entry, className) {
    const mark = Elements.make("div", { className });
    entry.box.append(mark);
    return mark;
  }

  static #sorted = new WeakMap();

  // The neighbours of a time, and its position between them from 0 to 1; null beyond the ends.
  static #at(times, time) {
    const sorted = Clock.#sorted.get(times) ?? times.every((value, i) => i === 0 || (value !== null && value >= times[i - 1]));
    Clock.#sorted.set(times, sorted);
    if (!sorted || !times.length || time < times[0] || time > times[times.length - 1]) return null;
    let [before, after] = [0, times.length - 1];
    while (after - before > 1) {
      const middle = (before + after) >> 1;
      if (times[middle] <= time) before = middle; else after = middle;
    }
    const width = times[after] - times[before];
    return { before, after, share: width > 0 ? (time - times[before]) / width : 0 };
  }
}
