#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/comparison/web_by_ssh.sh PROGRAM RUN_DIR: looks at the page of `shoal web` and steers through
# `ssh -L` at another port, as from another host, and says what was answered. The ssh server is one of
# its own on loopback, with keys of its own. Needs sshd (Debian's openssh-server), ssh and curl, and
# a finished run in RUN_DIR.
set -euo pipefail
if (($# != 2)); then
  echo "usage: web_by_ssh.sh PROGRAM RUN_DIR" >&2
  exit 2
fi
readonly shoal=$1 runs=$2
work=$(mktemp -d)
pids=()
trap 'kill "${pids[@]}" 2>/dev/null; wait; rm -rf "$work"' EXIT

free_port() {
  python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}
# wait_for COMMAND...: up to 30 s.
wait_for() {
  local end=$((SECONDS + 30))
  until "$@" >/dev/null 2>&1; do
    if ((SECONDS > end)); then
      echo "web_by_ssh: waited in vain for: $*" >&2
      return 1
    fi
    sleep 0.1
  done
}

"$shoal" web --run-dir "$runs" --port 0 >"$work/printed" &
pids+=($!)
wait_for grep -q token "$work/printed"
url=$(sed -n 's/.* at \(http:.*\)/\1/p' "$work/printed")
web_port=$(sed 's/.*:\([0-9]*\)\/.*/\1/' <<<"$url")
token=${url##*token=}

ssh-keygen -q -t ed25519 -N '' -f "$work/host"
ssh-keygen -q -t ed25519 -N '' -f "$work/user"
ssh_port=$(free_port)
((EUID != 0)) || mkdir -p /run/sshd
/usr/sbin/sshd -D -e -f /dev/null -h "$work/host" -p "$ssh_port" -o ListenAddress=127.0.0.1 \
  -o PidFile=none -o UsePAM=no -o StrictModes=no -o AuthorizedKeysFile="$work/user.pub" \
  2>"$work/sshd.log" &
pids+=($!)
echo "[127.0.0.1]:$ssh_port $(cat "$work/host.pub")" >"$work/known_hosts"
desk_port=$(free_port)
connect() {
  ssh -N -F /dev/null -i "$work/user" -p "$ssh_port" -o UserKnownHostsFile="$work/known_hosts" \
    -o ExitOnForwardFailure=yes -o ConnectionAttempts=20 -L "$desk_port:127.0.0.1:$web_port" 127.0.0.1
}
connect &
pids+=($!)
readonly desk=http://127.0.0.1:$desk_port
wait_for curl -sf "$desk/api/runs"

# answer EXPECTED WHAT CURL-ARGUMENTS...
answer() {
  local expected=$1 what=$2 status
  shift 2
  status=$(curl -s -o "$work/answer" -w '%{http_code}' "$@")
  echo "$status $what"
  if [[ $status != "$expected" ]]; then
    echo "web_by_ssh: expected $expected; the answer: $(head -c 300 "$work/answer")" >&2
    return 1
  fi
}
run=$(curl -s "$desk/api/runs" | python3 -c 'import json, sys; print(json.load(sys.stdin)["runs"]["runs"][0]["name"])')
answer 200 "the page" "$desk/?token=$token"
grep -q '<title>Shoal</title>' "$work/answer"
answer 200 "the runs, as localhost" "http://localhost:$desk_port/api/runs"
answer 200 "curves of $run" "$desk/api/runs/$run/curves"
order=(-X POST -H "Sec-Fetch-Site: same-origin" --data '{"verb": "stop", "arguments": []}' "$desk/api/runs/$run/order")
answer 401 "steering without the token" -H "Origin: $desk" "${order[@]}"
answer 403 "steering from a page of others" -H "Origin: http://evil.example" -H "X-Shoal-Token: $token" "${order[@]}"
answer 409 "steering with the token: $run is not running" -H "Origin: $desk" -H "X-Shoal-Token: $token" "${order[@]}"
