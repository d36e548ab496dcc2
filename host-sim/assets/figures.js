// Draws figures computed by the program: theme, legend and keys. Everything else is done by Plotly.
"use strict";
const Figures = (() => {
  const drawn = new Map();
  const resized = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      const entry = [...drawn.values()].find((it) => it.plot === target);
      // A folded figure has no size.
      if (!entry?.plot.data || !entry.plot.offsetParent) continue;
      if (entry.figure.equal) fit(entry);
      Plotly.Plots.resize(target).then(() => entry.clock?.mark([entry]));
    }
  });
  const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const { make } = Elements;
  // The pixels beside the axes of a map: numbers, labels and the margin.
  const [BESIDE, BELOW] = [70, 54];
  // A map is as high as its contents require at its width, so that no path is a thread in an empty field.
  function fit({ plot, figure }) {
    const extent = (axis, along) => {
      if (axis.range) return axis.range[1] - axis.range[0];
      const shown = figure.data.filter((series) => series.visible !== "legendonly");
      const [low, high] = Elements.extent(shown.flatMap((series) => series[along])) ?? [0, 0];
      return high - low;
    };
    const [wide, high] = [extent(figure.layout.xaxis, "x"), extent(figure.layout.yaxis, "y")];
    const width = plot.clientWidth - BESIDE;
    const asked = wide > 0 && high > 0 ? (width * high) / wide : width;
    plot.style.height = `${Math.round(Math.min(Math.max(asked, 110), 560, Math.max(width, 300)) + BELOW)}px`;
  }

  function axis(given, map) {
    const colours = { gridcolor: style("--line"), zerolinecolor: style("--line"), linecolor: style("--line") };
    // A map's fixed aspect ratio and growing margins would affect each other endlessly.
    const fit = map ? { constrain: "domain" } : { automargin: true };
    return { ...fit, ...colours, ...structuredClone(given) };
  }

  function layout({ figure, clock }) {
    const range = clock?.axis(figure);
    // A window chosen elsewhere applies here as well.
    const shown = range ? { range, autorange: false, uirevision: range.join() } : {};
    return {
      xaxis: { ...axis(figure.layout.xaxis, figure.equal), ...shown },
      yaxis: axis(figure.layout.yaxis, figure.equal),
      paper_bgcolor: "rgba(0,0,0,0)",
      plot_bgcolor: "rgba(0,0,0,0)",
      font: { color: style("--ink"), family: "system-ui, sans-serif", size: 12 },
      hoverlabel: { bgcolor: style("--panel"), font: { color: style("--ink") } },
      modebar: { bgcolor: "rgba(0,0,0,0)", color: style("--soft"), activecolor: style("--accent") },
      margin: { l: 58, r: 12, t: 8, b: 46 },
      hovermode: "closest",
      dragmode: "zoom",
      showlegend: false,
      // The zoom is kept when the data change.
      uirevision: "kept",
    };
  }

  // HTML buttons in place of Plotly's legend: they wrap on a phone, take the keyboard, and show values at the cursor.
  function legend(entry) {
    const { figure, hidden, buttons } = entry;
    entry.values = figure.data.map(() => make("span", { className: "value", ariaHidden: "true" }));
    buttons.replaceChildren(...figure.data.map((series, index) => {
      const button = make("button", { type: "button", textContent: series.name });
      button.style.setProperty("--series", series.line.color);
      button.setAttribute("aria-pressed", String(!hidden.has(series.name)));
      button.addEventListener("click", () => {
        if (!hidden.delete(series.name)) hidden.add(series.name);
        const shows = !hidden.has(series.name);
        button.setAttribute("aria-pressed", String(shows));
        entry.figure.data[index].visible = shows ? true : "legendonly";
        Plotly.restyle(entry.plot, { visible: shows ? true : "legendonly" }, [index]).then(() => entry.clock?.mark([entry]));
      });
      if (figure.seconds) button.append(entry.values[index]);
      return button;
    }), png(entry));
  }

  // A button that downloads a figure as shown, with its title and names.
  function png({ plot, figure }) {
    const button = make("button", { type: "button", className: "give", textContent: "PNG", ariaLabel: `download ${figure.title} as PNG` });
    button.addEventListener("click", () => {
      const legend = { title: { text: `<b>${figure.title}</b>`, side: "top" }, orientation: "h", y: 1.02, yanchor: "bottom" };
      const more = { legend, showlegend: true, paper_bgcolor: style("--panel"), margin: { l: 58, r: 12, t: 12, b: 56 } };
      Plotly.downloadImage({ data: plot.data, layout: { ...structuredClone(plot.layout), ...more } },
        { format: "png", filename: figure.title, width: plot.clientWidth, height: plot.clientHeight + 80, scale: 2 });
    });
    return button;
  }

  // + and − zoom, arrow keys pan, 0 shows everything; comma and full stop move the cursor.
  function keys(event, { plot, clock }) {
    // The browser's own shortcuts are left alone.
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const { xaxis, yaxis } = plot._fullLayout;
    const change = (by, move) => {
      const update = {};
      for (const [name, axis, shift] of [["xaxis", xaxis, move[0]], ["yaxis", yaxis, move[1]]]) {
        const [low, high] = axis.range;
        const [middle, half] = [(low + high) / 2 + shift * (high - low), (by * (high - low)) / 2];
        update[`${name}.range[0]`] = middle - half;
        update[`${name}.range[1]`] = middle + half;
      }
      return Plotly.relayout(plot, update);
    };
    const actions = {
      "+": () => change(0.8, [0, 0]), "-": () => change(1.25, [0, 0]),
      ArrowLeft: () => change(1, [-0.1, 0]), ArrowRight: () => change(1, [0.1, 0]),
      ArrowUp: () => change(1, [0, 0.1]), ArrowDown: () => change(1, [0, -0.1]),
      0: () => Plotly.relayout(plot, { "xaxis.autorange": true, "yaxis.autorange": true }),
      ",": () => clock?.step(-1), ".": () => clock?.step(1),
    };
    if (actions[event.key]) {
      event.preventDefault();
      actions[event.key]();
    }
  }

  function prepare(place, figure, { clock, zoomed }) {
    const [plot, buttons, box] = ["div", "div", "div"].map((tag) => make(tag));
    [plot.className, buttons.className, box.className] = [figure.equal ? "plot map" : "plot", "legend", "box"];
    plot.tabIndex = 0;
    plot.setAttribute("role", "application");
    const told = clock ? " Comma and full stop move the cursor." : "";
    plot.setAttribute("aria-label",
      `${figure.title}. ${figure.caption} Plus and minus zoom, arrows move, 0 shows everything.${told}`);
    box.append(plot);
    place.append(buttons, box);
    resized.observe(plot);
    const entry = { plot, buttons, box, hidden: new Set(), known: new Set(), names: "", values: [], figure, clock, zoomed };
    plot.addEventListener("keydown", (event) => keys(event, entry));
    drawn.set(place, entry);
    clock?.join(entry);
    return entry;
  }

  // `clock` holds the figure's time, `zoomed` is called with ranges of other axes.
  function draw(place, figure, { clock = null, zoomed = null } = {}) {
    const entry = drawn.get(place) ?? prepare(place, figure, { clock, zoomed });
    const first = !entry.plot.data;
    entry.figure = figure;
    for (const series of figure.data) {
      // A new series is hidden if the program says so; one of a comparison, if its origin was hidden here.
      if (!entry.known.has(series.name)) {
        const of = series.name.replace(/^[AB]: /, "");
        const hides = entry.known.has(of) ? entry.hidden.has(of) : series.visible === "legendonly";
        if (hides) entry.hidden.add(series.name);
        entry.known.add(series.name);
      }
      series.visible = entry.hidden.has(series.name) ? "legendonly" : true;
    }
    const names = JSON.stringify(figure.data.map((series) => series.name));
    if (names !== entry.names) legend(entry);
    entry.names = names;
    if (first && figure.equal) fit(entry);
    const done = Plotly.react(entry.plot, figure.data, layout(entry), {
      displaylogo: false, scrollZoom: false,
      // A page contacts only the program: by default Plotly offers to send figures to its makers.
      showSendToCloud: false,
      modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d", "toImage"],
    });
    if (first) {
      clock?.listen(entry);
      if (zoomed && !figure.seconds && !figure.equal) entry.plot.on("plotly_relayout", () => {
        const { autorange, range } = entry.plot._fullLayout.xaxis;
        zoomed(figure.id, autorange ? null : range.map(Number));
      });
    }
    return done.then(() => clock?.mark([entry]));
  }

  function theme(dark) {
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    for (const entry of drawn.values()) Plotly.react(entry.plot, entry.figure.data, layout(entry));
  }

  const system = matchMedia("(prefers-color-scheme: dark)");
  theme(system.matches);
  system.addEventListener("change", () => theme(system.matches));
  Elements.element("theme").addEventListener("click", () => theme(document.documentElement.dataset.theme !== "dark"));

  const forget = (place) => {
    const entry = drawn.get(place);
    entry.clock?.leave(entry);
    resized.unobserve(entry.plot);
    Plotly.purge(entry.plot);
    drawn.delete(place);
  };
  return { draw, forget };
})();
