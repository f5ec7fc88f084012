"use strict";
// Windows of tests are moved over the signals by mouse or keys. Both do nothing but write seconds into the form: what
// campaign comes of them, the server says.
(() => {
  const course = document.querySelector(".course"), form = document.getElementById("choice");
  if (!course || !form || !form.querySelector("button")) return;
  const begin = Number(course.dataset.start), length = Number(course.dataset.stop) - begin, STEP = 0.1;
  const rows = [...form.querySelectorAll("[data-row]")];
  const field = (at, part) => form.elements[`${part}.${at}`];
  const value = (at, part) => Number(field(at, part)?.value || 0);
  const share = (seconds) => `${(100 * (seconds - begin) / length).toFixed(4)}%`;
  const wide = (seconds) => `${Math.max(0, 100 * seconds / length).toFixed(4)}%`;
  const tidy = (seconds) => Math.round(seconds * 1000) / 1000;

  const times = (at) => {
    const stated = (name) => Number(rows[at].dataset[name]), later = value(at, "later");
    return {start: stated("start") + later, from: stated("settled") + later + value(at, "from"),
      to: stated("stop") + later + value(at, "to"), shortest: stated("shortest")};
  };

  const draw = (at) => {
    const {start, from, to} = times(at), used = field(at, "use").checked;
    for (const one of course.querySelectorAll(`[data-test="${at}"]`)) {
      one.classList.toggle("out", !used);
      const place = (name, x, width) => one.querySelectorAll(name).forEach((part) => {
        part.setAttribute("x", share(x));
        if (width !== undefined) part.setAttribute("width", wide(width));
      });
      place(".whole", start, to - start);
      place(".inside", from, to - from);
      place("text", from);
      place('[data-part="from"]', from);
      place('[data-part="to"]', to);
      for (const part of one.querySelectorAll("[data-part]")) {
        const at_s = {later: start, from, to}[part.dataset.part];
        part.setAttribute("aria-valuenow", at_s.toFixed(1));
        part.setAttribute("aria-valuetext", `${at_s.toFixed(1)} s${used ? "" : ", left out"}`);
      }
    }
    rows[at].querySelector("[data-shown]").textContent = `${from.toFixed(1)} to ${to.toFixed(1)}`;
  };

  // one way for mouse, keys and the button: what cannot be is not written
  const put = (at, part, seconds) => {
    const input = field(at, part), before = input.value;
    input.value = String(tidy(seconds));
    const {start, from, to, shortest} = times(at);
    if (start < begin - 1e-9 || from < start - 1e-9 || to - from < shortest - 1e-6) input.value = before;
    draw(at);
    ask();
  };

  let asking = 0, asked = 0;
  const ask = () => {
    clearTimeout(asking);
    course.dataset.state = "asking";
    asking = setTimeout(show, 300);
  };
  const show = async () => {
    const number = ++asked, text = document.getElementById("text"), refused = document.getElementById("refused");
    let answer = {ok: false}, told = {refused: "The server did not answer: move a window again to ask once more."};
    try {
      answer = await fetch(`/api/v1${form.getAttribute("action")}`, {method: "POST", body: new URLSearchParams(new FormData(form))});
      told = await answer.json();
    } catch {
      // no network, or no JSON from what stands before the server
      answer = {ok: false};
    }
    // a later question is on its way
    if (number !== asked) return;
    refused.hidden = answer.ok;
    refused.textContent = told.refused || "";
    if (answer.ok) text.textContent = told.file;
    course.dataset.state = answer.ok ? "shown" : "refused";
  };

  const handles = [...course.querySelectorAll(".lane [data-part]")];
  const at_of = (handle) => Number(handle.parentNode.dataset.test);
  const WORDS = {later: "the whole test", from: "its window from", to: "its window to"};
  const choose = (at) => handles.forEach((one) => one.setAttribute("tabindex", at_of(one) === at ? "0" : "-1"));
  for (const handle of handles) {
    const at = at_of(handle), part = handle.dataset.part;
    handle.setAttribute("role", "slider");
    handle.setAttribute("aria-label", `${rows[at].querySelector("th").firstChild.textContent}, ${WORDS[part]}`);
    handle.setAttribute("aria-valuemin", String(begin));
    handle.setAttribute("aria-valuemax", String(begin + length));
    handle.setAttribute("aria-describedby", "keys");
    handle.addEventListener("pointerdown", (event) => {
      const pixels = course.getBoundingClientRect().width, first = event.clientX, stood = value(at, part);
      const move = (now) => put(at, part, stood + Math.round((now.clientX - first) / pixels * length / STEP) * STEP);
      handle.setPointerCapture(event.pointerId);
      handle.addEventListener("pointermove", move);
      handle.addEventListener("lostpointercapture", () => handle.removeEventListener("pointermove", move), {once: true});
      choose(at);
      handle.focus();
      event.preventDefault();
    });
    handle.addEventListener("dblclick", () => field(at, "use").click());
    handle.addEventListener("keydown", (event) => {
      const steps = {ArrowLeft: -1, ArrowRight: 1, PageDown: -100, PageUp: 100}[event.key];
      const next = {ArrowUp: -1, ArrowDown: 1}[event.key];
      if (steps) put(at, part, value(at, part) + steps * STEP * (event.shiftKey ? 10 : 1));
      else if (event.key === "Home") put(at, part, 0);
      else if (event.key === " " || event.key === "Delete") field(at, "use").click();
      else if (next && rows[at + next]) {
        const group = course.querySelector(`.lane [data-test="${at + next}"]`);
        choose(at + next);
        (group.querySelector(`[data-part="${part}"]`) || group.querySelector("[data-part]")).focus();
      } else return;
      event.preventDefault();
    });
  }
  form.addEventListener("input", (event) => {
    draw(Number(event.target.name.split(".")[1]));
    ask();
  });
  const tools = document.querySelector(".tools");
  let zoom = 1;
  for (const button of tools.querySelectorAll("[data-zoom]")) {
    button.addEventListener("click", () => {
      const roll = course.parentNode, middle = (roll.scrollLeft + roll.clientWidth / 2) / course.clientWidth;
      zoom = Math.min(Math.max(zoom * Number(button.dataset.zoom), 1), 32);
      course.style.width = `${100 * zoom}%`;
      roll.scrollLeft = middle * course.clientWidth - roll.clientWidth / 2;
    });
  }
  const found = tools.querySelector("[data-found]"), differing = rows.filter((row) => row.dataset.found);
  found.hidden = !differing.length;
  found.addEventListener("click", () => differing.forEach((row) => put(Number(row.dataset.row), "later", Number(row.dataset.found))));
  tools.hidden = false;
  document.getElementById("keys").append(" Drag a test or an end of its window, or give it the focus: arrows move it by 0.1 s, with Shift by 1 s, Page Up and Page Down by 10 s; up and down go to the next test; space or a double click leaves it out or takes it in; Home puts it back.");
  choose(0);
  rows.forEach((_, at) => draw(at));
  show();
})();
