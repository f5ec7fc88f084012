"use strict";
// Draws the interactive figures of the page when they come near the screen, and switches between light and dark.
// A static figure is seen until its chart is drawn; in print, and where data or scripts are missing, it stays.
(() => {
  const NEAR = "500px 0px";
  const NARROW = 600;
  const NARROW_NUMBERS_PX = 11;
  const NARROW_GAP = 0.05;
  const PAN = 0.15;
  const ZOOM = 0.6;
  const CONFIG = {
    responsive: true,
    displaylogo: false,
    doubleClick: "reset",
    scrollZoom: false,
    // Nothing may leave the machine: no upload, no server, no link to one.
    showSendToCloud: false,
    showEditInChartStudio: false,
    showLink: false,
    sendData: false,
    plotlyServerURL: "",
    modeBarButtonsToRemove: ["sendChartToCloud", "select2d", "lasso2d"],
  };
  const COLOURS = {
    light: {
      "@0": "#003f6b", "@1": "#b03a00", "@2": "#007a5a", "@3": "#b0508c", "@4": "#2f86bd", "@5": "#a86f00",
      "@data": "#000000", "@ink": "#1a1a1a", "@grid": "#dde1e4", "@reference": "#6a6f74", "@soft": "#b9b9b9",
      "@paper": "#ffffff",
    },
    dark: {
      "@0": "#6db3e2", "@1": "#f2925a", "@2": "#4cc3a0", "@3": "#e593c4", "@4": "#a8d4f2", "@5": "#f0c04a",
      "@data": "#ffffff", "@ink": "#e6e8ea", "@grid": "#343c42", "@reference": "#9aa3aa", "@soft": "#6d757b",
      "@paper": "#15191c",
    },
  };
  const root = document.documentElement;
  const figures = new Map();
  // Kept when plotly is there.
  let library;
  // Kept when the last chart that was asked for is there.
  let drawn = Promise.resolve();

  const darkScreen = window.matchMedia("(prefers-color-scheme: dark)");
  const look = () => root.dataset.look || (darkScreen.matches ? "dark" : "light");

  // Long signals come as whole numbers of 16 bits in base 64; the lowest stands for a gap.
  function unpacked({ int16, scale, offset }) {
    const bytes = Uint8Array.from(atob(int16), (letter) => letter.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    return Float64Array.from({ length: bytes.length / 2 }, (_, place) => {
      const count = view.getInt16(2 * place, true);
      return count === -32768 ? NaN : offset + scale * count;
    });
  }

  function coloured(value, colours) {
    if (typeof value === "string" && value.startsWith("@")) {
      const plain = colours[value.replace(/~$/, "")];
      // A band is thin paint; a name that begins with the sign stays as it is.
      return plain === undefined ? value : value.endsWith("~") ? `${plain}47` : plain;
    }
    if (Array.isArray(value)) {
      // Long lists of numbers hold no colours.
      return typeof value[0] === "number" ? value : value.map((part) => coloured(part, colours));
    }
    if (value !== null && typeof value === "object") {
      if (value.int16 !== undefined) return unpacked(value);
      return Object.fromEntries(Object.entries(value).map(([key, part]) => [key, coloured(part, colours)]));
    }
    return value;
  }

  const isAxis = (key) => /^[xy]axis\d*$/.test(key);

  // Numbers at 2 and 5 of each decade would overlap, and those of one panel would stand in the panel beside it.
  function fitOnNarrow(axis, key) {
    if (axis.type === "log") axis.dtick = 1;
    axis.tickfont = { size: NARROW_NUMBERS_PX };
    if (key[0] !== "x" || !axis.domain) return;
    const [from, to] = axis.domain;
    axis.domain = [from > 0 ? from + NARROW_GAP : from, to < 1 ? to - NARROW_GAP : to];
  }

  function layoutOf(figure, colours, narrow) {
    const layout = coloured(figure.layout, colours);
    layout.paper_bgcolor = "rgba(0,0,0,0)";
    layout.plot_bgcolor = "rgba(0,0,0,0)";
    layout.font.color = colours["@ink"];
    layout.hoverlabel = { bgcolor: colours["@paper"], bordercolor: colours["@reference"],
                          font: { color: colours["@ink"] } };
    layout.modebar = { bgcolor: "rgba(0,0,0,0)", color: colours["@reference"], activecolor: colours["@ink"] };
    layout.uirevision = "kept";
    for (const key of Object.keys(layout).filter(isAxis)) {
      layout[key].gridcolor = colours["@grid"];
      layout[key].linecolor = colours["@reference"];
      layout[key].tickcolor = colours["@reference"];
      if (narrow) fitOnNarrow(layout[key], key);
    }
    return layout;
  }

  function draw(name) {
    const { place, figure } = figures.get(name);
    const colours = COLOURS[look()];
    const config = { ...CONFIG, toImageButtonOptions: { format: "svg", filename: name } };
    const layout = layoutOf(figure, colours, place.clientWidth < NARROW);
    return window.Plotly.react(place, coloured(figure.data, colours), layout, config).then(() => {
      if (place.dataset.state === "drawn") return;
      // The style sheet puts the chart in the place of its static figure.
      place.dataset.state = "drawn";
      performance.mark("plot drawn");
      fetchPictures();
    });
  }

  // Static figures far from the screen wait for the first plot, and are there when the page is printed.
  function fetchPictures() {
    for (const picture of document.querySelectorAll('img[loading="lazy"]')) picture.loading = "eager";
  }

  // Without its data, or without plotly, a figure is the static one.
  function giveUp(place) {
    place.closest("figure").classList.remove("has-plot");
    place.parentElement.querySelector("img").removeAttribute("aria-hidden");
  }

  function fetchData(place) {
    const name = place.dataset.plot;
    if (figures.has(name)) return;
    figures.set(name, { place, figure: null });
    // The page itself asks for the data of its first figure.
    const early = document.getElementById("first-data");
    const script = early && early.dataset.plot === name ? early : document.createElement("script");
    script.addEventListener("error", () => giveUp(place));
    if (script === early) return;
    script.src = place.dataset.source;
    document.head.append(script);
  }

  // Each file of data calls this with its figure. Charts are drawn one after the other, so that the first is seen soon.
  window.shaftprintPlot = (name, figure) => {
    figures.get(name).figure = figure;
    drawn = drawn.then(() => library).then(() => draw(name)).catch((problem) => {
      giveUp(figures.get(name).place);
      if (problem) console.error(problem);
    }).then(() => new Promise((next) => setTimeout(next)));
  };

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
      if (direction.includes(key[0]) && axis.type !== "category" && !axis.matches) {
        change[`${key}.range`] = shifted(axis, share, factor);
      }
    }
    window.Plotly.relayout(place, change);
  }

  function showAll(place, name) {
    if (!place._fullLayout) return;
    const { figure } = figures.get(name);
    const change = {};
    for (const key of Object.keys(figure.layout).filter(isAxis)) {
      const range = figure.layout[key].range;
      change[range ? `${key}.range` : `${key}.autorange`] = range ? [...range] : figure.layout[key].autorange || true;
    }
    window.Plotly.relayout(place, change);
  }

  function zoomed(place, factor) {
    const square = place._fullLayout && place._fullLayout.yaxis && place._fullLayout.yaxis.scaleanchor;
    moved(place, square ? "xy" : "x", 0, factor);
  }

  function actions(place, name) {
    return {
      ArrowLeft: () => moved(place, "x", -PAN, 1),
      ArrowRight: () => moved(place, "x", PAN, 1),
      ArrowUp: () => moved(place, "y", PAN, 1),
      ArrowDown: () => moved(place, "y", -PAN, 1),
      "+": () => zoomed(place, ZOOM),
      "=": () => zoomed(place, ZOOM),
      "-": () => zoomed(place, 1 / ZOOM),
      0: () => showAll(place, name),
    };
  }

  function button(words, label, act) {
    const made = document.createElement("button");
    made.type = "button";
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
    );
    place.before(bar);
    // Both say the same; where the picture alone is seen, it is named again.
    place.parentElement.querySelector("img").setAttribute("aria-hidden", "true");
  }

  function prepareLook() {
    const chosen = document.getElementById("look");
    const say = () => {
      chosen.textContent = look() === "dark" ? "Light look" : "Dark look";
      for (const [name, { place }] of figures) if (place.dataset.state === "drawn") draw(name);
    };
    chosen.hidden = false;
    chosen.addEventListener("click", () => {
      root.dataset.look = look() === "dark" ? "light" : "dark";
      try {
        localStorage.setItem("shaftprint-look", root.dataset.look);
      } catch {
        // A browser may keep nothing for pages from a disk; the choice then holds for this page.
      }
      say();
    });
    darkScreen.addEventListener("change", say);
    say();
  }

  // A link to a folded section opens it; the menu of a narrow screen closes once it has been used.
  function prepareContents() {
    const parts = [...document.querySelectorAll("details")];
    const openAddressed = () => {
      const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
      const part = target && target.closest("details");
      if (!part) return;
      part.open = true;
      part.scrollIntoView();
    };
    window.addEventListener("hashchange", openAddressed);
    const contents = document.getElementById("contents");
    contents.addEventListener("click", (event) => {
      if (!event.target.closest("a")) return;
      if (contents.matches(":popover-open")) contents.hidePopover();
      // The address may be the one that stands already.
      setTimeout(openAddressed);
    });
    const unfold = document.getElementById("unfold");
    if (unfold) unfold.addEventListener("click", () => parts.forEach((part) => { part.open = true; }));
    openAddressed();
  }

  function prepareFigures() {
    const places = document.querySelectorAll(".plot");
    const script = document.getElementById("library");
    library = new Promise((ready, failed) => {
      script.addEventListener("load", () => (window.Plotly ? ready() : failed()));
      script.addEventListener("error", () => failed());
    });
    library.catch(() => {
      places.forEach(giveUp);
      fetchPictures();
    });
    places.forEach(prepare);
    const watcher = new IntersectionObserver((entries) => {
      for (const entry of entries.filter((found) => found.isIntersecting)) {
        watcher.unobserve(entry.target);
        fetchData(entry.target);
      }
    }, { rootMargin: NEAR });
    places.forEach((place) => watcher.observe(place));
    if (places.length) fetchData(places[0]);
  }

  try {
    const kept = localStorage.getItem("shaftprint-look");
    if (kept === "light" || kept === "dark") root.dataset.look = kept;
  } catch {
    // As above.
  }
  // The page waits for this script, so it is painted at once as it will stay: its look, and room for its charts.
  root.classList.add("scripted");
  window.addEventListener("beforeprint", fetchPictures);
  document.addEventListener("readystatechange", () => {
    // All of the page is read, and plotly's script has not run yet.
    if (document.readyState !== "interactive") return;
    prepareLook();
    prepareContents();
    prepareFigures();
  });
})();
