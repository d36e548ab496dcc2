// The report: figures are drawn when they come into view; those of a section have one time.
"use strict";

{
  const figures = JSON.parse(document.getElementById("figures").textContent);
  const clocks = new Map();
  for (const section of document.querySelectorAll("[data-clock]")) {
    const clock = new Clock(section);
    const places = [...section.querySelectorAll("[data-figure]")];
    clock.see(places.map((place) => figures[place.dataset.figure]));
    if (section.dataset.window) clock.look(section.dataset.window.split(",").map(Number));
    for (const place of places) clocks.set(place, clock);
  }
  const draw = (place) => Figures.draw(place, figures[place.dataset.figure], { clock: clocks.get(place) });
  const seen = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting) continue;
      seen.unobserve(target);
      draw(target);
    }
  }, { rootMargin: "600px" });
  for (const place of document.querySelectorAll("[data-figure]")) seen.observe(place);
  // Paper shows all of them.
  addEventListener("beforeprint", () => {
    for (const part of document.querySelectorAll("details")) part.open = true;
    for (const place of document.querySelectorAll("[data-figure]")) draw(place);
  });
}
