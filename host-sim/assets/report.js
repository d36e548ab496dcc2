// The report: figures are drawn when they come into view.
"use strict";

{
  const figures = JSON.parse(document.getElementById("figures").textContent);
  const seen = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting) continue;
      seen.unobserve(target);
      Figures.draw(target, figures[target.dataset.figure]);
    }
  }, { rootMargin: "600px" });
  for (const place of document.querySelectorAll("[data-figure]")) seen.observe(place);
  // Paper shows all of them.
  addEventListener("beforeprint", () => {
    for (const place of document.querySelectorAll("[data-figure]")) Figures.draw(place, figures[place.dataset.figure]);
  });
}
