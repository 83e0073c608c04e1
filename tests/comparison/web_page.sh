#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/comparison/web_page.sh PROGRAM RUN_DIR RUN OUTPUT: opens the page of `shoal web` on a running
# run in headless Chromium (Debian's package) and says whether each figure of each process that the
# page shows is the one of `shoal top --once --json` at the same moment. Screenshots, light and dark,
# wide and of a phone, go to the folder OUTPUT. Needs chromium and python3.
set -euo pipefail
if (($# != 4)); then
  echo "usage: web_page.sh PROGRAM RUN_DIR RUN OUTPUT" >&2
  exit 2
fi
readonly shoal=$1 runs=$2 run=$3 output=$4
mkdir -p "$output"
work=$(mktemp -d)
"$shoal" web --run-dir "$runs" --port 0 >"$work/printed" &
web=$!
top=
trap 'kill "$web" $top 2>/dev/null; wait; rm -rf "$work"' EXIT
for _ in {1..100}; do
  grep -q token "$work/printed" && break
  sleep 0.1
done
url=$(sed -n 's/.* at \(http:.*\)/\1/p' "$work/printed")

# browser ARGUMENTS...: as root there is no sandbox.
browser() {
  local sandbox=()
  ((EUID != 0)) || sandbox=(--no-sandbox)
  chromium --headless=new "${sandbox[@]}" --disable-gpu --hide-scrollbars \
    --user-data-dir="$work/profile" --virtual-time-budget=8000 "$@" 2>"$work/browser.log"
}

# Every moment that the page might show.
(while :; do "$shoal" top --run-dir "$runs" --run "$run" --once --json | tr -d '\n' || exit; echo; done \
  >"$work/top.jsonl" 2>/dev/null) &
top=$!
browser --dump-dom "$url&all-figures=1#$run" >"$output/page.html"
sleep 2
kill "$top" && top=

python3 - "$work/top.jsonl" "$output/page.html" <<'PYTHON'
import html.parser, json, sys

class Figures(html.parser.HTMLParser):
    """The table of every figure: its moment, and its rows as lists of texts."""
    def __init__(self):
        super().__init__()
        self.time, self.rows, self.inside, self.cell = None, [], False, None
    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag == "table" and attributes.get("id") == "figures":
            self.inside, self.time = True, attributes.get("data-time")
        elif self.inside and tag == "tr":
            self.rows.append([])
        elif self.inside and tag in ("td", "th"):
            self.cell = ""
    def handle_endtag(self, tag):
        if tag == "table":
            self.inside = False
        elif self.inside and tag in ("td", "th"):
            self.rows[-1].append(self.cell)
    def handle_data(self, data):
        if self.inside and self.cell is not None:
            self.cell += data

page = Figures()
page.feed(open(sys.argv[2]).read())
views = {view["time"]: view for view in map(json.loads, filter(str.strip, open(sys.argv[1])))}
if page.time is None:
    sys.exit("the page shows no figures")
view = views.get(float(page.time))
if view is None:
    sys.exit(f"no view of {page.time} among those of {sorted(views)}")
names = page.rows[0][1:]
processes = {f"{one['role']}-{one['id']}": one for one in view["processes"]}
compared = 0
for name, *values in page.rows[1:]:
    for process, text in zip(names, values, strict=True):
        expected = processes[process].get(name)
        shown = None if text == "" or text == "null" else float(text)
        if shown != expected:
            sys.exit(f"{process} {name}: the page says {text}, shoal top {expected}")
        compared += shown is not None
shown_names = {row[0] for row in page.rows[1:]}
known = {"role", "id", "host", "pid", "state", "time"}
missing = {n for one in view["processes"] for n in one} - known - shown_names
if missing or set(names) != set(processes):
    sys.exit(f"not on the page: {missing} {set(processes) - set(names)}")
print(f"{compared} figures of {len(names)} processes are those of shoal top at {page.time}")
PYTHON

shot() {
  browser --window-size="$2" --screenshot="$output/$1.png" "${@:3}" "$url#$run" >/dev/null
}
shot wide-light 1400,1800
shot wide-dark 1400,1800 --blink-settings=preferredColorScheme=0
python3 "$(dirname "$0")/phone_page.py" "$url#$run" "$output/phone-light.png"
python3 "$(dirname "$0")/phone_page.py" "$url#$run" "$output/phone-dark.png" --dark
python3 "$(dirname "$0")/phone_page.py" "$url" "$output/phone-runs.png"
browser --window-size=1400,600 --screenshot="$output/runs.png" "$url" >/dev/null
echo "screenshots in $output"
