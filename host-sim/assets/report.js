// The report: figures are drawn when they come into view; those of one recording share a clock.
"use strict";
{
  const figures = JSON.parse(document.getElementById("figures").textContent);
  const { all, make } = Elements;
  // Figures of the same time range, to three digits, are of one recording: they share a clock and a bar behind them.
  const reach = (figure) => Clock.reach(figure)?.map((end) => Number(end.toPrecision(3))).join();
  const clocks = new Map();
  for (const section of all("[data-clock]")) {
    const groups = new Map();
    for (const place of all("[data-figure]", section)) {
      const of = section.dataset.clock === "one" ? "one" : reach(figures[place.dataset.figure]);
      if (of) groups.set(of, [...(groups.get(of) ?? []), place]);
    }
    for (const places of groups.values()) {
      const drawn = places.map((place) => figures[place.dataset.figure]);
      if (!drawn.some((figure) => figure.seconds)) continue;
      const behind = make("div");
      places[places.length - 1].after(behind);
      const clock = new Clock(section.dataset.clock === "one" ? section : behind);
      clock.see(drawn);
      if (section.dataset.window) clock.look(section.dataset.window.split(",").map(Number));
      for (const place of places) clocks.set(place, clock);
      if (section.dataset.clock === "one") for (const table of all(".rows table", section)) clock.follow(table);
    }
  }
  const draw = (place) => Figures.draw(place, figures[place.dataset.figure], { clock: clocks.get(place) ?? null });
  const seen = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting) continue;
      seen.unobserve(target);
      draw(target);
    }
  }, { rootMargin: "600px" });
  for (const place of all("[data-figure]")) seen.observe(place);
  // All figures are drawn for printing.
  addEventListener("beforeprint", () => {
    for (const part of all("details")) part.open = true;
    for (const place of all("[data-figure]")) draw(place);
  });
}
