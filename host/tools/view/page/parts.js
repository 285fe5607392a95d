"use strict";
// What pages about pictures share: elements, a table of lights, and the commands that a page shows.

const byId = id => document.getElementById(id);

/** An element with these properties and children. */
function element(tag, properties, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

/** What a shell takes for this text and nothing else. */
const quoted = text => /^[\w.,=:#\/-]+$/.test(text) && !text.startsWith("#") ? text : "'" + text.replaceAll("'", "'\\''") + "'";

const isAsRendered = group => group.on && group.factor === 1 && group.color === "#ffffff";

/** The command that mixes a file's groups as the page shows them, at `exposure` stops. */
function mixCommand(file, groups, exposure) {
  const terms = groups.filter(group => !isAsRendered(group)).map(group =>
    group.name + "=" + (group.on ? group.factor : 0) + (group.color === "#ffffff" ? "" : ":" + group.color));
  return "luciole mix " + quoted(file) + (terms.length ? " --light-mixer " + quoted(terms.join(",")) : "") +
    (exposure ? " --exposure " + exposure.toFixed(1) : "") + " -o mixed.exr";
}

/**
 * Fills a table's body with a row a light: {name, on, factor, color: "#rrggbb"}, and `largest`, where its slider ends. An
 * input changes its light's member and calls changed(light). Returns the rows, [{light, row, show}], where show() shows
 * what the light is, but leaves alone what somebody types into.
 */
function lightTable(body, lights, changed) {
  const rows = lights.map(light => {
    const row = body.insertRow();
    row.insertCell().textContent = light.name;
    const addInput = (member, read, properties) => {
      const input = element("input", properties);
      input.ariaLabel = properties.label + " of " + light.name;
      input.addEventListener("input", () => {
        const value = read(input);
        if (Number.isNaN(value) || value < 0) return;
        light[member] = value;
        show();
        changed(light);
      });
      row.insertCell().append(input);
      return input;
    };
    const valueOf = input => input.valueAsNumber;
    const on = addInput("on", input => input.checked, {type: "checkbox", label: "Light"});
    const slider = addInput("factor", valueOf, {type: "range", min: 0, max: light.largest, step: light.largest / 400, label: "Strength"});
    const number = addInput("factor", valueOf, {type: "number", min: 0, step: "any", label: "Strength in numbers"});
    const color = addInput("color", input => input.value, {type: "color", label: "Colour"});
    const show = () => {
      on.checked = light.on;
      slider.value = light.factor;
      if (document.activeElement !== number) number.value = Number(light.factor.toPrecision(4));
      color.value = light.color;
    };
    show();
    return {light, row, show};
  });
  body.replaceChildren(...rows.map(({row}) => row));
  return rows;
}
