"use strict";
// Draws the charts of the page when they come near the screen, and all that are not folded before it is printed.
(() => {
  const NEAR = "500px 0px";
  const PAN = 0.15;
  const ZOOM = 0.6;
  const CONFIG = {
    displayModeBar: false,
    displaylogo: false,
    doubleClick: "reset",
    scrollZoom: false,
    // Nothing may leave the machine: no upload, no server, no link to one.
    showSendToCloud: false,
    showEditInChartStudio: false,
    showLink: false,
    sendData: false,
    plotlyServerURL: "",
  };
  const COLOURS = {
    light: {
      0: "#003f6b", 1: "#b03a00", 2: "#007a5a", 3: "#b0508c", 4: "#2f86bd", 5: "#a86f00",
      data: "#000000", ink: "#1a1a1a", grid: "#dde1e4", reference: "#6a6f74", soft: "#b9b9b9", early: "#d9762b",
      paper: "#ffffff", low: "#1f5f9e", high: "#b5361c",
    },
    dark: {
      0: "#6db3e2", 1: "#f2925a", 2: "#4cc3a0", 3: "#e593c4", 4: "#b9c4ff", 5: "#f0c04a",
      data: "#ffffff", ink: "#e6e8ea", grid: "#343c42", reference: "#9aa3aa", soft: "#6d757b", early: "#f0a35e",
      paper: "#15191c", low: "#6db3e2", high: "#f2925a",
    },
  };
  const { layoutOf, fitted, keyOf } = window.shaftprintLayout;
  // Width of a sheet between its margins, and how high panels are on it, of their height on a screen: a Bode diagram,
  // over a logarithmic frequency, is read off on paper too, and has rows of 40 mm at least; names need a line each.
  const PAPER_PX = 688;
  const PAPER_SHARE = 0.45;
  const BODE_SHARE = 0.7;
  const NAMES_SHARE = 0.52;
  const root = document.documentElement;
  const charts = new Map();
  const darkScreen = window.matchMedia("(prefers-color-scheme: dark)");
  const look = () => root.dataset.look || (darkScreen.matches ? "dark" : "light");
  // Kept when plotly is there, and when the last chart that was asked for is drawn.
  let library;
  let textures = 0;
  let queue = Promise.resolve();

  // ---- data and colours

  // Long lists come as whole numbers of 16 bits in base 64; the lowest stands for a gap.
  function unpacked({ int16, scale, offset }) {
    const bytes = Uint8Array.from(atob(int16), (letter) => letter.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    return Float64Array.from({ length: bytes.length / 2 }, (_, place) => {
      const count = view.getInt16(2 * place, true);
      return count === -32768 ? NaN : offset + scale * count;
    });
  }

  const channels = (colour) => [1, 3, 5].map((place) => parseInt(colour.slice(place, place + 2), 16));

  // A field between -1 and 1: from one hue through the paper to the other.
  function signed(value, colours) {
    const end = channels(value < 0 ? colours.low : colours.high);
    const share = Math.min(1, Math.abs(value));
    return channels(colours.paper).map((c, i) => Math.round(c + share * (end[i] - c)));
  }

  // What is written on a colour: of black and white the one with more contrast, 4.5 at least (WCAG's luminance).
  function inkOn(rgb) {
    const linear = rgb.map((c) => c / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2] > 0.179 ? "#000000" : "#ffffff";
  }

  function painted(text, colours) {
    if (text.startsWith("@=")) return `rgb(${signed(Number(text.slice(2)), colours).join(",")})`;
    if (text.startsWith("@on=")) return inkOn(signed(Number(text.slice(4)), colours));
    const colour = colours[text.slice(1).replace(/~$/, "")];
    // A band is thin paint; a name that begins with the sign stays as it is.
    return colour === undefined ? text : text.endsWith("~") ? `${colour}47` : colour;
  }

  function coloured(value, colours) {
    if (typeof value === "string") return value.startsWith("@") ? painted(value, colours) : value;
    if (Array.isArray(value)) {
      // Long lists of numbers hold no colours.
      return typeof value[0] === "number" ? value : value.map((part) => coloured(part, colours));
    }
    if (value === null || typeof value !== "object") return value;
    if (value.int16 !== undefined) return unpacked(value);
    return Object.fromEntries(Object.entries(value).map(([key, part]) => [key, coloured(part, colours)]));
  }

  // ---- drawing

  const screen = (place) => ({ width: place.clientWidth, height: place.clientHeight });

  function paper({ place, chart }) {
    const { x, y } = chart.panels[0];
    const share = y.names.length ? NAMES_SHARE : x.log ? BODE_SHARE : PAPER_SHARE;
    const saved = (1 - share) * chart.heights.reduce((a, b) => a + b);
    return { width: PAPER_PX, height: parseFloat(place.style.getPropertyValue("--height")) - saved, share };
  }

  function draw(name, shade = look(), size = screen(charts.get(name).place)) {
    const entry = charts.get(name);
    const { place, chart } = entry;
    const layout = layoutOf(chart, size, COLOURS[shade], coloured);
    entry.width = layout.width;
    // Plotly would take them for its own bars.
    for (const old of place.querySelectorAll(".texture")) old.remove();
    const data = fitted(coloured(chart.data, COLOURS[shade]), chart, size.width);
    const drawn = window.Plotly.react(place, data, layout, CONFIG);
    // On paper the drawing becomes as wide as the page.
    for (const svg of place.querySelectorAll(".main-svg")) svg.setAttribute("viewBox", `0 0 ${layout.width} ${layout.height}`);
    place.style.setProperty("--ratio", layout.width / layout.height);
    if (place.dataset.state !== "drawn") {
      place.dataset.state = "drawn";
      performance.mark("plot drawn");
    }
    return drawn;
  }

  // A browser prints a pattern as a bitmap as large as what it fills, megabytes for a chart: paper gets its colour and
  // its lines themselves, tile by tile, until the chart is drawn again.
  function drawTextures(place) {
    for (const bar of place.querySelectorAll(".pattern_filled")) {
      const pattern = document.getElementById(bar.style.fill.match(/#([^")]+)/)?.[1]);
      const [ground, ...lines] = pattern ? pattern.children : [];
      if (!ground) continue;
      const scale = Number(pattern.getAttribute("patternTransform")?.match(/scale\(([^)]+)\)/)?.[1] ?? 1);
      const [wide, high] = ["width", "height"].map((side) => parseFloat(pattern.getAttribute(side)) * scale);
      const box = bar.getBBox();
      const made = (name, attributes) => {
        const element = document.createElementNS("http://www.w3.org/2000/svg", name);
        for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
        return element;
      };
      const id = `texture-${place.dataset.plot}-${textures += 1}`;
      const clip = made("clipPath", { id });
      clip.append(made("path", { d: bar.getAttribute("d") }));
      const drawn = made("g", { class: "texture", transform: bar.getAttribute("transform") ?? "" });
      const tiles = made("g", { "clip-path": `url(#${id})` });
      for (let x = Math.floor(box.x / wide) * wide; x < box.x + box.width; x += wide) {
        for (let y = Math.floor(box.y / high) * high; y < box.y + box.height; y += high) {
          const tile = made("g", { transform: `translate(${x} ${y}) scale(${scale})` });
          tile.append(...lines.map((line) => line.cloneNode()));
          tiles.append(tile);
        }
      }
      bar.style.fill = ground.getAttribute("fill");
      drawn.append(clip, tiles);
      bar.after(drawn);
    }
  }

  // Without its data, or without plotly, words stand in place of a chart.
  const giveUp = (place) => place.closest("figure").classList.add("lost");

  function fetchData(place) {
    const name = place.dataset.plot;
    if (charts.has(name)) return;
    charts.set(name, { place, chart: null, wanted: false });
    // The page itself asks for the data of its first chart.
    const early = document.getElementById("first-data");
    const script = early && early.dataset.plot === name ? early : document.createElement("script");
    script.addEventListener("error", () => giveUp(place));
    if (script === early) return;
    script.src = place.dataset.source;
    document.head.append(script);
  }

  // Charts are drawn one after the other, so that the first is seen soon.
  function drawInTurn(name) {
    const entry = charts.get(name);
    if (!entry.chart || !entry.wanted || entry.place.dataset.state === "drawn") return;
    queue = queue.then(() => library).then(() => draw(name)).catch((problem) => {
      giveUp(entry.place);
      if (problem) console.error(problem);
    }).then(() => new Promise((next) => setTimeout(next)));
  }

  // Each file of data calls this with its chart.
  window.shaftprintChart = (name, chart) => {
    const entry = charts.get(name);
    entry.chart = chart;
    entry.place.dataset.state = "ready";
    drawInTurn(name);
  };

  const isFolded = (place) => place.closest("details:not([open])") !== null;

  // Paper is light, has its own width and what is not folded.
  function drawForPaper() {
    if (!window.Plotly) return;
    for (const [name, entry] of charts) {
      if (!entry.chart || isFolded(entry.place)) continue;
      draw(name, "light", paper(entry));
      drawTextures(entry.place);
    }
  }

  function drawAgain() {
    for (const [name, { place }] of charts) if (place.dataset.state === "drawn" && !isFolded(place)) draw(name);
  }

  // ---- moving

  const isAxis = (key) => /^[xy]axis\d*$/.test(key);

  function shifted(axis, share, factor) {
    const [low, high] = axis.range;
    const width = high - low;
    const middle = (low + high) / 2 + share * width;
    return [middle - (factor * width) / 2, middle + (factor * width) / 2];
  }

  function moved(place, direction, share, factor) {
    const full = place._fullLayout;
    if (!full) return;
    const change = {};
    for (const key of Object.keys(full).filter(isAxis)) {
      const axis = full[key];
      if (direction.includes(key[0]) && axis.tickmode !== "array" && !axis.matches) {
        change[`${key}.range`] = shifted(axis, share, factor);
      }
    }
    window.Plotly.relayout(place, change);
  }

  function showAll(place, name) {
    if (!place._fullLayout) return;
    const change = {};
    charts.get(name).chart.panels.forEach((panel, index) => {
      for (const which of ["x", "y"]) {
        const key = keyOf(which, index);
        const { span } = panel[which];
        change[span ? `${key}.range` : `${key}.autorange`] = span ? [...span] : true;
      }
    });
    window.Plotly.relayout(place, change);
  }

  function zoomed(place, name, factor) {
    moved(place, charts.get(name)?.chart?.square ? "xy" : "x", 0, factor);
  }

  function save(place, name) {
    if (place._fullLayout) window.Plotly.downloadImage(place, { format: "svg", filename: name, width: place.clientWidth, height: place.clientHeight });
  }

  function actions(place, name) {
    return {
      ArrowLeft: () => moved(place, "x", -PAN, 1),
      ArrowRight: () => moved(place, "x", PAN, 1),
      ArrowUp: () => moved(place, "y", PAN, 1),
      ArrowDown: () => moved(place, "y", -PAN, 1),
      "+": () => zoomed(place, name, ZOOM),
      "=": () => zoomed(place, name, ZOOM),
      "-": () => zoomed(place, name, 1 / ZOOM),
      0: () => showAll(place, name),
      s: () => save(place, name),
    };
  }

  // ---- one cursor for all charts over the same quantity

  const clearCursors = () => document.querySelectorAll(".cursor").forEach((line) => line.remove());

  function showCursors(title, value) {
    clearCursors();
    for (const { place, chart } of charts.values()) {
      const full = place.dataset.state === "drawn" && place._fullLayout;
      (full ? chart.panels : []).forEach((panel, index) => {
        const [x, y] = [full[keyOf("x", index)], full[keyOf("y", index)]];
        const at = x.c2p(value);
        if (panel.x.title !== title || panel.x.names.length || !(at >= 0 && at <= x._length)) return;
        const line = document.createElement("div");
        line.className = "cursor";
        Object.assign(line.style, { left: `${x._offset + at}px`, top: `${y._offset}px`, height: `${y._length}px` });
        place.append(line);
      });
    }
  }

  function followPointer(place, name) {
    place.addEventListener("mousemove", (event) => {
      const full = place._fullLayout;
      if (!full || event.buttons) return clearCursors();
      const box = place.getBoundingClientRect();
      const [left, top] = [event.clientX - box.left, event.clientY - box.top];
      const isOver = (axis, at) => at >= axis._offset && at <= axis._offset + axis._length;
      const index = charts.get(name).chart.panels.findIndex((_, one) => (
        isOver(full[keyOf("x", one)], left) && isOver(full[keyOf("y", one)], top)));
      if (index < 0) return clearCursors();
      const x = full[keyOf("x", index)];
      return showCursors(charts.get(name).chart.panels[index].x.title, x.p2c(left - x._offset));
    });
    place.addEventListener("mouseleave", clearCursors);
  }

  function button(words, label, act) {
    const made = document.createElement("button");
    made.type = "button";
    // The chart itself takes the keys: one stop on the way through the page, not seven.
    made.tabIndex = -1;
    made.textContent = words;
    made.setAttribute("aria-label", label);
    made.addEventListener("click", act);
    return made;
  }

  function prepare(place) {
    const name = place.dataset.plot;
    const keys = actions(place, name);
    followPointer(place, name);
    place.addEventListener("keydown", (event) => {
      const act = keys[event.key];
      if (!act || event.target !== place || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      act();
    });
    const bar = document.createElement("div");
    bar.className = "bar";
    bar.append(
      button("+", "Zoom in", keys["+"]),
      button("−", "Zoom out", keys["-"]),
      button("◀", "Move left", keys.ArrowLeft),
      button("▶", "Move right", keys.ArrowRight),
      button("Show all", "Show all again", keys[0]),
      button("Save", "Save the chart as SVG", keys.s),
    );
    place.before(bar);
  }

  // ---- the page

  function prepareCharts() {
    const places = [...document.querySelectorAll(".plot")];
    const script = document.getElementById("library");
    library = new Promise((ready, failed) => {
      script.addEventListener("load", () => (window.Plotly ? ready() : failed()));
      script.addEventListener("error", () => failed());
    });
    library.catch(() => places.forEach(giveUp));
    places.forEach(prepare);
    const want = (place) => {
      fetchData(place);
      charts.get(place.dataset.plot).wanted = true;
      drawInTurn(place.dataset.plot);
    };
    const watcher = new IntersectionObserver((entries) => {
      for (const entry of entries.filter((found) => found.isIntersecting)) {
        watcher.unobserve(entry.target);
        want(entry.target);
      }
    }, { rootMargin: NEAR });
    places.forEach((place) => watcher.observe(place));
    if (places.length) want(places[0]);
    // What is printed comes before the page counts as loaded, since some print it then; what is folded when it is at rest.
    library.then(() => places.filter((place) => !isFolded(place)).forEach(fetchData), () => {});
    library.then(() => queue).then(() => places.forEach(fetchData), () => {});
    const resized = new ResizeObserver((entries) => {
      for (const { target } of entries) {
        const entry = charts.get(target.dataset.plot);
        const changed = target.clientWidth && Math.abs(target.clientWidth - entry?.width) > 1;
        if (target.dataset.state === "drawn" && changed && !window.matchMedia("print").matches) draw(target.dataset.plot);
      }
    });
    places.forEach((place) => resized.observe(place));
    document.addEventListener("look", drawAgain);
    window.addEventListener("beforeprint", drawForPaper);
    window.addEventListener("afterprint", drawAgain);
  }

  // Words stand in place of the charts where this script does not run.
  root.classList.add("charted");
  document.addEventListener("readystatechange", () => {
    // All of the page is read, and plotly's script has not run yet.
    if (document.readyState === "interactive") prepareCharts();
  });
})();
