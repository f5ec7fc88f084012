"use strict";
// Lays out and draws the charts of the page when they come near the screen, and all of them before it is printed.
(() => {
  const NEAR = "500px 0px";
  const NARROW = 600;
  const PAN = 0.15;
  const ZOOM = 0.6;
  // Room around panels, between them, and for letters [px].
  const ROOM = { above: 30, right: 14, below: 52, between: 18, title: 30, numbers: 58, column: 62, row: 20, sample: 48 };
  const LETTER = 7;
  const FONT = 'system-ui, "Segoe UI", "Liberation Sans", Arial, sans-serif';
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
  const root = document.documentElement;
  const charts = new Map();
  const darkScreen = window.matchMedia("(prefers-color-scheme: dark)");
  const look = () => root.dataset.look || (darkScreen.matches ? "dark" : "light");
  // Kept when plotly is there, and when the last chart that was asked for is drawn.
  let library;
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

  // ---- layout by the width of the page

  const letters = (text) => text.replace(/<[^>]*>|&[^;]*;/g, (tag) => (tag.startsWith("&") ? "x" : "")).length;
  const longest = (names) => Math.max(0, ...names.map(letters));

  // A text on as many lines as its room wants; tags hold no spaces.
  function wrapped(text, width) {
    const lines = [""];
    for (const word of text.split(" ")) {
      const last = lines[lines.length - 1];
      if (last && LETTER * letters(`${last} ${word}`) > width) lines.push(word);
      else lines[lines.length - 1] = last ? `${last} ${word}` : word;
    }
    return lines.join("<br>");
  }

  // Where each panel stands: side by side, or below each other on a phone.
  function cells(chart, narrow) {
    const places = chart.panels.map((panel, index) => ({
      panel, index, row: Math.floor(index / chart.columns), column: index % chart.columns,
    }));
    for (const cell of places) {
      cell.height = chart.heights[cell.row];
      cell.isLast = chart.linked === "none" || cell.index + chart.columns >= places.length;
      cell.partner = chart.linked === "all" ? 0 : chart.linked === "columns" ? cell.column : cell.index;
    }
    if (!narrow || chart.columns === 1) return places;
    if (chart.linked !== "none") places.sort((a, b) => a.column - b.column || a.row - b.row);
    places.forEach((cell, place) => Object.assign(cell, { row: place, column: 0 }));
    return places;
  }

  const leftOf = (cell) => {
    const names = cell.panel.y.names;
    return names.length ? LETTER * longest(names) + 12 : ROOM.numbers;
  };

  // The room of upright names, where they have not enough beside each other.
  function namesRoom(cell, width) {
    const names = cell.panel.x.names;
    return LETTER * longest(names) * names.length > width ? 4 * longest(names) : 0;
  }

  function frames(chart, places, width, height, legendPx) {
    const columns = 1 + Math.max(...places.map((cell) => cell.column));
    const rows = 1 + Math.max(...places.map((cell) => cell.row));
    const inRow = (row) => places.filter((cell) => cell.row === row);
    const left = Math.max(...places.filter((cell) => cell.column === 0).map(leftOf));
    const beside = columns > 1 ? Math.max(...places.filter((cell) => cell.column > 0).map(
      (cell) => leftOf(cell) - (cell.panel.y.names.length || cell.panel.y.title ? 0 : 14))) : 0;
    const across = (width - left - ROOM.right - (columns - 1) * (beside + ROOM.right)) / columns;
    const titled = (row) => inRow(row).some((cell) => cell.panel.title);
    const above = titled(0) ? ROOM.above : 10;
    const after = (row) => {
      const labels = inRow(row).some((cell) => cell.isLast) ? ROOM.below + Math.max(...inRow(row).map((c) => namesRoom(c, across))) : 0;
      return row === rows - 1 ? labels + legendPx : Math.max(ROOM.between, labels) + (titled(row + 1) ? ROOM.title : 0);
    };
    const gaps = Array.from({ length: rows }, (_, row) => after(row));
    const wanted = Array.from({ length: rows }, (_, row) => Math.max(...inRow(row).map((cell) => cell.height)));
    const share = (height - above - gaps.reduce((a, b) => a + b)) / wanted.reduce((a, b) => a + b);
    const area = { width: width - left - ROOM.right, height: height - above - gaps[rows - 1] };
    let top = 0;
    for (let row = 0; row < rows; row += 1) {
      const high = share * wanted[row];
      for (const cell of inRow(row)) {
        const from = cell.column * (across + beside + ROOM.right);
        cell.px = { width: across, height: high };
        cell.x = [from / area.width, Math.min(1, (from + across) / area.width)];
        cell.y = [Math.max(0, 1 - (top + high) / area.height), Math.min(1, 1 - top / area.height)];
      }
      top += high + gaps[row];
    }
    return { l: left, r: ROOM.right, t: above, b: gaps[rows - 1], pad: 0, autoexpand: false };
  }

  function axisOf(which, scale, lengthPx, colours, narrow) {
    const axis = {
      zeroline: false, showline: true, mirror: true, ticks: "outside", ticklen: 4, exponentformat: "none",
      gridcolor: colours.grid, linecolor: colours.reference, tickcolor: colours.reference,
      tickfont: { size: narrow ? 11 : 12 }, automargin: false,
      title: { text: wrapped(scale.title, lengthPx), standoff: 6, font: { size: narrow ? 12 : 13 } },
    };
    if (scale.span) Object.assign(axis, { range: [...scale.span], autorange: false });
    if (scale.names.length) {
      Object.assign(axis, { tickmode: "array", tickvals: scale.names.map((_, place) => place), ticktext: scale.names,
                            showgrid: false });
    } else if (scale.log) {
      const decades = scale.span ? Math.abs(scale.span[1] - scale.span[0]) : 3;
      Object.assign(axis, { type: "log", dtick: lengthPx / decades > 150 ? "D2" : 1, tickformat: "~g" });
    } else if (scale.step) Object.assign(axis, { dtick: scale.step * (lengthPx < 110 ? 2 : 1), tick0: 0 });
    else axis.nticks = Math.max(4, Math.floor(lengthPx / (which === "x" ? 75 : 34)));
    return axis;
  }

  function layoutOf(chart, place, colours) {
    const [width, height] = [place.clientWidth, place.clientHeight];
    const narrow = width < NARROW;
    const widest = ROOM.sample + LETTER * Math.max(0, ...chart.legend);
    const legendRows = Math.ceil(chart.legend.length / Math.max(1, Math.floor(width / widest)));
    const places = cells(chart, narrow);
    const margin = frames(chart, places, width, height, legendRows * ROOM.row);
    const layout = {
      width, height, margin, barmode: "overlay", hovermode: "closest", dragmode: "zoom", uirevision: "kept", separators: ".\u202f",
      font: { family: FONT, size: narrow ? 12 : 13, color: colours.ink },
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
      hoverlabel: { bgcolor: colours.paper, bordercolor: colours.reference, font: { color: colours.ink } },
      legend: { orientation: "h", xref: "container", x: 0, xanchor: "left", yref: "container", y: 0, yanchor: "bottom",
                font: { size: 12 }, itemsizing: "trace", bgcolor: "rgba(0,0,0,0)" },
      shapes: coloured(chart.shapes, colours),
      annotations: coloured(chart.words, colours),
    };
    for (const cell of places) {
      const suffix = cell.index ? String(cell.index + 1) : "";
      const x = axisOf("x", cell.panel.x, cell.px.width, colours, narrow);
      const y = axisOf("y", cell.panel.y, cell.px.height, colours, narrow);
      Object.assign(x, { domain: cell.x, anchor: `y${suffix}` });
      Object.assign(y, { domain: cell.y, anchor: `x${suffix}` });
      if (cell.partner !== cell.index) x.matches = `x${cell.partner ? cell.partner + 1 : ""}`;
      if (!cell.isLast) Object.assign(x, { showticklabels: false, title: { text: "" } });
      if (chart.square) {
        Object.assign(x, { constrain: "domain" });
        Object.assign(y, { constrain: "domain", scaleanchor: "x", scaleratio: 1 });
      }
      Object.assign(layout, { [`xaxis${suffix}`]: x, [`yaxis${suffix}`]: y });
      if (cell.panel.title) {
        layout.annotations.push({
          text: `<b>${wrapped(cell.panel.title, cell.px.width)}</b>`, xref: "paper", yref: "paper", x: cell.x[0],
          y: cell.y[1], xanchor: "left", yanchor: "bottom", align: "left", yshift: 3, showarrow: false,
          font: { size: narrow ? 12 : 13 },
        });
      }
    }
    return layout;
  }

  // ---- drawing

  function draw(name, shade = look()) {
    const entry = charts.get(name);
    const { place, chart } = entry;
    const layout = layoutOf(chart, place, COLOURS[shade]);
    entry.width = layout.width;
    const drawn = window.Plotly.react(place, coloured(chart.data, COLOURS[shade]), layout, CONFIG);
    // On paper the drawing becomes as wide as the page.
    for (const svg of place.querySelectorAll(".main-svg")) svg.setAttribute("viewBox", `0 0 ${layout.width} ${layout.height}`);
    place.style.setProperty("--ratio", layout.width / layout.height);
    if (place.dataset.state !== "drawn") {
      place.dataset.state = "drawn";
      performance.mark("plot drawn");
    }
    return drawn;
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

  // Paper is light, and has what is not folded: what is not drawn yet is, and what is dark is drawn again.
  function drawForPaper() {
    if (!window.Plotly) return;
    for (const [name, { chart, place }] of charts) {
      if (chart && !isFolded(place) && (look() !== "light" || place.dataset.state !== "drawn")) draw(name, "light");
    }
  }

  function drawAgain() {
    for (const [name, { place }] of charts) if (place.dataset.state === "drawn") draw(name);
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
        const key = `${which}axis${index ? index + 1 : ""}`;
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
    // The data of far charts come when the page is at rest, so that all can be drawn before it is printed.
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
    window.addEventListener("afterprint", () => look() === "light" || drawAgain());
  }

  // Words stand in place of the charts where this script does not run.
  root.classList.add("charted");
  document.addEventListener("readystatechange", () => {
    // All of the page is read, and plotly's script has not run yet.
    if (document.readyState === "interactive") prepareCharts();
  });
})();
