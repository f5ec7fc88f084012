"use strict";
// Lays a chart out for the width that it has: panels, numbers of axes, titles and room for the legend, so that no
// two letters stand in one place. Plotly is told every place and finds none itself.
window.shaftprintLayout = (() => {
  const NARROW = 600;
  // Room around panels, between them, and for letters [px].
  const ROOM = { above: 10, right: 14, below: 55, between: 18, numbers: 50, line: 16, row: 22, sample: 52, beside: 80 };
  const LETTER = 7.4;
  // Names of places stand upright where less than this is between them, slanted where they have no room beside each other [px].
  const UPRIGHT = 24;
  const SLANTED = 45;
  // A panel that is narrower has titles that begin left of it [px].
  const SLIM = 200;
  // A panel that is lower has its numbers closer together [px].
  const LOW = 140;
  // A field of a matrix that is narrower shows its colour only [px].
  const FIELD = 40;
  // On a phone a name beside a panel has lines of so many px, so that the panel keeps half of the width.
  const NAMED = 156;
  const FONT = 'system-ui, "Segoe UI", "Liberation Sans", Arial, sans-serif';

  const letters = (text) => text.replace(/<[^>]*>|&[^;]*;/g, (tag) => (tag.startsWith("&") ? "x" : "")).length;
  const longest = (names) => Math.max(0, ...names.flatMap((name) => name.split("<br>")).map(letters));

  // A text in as many lines as its room wants; tags hold no spaces.
  function wrapped(text, width) {
    const lines = [""];
    for (const word of text.split(" ")) {
      const last = lines[lines.length - 1];
      if (last && LETTER * letters(`${last} ${word}`) > width) lines.push(word);
      else lines[lines.length - 1] = last ? `${last} ${word}` : word;
    }
    return lines;
  }

  const linesOf = (text, width) => (text ? wrapped(text, width) : []);

  // Where each panel stands: side by side, or below each other on a phone.
  function cells(chart, narrow) {
    const named = ({ y, ...others }) => ({ ...others, y: { ...y, names: y.names.map((name) => wrapped(name, NAMED).join("<br>")) } });
    const places = chart.panels.map((panel, index) => ({
      panel: narrow ? named(panel) : panel, index, row: Math.floor(index / chart.columns), column: index % chart.columns,
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

  const leftOf = ({ panel, yTitle }) => ROOM.line * yTitle.length
    + (panel.y.names.length ? LETTER * longest(panel.y.names) + 12 : ROOM.numbers);

  // How names below a panel stand, and the room that they need [px].
  function namesBelow({ panel: { x } }, width) {
    const wide = LETTER * longest(x.names);
    const gap = width / Math.max(1, x.names.length);
    if (wide < gap) return { angle: 0, room: 0 };
    return gap < UPRIGHT ? { angle: 90, room: wide } : { angle: SLANTED, room: 0.75 * wide };
  }

  // Frames of all panels, with the margin around them.
  function frames(places, { width, height, share: lowered = 1 }, legendPx) {
    const columns = 1 + Math.max(...places.map((cell) => cell.column));
    const rows = 1 + Math.max(...places.map((cell) => cell.row));
    const inRow = (row) => places.filter((cell) => cell.row === row);
    for (const cell of places) cell.yTitle = linesOf(cell.panel.y.title, 0.85 * lowered * cell.height);
    const left = Math.max(...places.filter((cell) => cell.column === 0).map(leftOf));
    const beside = columns > 1 ? Math.max(...places.filter((cell) => cell.column > 0).map(leftOf)) : 0;
    const across = (width - left - ROOM.right - (columns - 1) * (beside + ROOM.right)) / columns;
    for (const cell of places) {
      // Where names at the left leave little room, titles begin above them.
      cell.outside = across < SLIM ? leftOf(cell) : 0;
      cell.title = linesOf(cell.panel.title, across + cell.outside);
      cell.xTitle = linesOf(cell.isLast ? cell.panel.x.title : "", across + cell.outside);
      cell.names = namesBelow(cell, across);
    }
    const title = (row) => Math.max(...inRow(row).map((cell) => (ROOM.line + 1) * cell.title.length + (cell.title.length ? 6 : 0)));
    const after = (row) => {
      const numbered = inRow(row).filter((cell) => cell.isLast);
      const labels = numbered.length ? ROOM.below + Math.max(...numbered.map(
        (cell) => cell.names.room + ROOM.line * Math.max(0, cell.xTitle.length - 1))) : 0;
      return row === rows - 1 ? labels + legendPx : Math.max(ROOM.between, labels) + title(row + 1);
    };
    const above = Math.max(ROOM.above, title(0) + 4);
    const gaps = Array.from({ length: rows }, (_, row) => after(row));
    const wanted = Array.from({ length: rows }, (_, row) => Math.max(...inRow(row).map((cell) => cell.height)));
    const share = (height - above - gaps.reduce((a, b) => a + b)) / wanted.reduce((a, b) => a + b);
    const area = { width: width - left - ROOM.right, height: height - above - gaps[rows - 1] };
    let top = 0;
    for (let row = 0; row < rows; row += 1) {
      const high = share * wanted[row];
      for (const cell of inRow(row)) {
        const from = cell.column * (across + beside + ROOM.right);
        cell.px = { width: across, height: high, left: leftOf(cell) };
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
    };
    if (scale.span) Object.assign(axis, { range: [...scale.span], autorange: false });
    if (scale.names.length) {
      Object.assign(axis, { tickmode: "array", tickvals: scale.names.map((_, place) => place), ticktext: scale.names,
                            showgrid: false });
    } else if (scale.log) {
      const decades = scale.span ? Math.abs(scale.span[1] - scale.span[0]) : 3;
      Object.assign(axis, { type: "log", dtick: lengthPx / decades > (which === "x" ? 150 : 70) ? "D2" : 1, tickformat: "~g" });
    } else if (scale.step) Object.assign(axis, { dtick: scale.step * (lengthPx < 110 ? 2 : 1), tick0: 0 });
    else axis.nticks = Math.max(3, Math.floor(lengthPx / (which === "x" ? 80 : lengthPx < LOW ? 22 : 34)));
    return axis;
  }

  const note = (text, place) => ({ text, xref: "paper", yref: "paper", showarrow: false, borderpad: 0, ...place });

  // Titles of a panel and of its axes. Plotly would put those of axes between the numbers where a margin is small.
  function titles(cell, narrow) {
    const { px, x, y } = cell;
    const size = narrow ? 12 : 13;
    const placed = [];
    if (cell.title.length) {
      placed.push(note(`<b>${cell.title.join("<br>")}</b>`, {
        x: x[0], y: y[1], xanchor: "left", yanchor: "bottom", align: "left", xshift: -cell.outside, yshift: 4, font: { size },
      }));
    }
    if (cell.xTitle.length) {
      const from = cell.outside ? { x: x[1], xanchor: "right", align: "right" } : { x: (x[0] + x[1]) / 2, xanchor: "center" };
      placed.push(note(cell.xTitle.join("<br>"), { ...from, y: y[0], yanchor: "top", yshift: -22 - cell.names.room, font: { size } }));
    }
    if (cell.yTitle.length) {
      placed.push(note(cell.yTitle.join("<br>"), {
        x: x[0], y: (y[0] + y[1]) / 2, xanchor: "left", xshift: -px.left, yanchor: "middle", textangle: -90, font: { size },
      }));
    }
    return placed;
  }

  // Words that would stand on others in their panel are left out.
  function readable(words, places) {
    const free = new Map();
    return words.filter((word) => {
      const cell = places.find((one) => word.xref === `x${one.index ? one.index + 1 : ""}`);
      if (!cell || !cell.panel.x.span) return true;
      const [low, high] = cell.panel.x.span;
      const wide = LETTER * letters(word.text);
      const middle = ((word.x - low) / (high - low)) * cell.px.width;
      const from = word.xanchor === "left" ? middle : word.xanchor === "right" ? middle - wide : middle - wide / 2;
      const row = `${word.xref} ${word.y}`;
      if (from < (free.get(row) ?? -Infinity)) return false;
      free.set(row, from + wide + 4);
      return true;
    });
  }

  // Entries of the legend, of so many letters each, follow each other row by row.
  function legendRows(entries, width) {
    let [rows, used] = [0, Infinity];
    for (const count of entries) {
      const wide = ROOM.sample + LETTER * count;
      if (used + wide > width) [rows, used] = [rows + 1, 0];
      used += wide;
    }
    return rows;
  }

  const keyOf = (axis, index) => `${axis}axis${index ? index + 1 : ""}`;

  // Plotly's layout of a chart in so many px.
  function layoutOf(chart, size, colours, coloured) {
    const { width, height } = size;
    const narrow = width < NARROW;
    const places = cells(chart, narrow);
    const margin = frames(places, size, ROOM.row * legendRows(chart.legend, width - ROOM.beside));
    const layout = {
      width, height, margin, barmode: "overlay", hovermode: "closest", dragmode: "zoom", uirevision: "kept", separators: ".\u202f",
      font: { family: FONT, size: narrow ? 12 : 13, color: colours.ink },
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
      hoverlabel: { bgcolor: colours.paper, bordercolor: colours.reference, font: { color: colours.ink } },
      legend: { orientation: "h", xref: "container", x: 0, xanchor: "left", yref: "container", y: 0, yanchor: "bottom",
                font: { size: 12 }, itemsizing: "trace", tracegroupgap: 2, bgcolor: "rgba(0,0,0,0)" },
      shapes: coloured(chart.shapes, colours),
      annotations: [...coloured(readable(chart.words, places), colours), ...places.flatMap((cell) => titles(cell, narrow))],
    };
    for (const cell of places) {
      const suffix = cell.index ? String(cell.index + 1) : "";
      const x = axisOf("x", cell.panel.x, cell.px.width, colours, narrow);
      const y = axisOf("y", cell.panel.y, cell.px.height, colours, narrow);
      Object.assign(x, { domain: cell.x, anchor: `y${suffix}`, tickangle: cell.names.angle });
      Object.assign(y, { domain: cell.y, anchor: `x${suffix}` });
      if (cell.partner !== cell.index) x.matches = `x${cell.partner ? cell.partner + 1 : ""}`;
      if (!cell.isLast) x.showticklabels = false;
      if (chart.square) {
        Object.assign(x, { constrain: "domain" });
        Object.assign(y, { constrain: "domain", scaleanchor: "x", scaleratio: 1 });
      }
      Object.assign(layout, { [keyOf("x", cell.index)]: x, [keyOf("y", cell.index)]: y });
    }
    return layout;
  }

  // Fields of a matrix without words, where these have no room.
  function fitted(traces, chart, width) {
    const names = Math.max(1, ...chart.panels.map((panel) => panel.x.names.length));
    return width / names > FIELD ? traces : traces.map((trace) => (
      trace.insidetextanchor ? { ...trace, textposition: "none" } : trace));
  }

  return { layoutOf, fitted, keyOf };
})();
