// Making and finding elements of a page.
"use strict";
const Elements = {
  make(tag, properties = {}, ...children) {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
  },

  // Elements of any kind.
  /** @type {(id: string) => any} */
  element: (id) => document.getElementById(id),
  /** @type {(selector: string, within?: Document | Element) => any[]} */
  all: (selector, within = document) => [...within.querySelectorAll(selector)],

  // The minimum and maximum of numbers; null if there are none.
  extent(values) {
    let [low, high] = [Infinity, -Infinity];
    for (const value of values) if (value !== null) [low, high] = [Math.min(low, value), Math.max(high, value)];
    return low <= high ? [low, high] : null;
  },
};
