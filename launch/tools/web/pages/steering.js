// SPDX-License-Identifier: Apache-2.0
// Orders to a run: set, scale, stop. Shown to who came with the token.

import { mayAct, post, runPath } from "./requests.js";

const $ = (id) => document.getElementById(id);

let run = null;

async function order(verb, args) {
  const answer = $("steering-answer");
  answer.textContent = "…";
  answer.className = "";
  try {
    answer.textContent = (await post(runPath(run, "/order"), { verb, arguments: args })).text;
  } catch (error) {
    answer.textContent = error.message;
    answer.className = "notice";
  }
}

const on = (form, act) => $(form).addEventListener("submit", (event) => {
  event.preventDefault();
  act();
});
on("set-form", () => order("set", [$("set-key").value + "=" + $("set-value").value.trim()]));
on("scale-form", () => order("scale", [$("scale-actors").value]));
on("stop-form", () => {
  $("stop-sure").checked = false;
  order("stop", []);
});

export function offerSteering(name, keys, running) {
  if (run !== name) $("steering-answer").textContent = "";
  run = name;
  if ($("set-key").options.length === 0) {
    for (const key of keys) $("set-key").add(new Option(key, key));
  }
  $("steering").hidden = !(running && mayAct());
}
