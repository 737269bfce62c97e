#!/usr/bin/env bash
# validity-live.jpg of guide-experimenter.md: a virtual surgeon in the participant's window, with the
# last still in the corner, two minutes. Needs xvfb, xdotool and ffmpeg.
#   docs/images/validity-live.sh            HAPTRIAL=build/haptrial
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
haptrial=$(realpath "${HAPTRIAL:-$here/../../build/haptrial}")
if [ -z "${WORK:-}" ]; then
  WORK=$(mktemp -d)
  export WORK
  trap 'rm -rf "$WORK"' EXIT
  xvfb-run -a -s "-screen 0 1280x720x24" "${BASH_SOURCE[0]}"
  exit
fi
sed -e '/^\[practice\]/,/^$/d' -e 's/^procedures = .*/procedures = 1/; s/^break_after = .*//' \
  -e 's/^time_limit = .*/time_limit = 120.0/; s/^full_screen = .*/full_screen = false/' \
  "$here/../../experiments/construct_validity.toml" > "$WORK/validity.toml"
"$haptrial" run "$WORK/validity.toml" --subject S01 --window --out "$WORK/sessions" > "$WORK/said" &
session=$!
while ! grep -q ^recording "$WORK/said"; do
  kill -0 "$session"
  sleep 0.5
done
for _ in $(seq 20); do  # the pages before the procedure
  xdotool key Return
  sleep 0.5
done
sleep 50
for _ in 1 2 3 4; do
  xdotool key b
  sleep 1
done
ffmpeg -v error -y -f x11grab -video_size 1280x720 -i "$DISPLAY" -frames:v 1 -q:v 4 \
  "$here/validity-live.jpg"
kill -INT "$session"
wait "$session" || true
