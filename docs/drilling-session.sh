#!/bin/bash
# Makes the pictures of a session in guide-bone.md: a virtual hand drills a real temporal bone for
# 75 s on the real clock, in a window, and the session is replayed. Needs xvfb-run, curl
# and ffmpeg.
# drilling-session.sh HAPTRIAL EAR FOLDER: the command, ear3_171_labels.nrrd, where to.
set -eu
haptrial=$(realpath "$1")
ear=$(realpath "$2")
out=$(realpath "$3")
shipped=$(realpath "$(dirname "$0")/../experiments/bone_drilling.toml")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cp "$ear" "$work/ear.nrrd"
sed -e 's/^bones = .*/bones = ["ear.nrrd"]/' -e 's/^time_limit = .*/time_limit = 75.0/' \
  -e 's/^full_screen = .*/full_screen = false/' -e 's/^start = .*/start = [-0.006, 0.018, 0.012]/' \
  -e 's/^depth = 0.008/depth = 0.012/' -e 's/^field_of_view = .*/field_of_view = 0.24/' \
  "$shipped" >"$work/ear.toml"
cd "$work"
xvfb-run -a -s "-screen 0 1280x720x24" \
  "$haptrial" run ear.toml --subject S01 --window --console --out sessions >said &
until grep -q ^console: said; do sleep 1; done
url=$(sed -n 's/^console: //p' said)
curl -s -H "X-Haptrial-Token: ${url##*=}" -H "Content-Type: application/json" \
  -d '{"request": "start"}' "${url%%\?*}ask"
wait
"$haptrial" info sessions/S01.h5
"$haptrial" replay sessions/S01.h5
"$haptrial" replay sessions/S01.h5 --video session.mp4 --fps 15
# Frames at 4, 18, 32, 46, 60 and 74 s.
ffmpeg -v error -y -i session.mp4 -frames:v 1 -vf "select=eq(n\\,60)+eq(n\\,270)+eq(n\\,480)+eq(n\\,690)\
+eq(n\\,900)+eq(n\\,1110),scale=480:270:flags=lanczos,pad=482:272:1:1:white,tile=3x2,split[a][b];\
[a]palettegen=max_colors=200[p];[b][p]paletteuse=dither=none" "$out/drilling-session.png"
ffmpeg -v error -y -i session.mp4 -vf "setpts=PTS/8,fps=8,scale=480:-1:flags=lanczos,split[a][b];\
[a]palettegen=max_colors=64[p];[b][p]paletteuse=dither=bayer" "$out/drilling-session.gif"
