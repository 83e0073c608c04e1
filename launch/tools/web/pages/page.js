// SPDX-License-Identifier: Apache-2.0
// The page: requests its data from the server as often as they change, while the page is visible.

import { forgetCharts, showCharts } from "./charts.js";
import { get, mayAct, post, runPath } from "./requests.js";
import { offerSteering } from "./steering.js";

const $ = (id) => document.getElementById(id);
const periodMs = { runs: 5000, top: 1000, curves: 5000, run: 5000 };

let shown = null;     // name of the run that is shown; null: the list
let runs = [], keys = [];
let episodeOf = "";   // checkpoint and seed of the film that is shown
let filmOf = "";      // the film beside the result
let lastPlayed = "";  // checkpoint that an episode was asked of
const next = { runs: 0, top: 0, curves: 0, run: 0 };  // when each is asked for again

const whole = new Intl.NumberFormat("en", { maximumFractionDigits: 0 });
const rate = new Intl.NumberFormat("en", { maximumFractionDigits: 1 });
const unknown = (value) => value === null || value === undefined;
const percent = (value) => unknown(value) ? "–" : Math.round(100 * value) + " %";
const number = (value, format = whole) => unknown(value) ? "–" : format.format(value);

function duration(seconds) {
  if (unknown(seconds)) return "–";
  const two = (n) => String(Math.floor(n)).padStart(2, "0");
  const minutes = two(seconds / 60 % 60) + ":" + two(seconds % 60);
  return seconds < 3600 ? minutes : Math.floor(seconds / 3600) + ":" + minutes;
}

function cell(text, kind = "td") {
  const element = document.createElement(kind);
  element.textContent = text;
  return element;
}

function row(cells) {
  const element = document.createElement("tr");
  element.append(...cells);
  return element;
}

// A heading stands as the cells below it do.
function fill(table, columns, rows) {
  const head = document.createElement("thead");
  head.append(row(columns.map((name, i) => Object.assign(cell(name, "th"),
    { scope: "col", className: rows[0]?.children[i].className ?? "" }))));
  const body = document.createElement("tbody");
  body.append(...rows);
  table.replaceChildren(head, body);
}

function link(text, href) {
  return Object.assign(document.createElement("a"), { textContent: text, href });
}

function state(name) {
  const mark = cell(name, "span");
  mark.className = "state " + name;
  return mark;
}

const score = (success, mean) =>
  !unknown(success) ? percent(success) : unknown(mean) ? "–" : "return " + mean.toFixed(1);

function showRuns() {
  fill($("run-table"), ["Run", "State", "Env steps", "Updates", "Best", "Final", "Wall", "Started (UTC)", "Task"],
    runs.map((run) => {
      const name = document.createElement("td");
      name.append(link(run.name, "#" + encodeURIComponent(run.name)));
      if (run.problem) name.append(Object.assign(cell(run.problem, "div"), { className: "quiet" }));
      const status = document.createElement("td");
      status.append(state(run.status));
      const figures = [number(run.env_steps), number(run.updates),
        score(run.best_success_rate, run.best_return_mean),
        score(run.final_success_rate, run.final_return_mean), duration(run.wall_seconds)];
      return row([name, status, ...figures.map((text) => Object.assign(cell(text), { className: "number" })),
        cell((run.started ?? "–").replace("T", " ").slice(0, 16)), cell(run.task ?? "–")]);
    }));
  $("no-runs").hidden = runs.length > 0;
}

function tile(name, value, more = "") {
  const box = document.createElement("div");
  box.append(cell(name, "dt"), cell(value, "dd"));
  if (more) box.append(Object.assign(cell(more, "dd"), { className: "quiet" }));
  return box;
}

function showProgress(progress) {
  const share = progress.budget_env_steps > 0 ? progress.env_steps / progress.budget_env_steps : 0;
  $("progress").value = share;
  $("progress-text").textContent = number(progress.env_steps) + " of " +
    number(progress.budget_env_steps) + " env steps, " + percent(share);
  const evaluation = progress.last_evaluation, best = progress.best;
  $("tiles").replaceChildren(
    tile("Time", duration(progress.elapsed_seconds), duration(progress.seconds_left) + " left"),
    tile("Env steps per second", number(progress.env_steps_per_second, rate)),
    tile("Updates", number(progress.updates), number(progress.updates_per_second, rate) + " per second"),
    tile("Last evaluation", evaluation ? score(evaluation.success, evaluation.return) : "none yet",
      evaluation ? "at " + number(evaluation.env_steps) + " env steps" : ""),
    tile("Best", best ? score(best.success, best.return) : "–",
      best ? "at " + number(best.env_steps) + " env steps" : ""),
    tile(unknown(progress.rollout_success) ? "Actors' return" : "Actors' success",
      score(progress.rollout_success, progress.rollout_return),
      "last episodes, mean length " + number(progress.rollout_length) + " env steps"),
    tile("Restarts", number(progress.restarts)));
}

// Shows the result of a run that has ended.
function showResult(listing) {
  const ended = listing !== undefined && !["running", "unreadable"].includes(listing.status);
  $("result").hidden = !ended;
  if (!ended) return;
  $("result-tiles").replaceChildren(
    tile(unknown(listing.final_success_rate) ? "Final return" : "Final success",
      score(listing.final_success_rate, listing.final_return_mean),
      !unknown(listing.final_success_rate) && !unknown(listing.final_return_mean)
        ? "return " + listing.final_return_mean.toFixed(1) : ""),
    tile("Best while training", score(listing.best_success_rate, listing.best_return_mean)),
    tile("Env steps", number(listing.env_steps)),
    tile("Updates", number(listing.updates)),
    tile("Wall time", duration(listing.wall_seconds)),
    tile("Started (UTC)", (listing.started ?? "–").replace("T", " ").slice(0, 16)));
}

// The newest film of a run that has ended, ready to be played.
function offerFilm(files) {
  const films = files.filter((file) => file.path.endsWith(".mp4"))
    .sort((a, b) => a.modified - b.modified);
  const href = films.length === 0 ? "" : "files/" + encodeURIComponent(shown) + "/" + films.at(-1).path;
  if (href === filmOf) return;
  filmOf = href;
  $("result-film").hidden = href === "";
  if (href) $("result-film").src = href;
}

function showProcesses(answer) {
  const text = ["PROCESS", "HOST", "STATE", "MOST TIME IN"];
  fill($("processes"), answer.columns, answer.rows.map((texts) => row(texts.map((figure, i) => {
    const entry = cell(figure === "-" ? "–" : figure);
    if (answer.columns[i] === "STATE") entry.replaceChildren(state(figure));
    if (!text.includes(answer.columns[i])) entry.className = "number";
    return entry;
  }))));
  if (!$("all-figures").open) return;
  const processes = answer.view.processes;
  const known = ["role", "id", "host", "pid", "state", "time"];
  const names = [...new Set(processes.flatMap((one) => Object.keys(one)))]
    .filter((name) => !known.includes(name)).sort();
  $("view-time").textContent = "Reported at " + new Date(1000 * answer.view.time).toLocaleTimeString() + ".";
  $("figures").dataset.time = answer.view.time;
  fill($("figures"), ["figure", ...processes.map((one) => one.role + "-" + one.id)],
    names.map((name) => row([Object.assign(cell(name, "th"), { scope: "row" }),
      ...processes.map((one) => Object.assign(
        cell(one[name] === undefined ? "" : String(one[name])), { className: "number" }))])));
}

function showTop(answer) {
  showProgress(answer.progress);
  $("trouble").textContent = answer.progress.trouble;
  $("trouble").hidden = answer.progress.trouble === "";
  $("advice").textContent = answer.advice;
  showProcesses(answer);
  $("events").replaceChildren(...answer.events.slice(-12).reverse().map(([time, text]) => {
    const item = document.createElement("li");
    const when = document.createElement("time");
    when.textContent = new Date(1000 * time).toLocaleTimeString();
    item.append(when, " ", text);
    return item;
  }));
  $("events-section").hidden = answer.events.length === 0;
}

function size(bytes) {
  return bytes < 1e6 ? Math.ceil(bytes / 1e3) + " kB" : (bytes / 1e6).toFixed(1) + " MB";
}

function showFiles(files) {
  $("files-section").hidden = files.length === 0;
  $("files").replaceChildren(...files.map((file) => {
    const href = "files/" + encodeURIComponent(shown) + "/" + file.path;
    const entry = link(file.path, href);
    if (file.path.endsWith(".mp4")) {
      entry.addEventListener("click", (event) => {
        event.preventDefault();
        Object.assign($("film"), { src: href, hidden: false });
        $("film").play();
      });
    } else {
      Object.assign(entry, { target: "_blank", rel: "noopener" });
    }
    const item = document.createElement("li");
    item.append(entry, " ", Object.assign(cell(size(file.bytes) + ", " +
      new Date(1000 * file.modified).toLocaleString(), "span"), { className: "quiet" }));
    return item;
  }));
}

function showEpisode(answer) {
  const episode = answer.episode;
  $("policy").hidden = answer.checkpoint === "" || (!mayAct() && !episode.film);
  $("play").disabled = episode.state === "playing" || !mayAct();
  const of = episode.checkpoint + " (" + number(episode.env_steps) + " env steps, " +
    number(episode.updates) + " updates), episode " + episode.seed;
  $("episode-text").textContent = {
    none: "The film shows the policy's input, pixel by pixel, beside a larger view.",
    playing: "An episode is being played with " + of + " …",
    ready: "Played with " + of + ".",
    failed: "Not played with " + of + ": " + episode.problem,
  }[episode.state];
  if (episode.film && episode.state === "ready" && episodeOf !== of) {
    episodeOf = of;
    Object.assign($("episode"), { src: "episode/" + encodeURIComponent(shown) + "?" + episode.seed, hidden: false });
    $("episode").play().catch(() => {});  // a browser that does not start films by itself shows its button
  }
  if ($("play-again").checked && episode.state !== "playing" && lastPlayed !== answer.checkpoint) {
    lastPlayed = answer.checkpoint;
    play();
  }
}

async function play() {
  try {
    showEpisode(await post(runPath(shown, "/episode"), {}));
    next.run = 0;
  } catch (error) {
    $("episode-text").textContent = error.message;
  }
}

$("play").addEventListener("click", play);
$("all-figures").addEventListener("toggle", () => { next.top = 0; });

// The requests, and the handlers of their answers. `run` is the run of the request: by the time of
// the answer the page may show another run.
const questions = {
  async runs() {
    const answer = await get("api/runs");
    runs = answer.runs.runs;
    keys = answer.keys;
    $("where").textContent = answer.runs.run_dir;
    if (shown === null) {
      showRuns();
    } else {
      showHead();
    }
  },
  async top(run) {
    const listing = runs.find((one) => one.name === run);
    const running = listing?.status === "running";
    for (const id of ["live", "processes-section"]) $(id).hidden = !running;
    offerSteering(run, keys, running);
    if (!running) return;
    const answer = await get(runPath(run, "/top"));
    if (run === shown) showTop(answer);
  },
  async curves(run) {
    const answer = await get(runPath(run, "/curves"));
    if (run !== shown) return;
    showCharts(answer.charts, $("charts"));
    $("no-curves").hidden = answer.charts.length > 0;
    if (!answer.complete) next.curves = 0;
  },
  async run(run) {
    const answer = await get(runPath(run));
    if (run !== shown) return;
    showFiles(answer.files);
    offerFilm(answer.files);
    showEpisode(answer);
  },
};

function showHead() {
  const listing = runs.find((run) => run.name === shown);
  $("run-name").textContent = shown;
  $("run-state").replaceChildren(state(listing ? listing.status : "unknown"));
  $("run-what").textContent = listing ? [listing.task, listing.preset].filter(Boolean).join(", ") : "";
  $("problem").hidden = !listing?.problem;
  $("problem").textContent = listing?.problem ?? "";
  showResult(listing);
}

function say(text, bad) {
  $("connection").textContent = text;
  $("connection").className = bad ? "notice" : "";
}

async function look() {
  if (document.hidden) return;
  const now = Date.now();
  const due = Object.keys(questions).filter((name) =>
    now >= next[name] && (name === "runs" || shown !== null));
  for (const name of due) {
    next[name] = now + periodMs[name];
    try {
      await questions[name](shown);
      say("");
    } catch (error) {
      // 409: the run has no answer, as one that has just ended; anything else is about the server.
      say(error.status ? error.message : "no answer from shoal web", error.status !== 409);
      if (error.status === 409) next.runs = 0;
    }
  }
}

function choose() {
  const name = decodeURIComponent(location.hash.slice(1));
  shown = name === "" ? null : name;
  episodeOf = lastPlayed = filmOf = "";
  forgetCharts();
  for (const id of ["episode", "film", "result-film"]) {
    $(id).removeAttribute("src");
    $(id).hidden = true;
  }
  $("runs").hidden = shown !== null;
  $("run").hidden = shown === null;
  document.title = shown === null ? "Shoal" : shown + " – Shoal";
  if (shown === null) {
    showRuns();
  } else {
    showHead();
  }
  for (const name of Object.keys(next)) next[name] = 0;
}

// One look after the other, however long one takes.
async function watch() {
  await look();
  setTimeout(watch, 250);
}

$("all-figures").open = new URLSearchParams(location.search).has("all-figures");
addEventListener("hashchange", choose);
document.addEventListener("visibilitychange", () => { for (const name of Object.keys(next)) next[name] = 0; });
choose();
await look();
// A single run is shown at once.
if (shown === null && runs.length === 1) location.hash = encodeURIComponent(runs[0].name);
watch();
