// Files that are dropped on the page or chosen together: one, several, or whole folders.
"use strict";
const Drop = {
  // All files of a folder, except hidden ones.
  async within(entry) {
    if (entry.isFile) return [await new Promise((done, fail) => entry.file(done, fail))];
    const [reader, found] = [entry.createReader(), []];
    for (;;) {
      // A folder is read a hundred entries at a time.
      const some = await new Promise((done, fail) => reader.readEntries(done, fail));
      if (!some.length) return found;
      for (const it of some) if (!it.name.startsWith(".")) found.push(...await Drop.within(it));
    }
  },

  // `take` is called with files, `complain` with a message if they cannot be read.
  listen(take, complain) {
    const over = (is) => { document.documentElement.classList.toggle("dropping", is); };
    addEventListener("dragover", (event) => { event.preventDefault(); over(true); });
    addEventListener("dragleave", (event) => { if (!event.relatedTarget) over(false); });
    addEventListener("drop", (event) => {
      event.preventDefault();
      over(false);
      // Items must be accessed synchronously: they are gone after the event.
      const items = [...(event.dataTransfer?.items ?? [])].filter(({ kind }) => kind === "file");
      const parts = items.map((item) => ({ entry: item.webkitGetAsEntry(), file: item.getAsFile() }));
      Promise.all(parts.map(({ entry, file }) => (entry ? Drop.within(entry) : [file])))
        .then((files) => take(files.flat()), (error) => complain(`what was dropped cannot be read: ${error.message}`));
    });
  },
};
