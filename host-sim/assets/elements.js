// Elements of a page: made and found.
"use strict";

const Elements = {
  make(tag, properties = {}, ...children) {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
  },

  // Of whatever kind.
  /** @type {(selector: string, within?: Document | Element) => any[]} */
  all: (selector, within = document) => [...within.querySelectorAll(selector)],
};
