// SPDX-License-Identifier: Apache-2.0
// Requests to the server that the page came from. Each has a deadline.

const deadlineMs = 10000;
const tokenKey = "shoal-token";

// The token of the printed address, for steering. It goes out of the address bar, and so out of the
// history; the tab keeps it.
const words = new URLSearchParams(location.search);
if (words.has("token")) {
  sessionStorage.setItem(tokenKey, words.get("token"));
  words.delete("token");
  const rest = words.toString();
  history.replaceState(null, "", location.pathname + (rest ? "?" + rest : "") + location.hash);
}

export const mayAct = () => sessionStorage.getItem(tokenKey) !== null;

async function ask(path, options) {
  const token = sessionStorage.getItem(tokenKey);
  const headers = token ? { "X-Shoal-Token": token } : {};
  const answer = await fetch(path, { ...options, headers, signal: AbortSignal.timeout(deadlineMs) });
  const content = await answer.json();
  if (!answer.ok) throw Object.assign(new Error(content.error), { status: answer.status });
  return content;
}

export const get = (path) => ask(path, {});
export const post = (path, body) => ask(path, { method: "POST", body: JSON.stringify(body) });

export const runPath = (run, what = "") => "api/runs/" + encodeURIComponent(run) + what;
