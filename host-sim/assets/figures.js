// Draws figures that the program computed: theme, legend and keys. Everything else is Plotly's.
"use strict";

const Figures = (() => {
  const drawn = new Map();
  const resized = new ResizeObserver((entries) => {
    for (const { target } of entries) if (target.data) Plotly.Plots.resize(target);
  });
  const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  function axis(given, map) {
    const colours = { gridcolor: style("--line"), zerolinecolor: style("--line"), linecolor: style("--line") };
    // A map's proportions and growing margins chase each other.
    const fit = map ? { constrain: "domain" } : { automargin: true };
    return { ...fit, ...colours, ...structuredClone(given) };
  }

  function layout(figure) {
    return {
      xaxis: axis(figure.layout.xaxis, figure.equal),
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
      // Zoom outlives new data.
      uirevision: "kept",
    };
  }

  // HTML buttons in place of Plotly's legend: they wrap on a phone and take the keyboard.
  function legend(entry) {
    const { figure, hidden, buttons } = entry;
    buttons.replaceChildren(...figure.data.map((series, index) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = series.name;
      button.style.setProperty("--series", series.line.color);
      button.setAttribute("aria-pressed", String(!hidden.has(series.name)));
      button.addEventListener("click", () => {
        if (!hidden.delete(series.name)) hidden.add(series.name);
        const shows = !hidden.has(series.name);
        button.setAttribute("aria-pressed", String(shows));
        Plotly.restyle(entry.plot, { visible: shows ? true : "legendonly" }, [index]);
      });
      return button;
    }));
  }

  // + and − zoom, arrows move, 0 shows everything.
  function keys(event, plot) {
    // The browser's own keys stay its own.
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
    };
    if (actions[event.key]) {
      event.preventDefault();
      actions[event.key]();
    }
  }

  function prepare(place, figure, onZoom) {
    const plot = document.createElement("div");
    const buttons = document.createElement("div");
    plot.className = figure.equal ? "plot map" : "plot";
    plot.tabIndex = 0;
    plot.setAttribute("role", "application");
    plot.setAttribute("aria-label", `${figure.title}. ${figure.caption} Plus and minus zoom, arrows move, 0 shows everything.`);
    plot.addEventListener("keydown", (event) => keys(event, plot));
    buttons.className = "legend";
    place.append(buttons, plot);
    resized.observe(plot);
    const hidden = new Set(figure.data.filter((series) => series.visible).map((series) => series.name));
    const entry = { plot, buttons, hidden, names: "", figure, onZoom };
    drawn.set(place, entry);
    return entry;
  }

  function draw(place, figure, onZoom) {
    const entry = drawn.get(place) ?? prepare(place, figure, onZoom);
    const first = !entry.plot.data;
    entry.figure = figure;
    for (const series of figure.data) series.visible = entry.hidden.has(series.name) ? "legendonly" : true;
    const names = JSON.stringify(figure.data.map((series) => series.name));
    if (names !== entry.names) legend(entry);
    entry.names = names;
    const done = Plotly.react(entry.plot, figure.data, layout(figure), {
      displaylogo: false, scrollZoom: false,
      // A page asks nobody but the program: Plotly offers to send figures to its makers, unless told otherwise.
      showSendToCloud: false,
      modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"],
    });
    if (first && onZoom) entry.plot.on("plotly_relayout", () => {
      const { autorange, range } = entry.plot._fullLayout.xaxis;
      onZoom(figure.id, autorange ? null : range.map(Number));
    });
    return done;
  }

  function theme(dark) {
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    for (const entry of drawn.values()) Plotly.react(entry.plot, entry.figure.data, layout(entry.figure));
  }

  const system = matchMedia("(prefers-color-scheme: dark)");
  theme(system.matches);
  system.addEventListener("change", () => theme(system.matches));
  document.getElementById("theme").addEventListener("click", () =>
    theme(document.documentElement.dataset.theme !== "dark"));

  const forget = (place) => {
    const { plot } = drawn.get(place);
    resized.unobserve(plot);
    Plotly.purge(plot);
    drawn.delete(place);
  };
  return { draw, forget };
})();
