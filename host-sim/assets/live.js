// A live stream: one picture at a time, of the present or of an earlier moment, for the present controls.
"use strict";
// `show` is called with the pictures, `complain` with errors.
function follow({ controls: offered, settings }, { show, complain }) {
  const { all, element } = Elements;
  const socket = new WebSocket(`ws://${location.host}/live`);
  const [after, pause] = [element("after"), element("pause")];
  let [paused, busy, due, asked] = [false, true, false, null];
  for (const part of all(offered.length ? "#open, #compare, #settings .buttons" : ".controls, #compare")) part.hidden = true;
  element("back").hidden = false;
  // Announcing changes five times a second would be too much.
  element("facts").ariaLive = "off";
  if (!offered.length) all(".explorer")[0].style.gridTemplateColumns = "minmax(0, 1fr)";
  const want = () => {
    due = busy;
    if (busy) return;
    busy = true;
    asked = paused ? Number(after.value) : null;
    socket.send(JSON.stringify({ settings, after: asked }));
  };
  const stop = (does) => { paused = does; pause.textContent = does ? "go on" : "pause"; want(); };
  Controls.build(element("controls"), offered, settings, (name, value) => {
    const { [name]: _, ...others } = settings;
    settings = value === undefined ? others : { ...others, [name]: value };
    want();
  }, () => busy);
  socket.addEventListener("open", () => { busy = false; want(); });
  socket.addEventListener("message", ({ data }) => {
    const answer = JSON.parse(data);
    busy = false;
    if (element("alert").textContent !== (answer.refused ?? "")) complain(answer.refused ?? "");
    if (!answer.refused) {
      show(answer);
      after.max = String(answer.bytes);
      if (!paused) after.value = after.max;
      element("of").textContent = `${Math.round((100 * (asked ?? answer.bytes)) / Math.max(answer.bytes, 1))} %`;
    }
    if (due || !paused) want();
  });
  socket.addEventListener("close", () => complain("the stream has ended"));
  pause.addEventListener("click", () => stop(!paused));
  after.addEventListener("input", () => stop(true));
}
