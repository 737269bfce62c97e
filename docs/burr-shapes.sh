#!/bin/bash
# Draws docs/images/burr-shapes.png and fissure.png: slots that burrs of four shapes drilled into a
# block, and a dry run of experiments/bone_drilling.toml with a fissure burr, from its replay.
# Needs ffmpeg.
# burr-shapes.sh HAPTRIAL FOLDER: the command, where to.
set -eu
haptrial=$(realpath "$1")
out=$(realpath "$2")
definition=$(realpath "$(dirname "$0")/../experiments/bone_drilling.toml")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# A block of 48 x 40 x 60 voxels of 0.25 mm, its top at y = 0 in the world; a stroke is longer.
python3 - <<'END'
size = (48, 40, 60)
head = ("NRRD0004\ntype: uint8\ndimension: 3\nsizes: %d %d %d\nspace: left-posterior-superior\n"
        "space directions: (0.25,0,0) (0,0.25,0) (0,0,0.25)\nspace origin: (0,0,0)\n"
        "encoding: raw\nendian: little\n\n" % size)
with open("block.nrrd", "wb") as file:
    file.write(head.encode())
    for k in range(size[2]):
        for j in range(size[1]):
            inside = 2 <= k < size[2] - 2 and 2 <= j < size[1] - 2
            file.write(bytes(1 if inside and 2 <= i < size[0] - 2 else 0 for i in range(size[0])))
END

# drill NUMBER-NAME TABLE-LINES DEPTH: a dry run that goes along one stroke with the burr.
drill() {
  sed -e 's/^bones = .*/bones = ["block.nrrd"]/' -e 's/^x_to = .*/x_to = [1.0, 0.0, 0.0]/' \
    -e 's/^y_to = .*/y_to = [0.0, 1.0, 0.0]/' -e 's/^centre = .*/centre = [0.0, -0.005, 0.0]/' \
    -e 's/^time_limit = .*/time_limit = 20.0/' -e 's/^handle = \[.*\]/handle = [0.0, 1.0, 0.0]/' \
    -e 's/^start = .*/start = [0.0, 0.012, 0.0]/' -e 's/^height = 0.009/height = 0.0001/' \
    -e 's/^line = .*/line = 0.001/' -e "s/^depth = 0.008/depth = $3/" \
    -e 's/^strokes_to_suction = .*/strokes_to_suction = 1000/' -e 's/^look_button = .*//' \
    -e 's/^target = .*/target = [0.0, 0.0, 0.0]/' -e 's/^eye = .*/eye = [0.08, 0.03, 0.025]/' \
    -e 's/^up = .*/up = [0.0, 1.0, 0.0]/' -e "s/^in_hand = .*/in_hand = [\"${1#?-}\", \"diamond\", \"suction\"]/" \
    -e "s/^\[tools.cutting\]/[tools.${1#?-}]/" \
    -e 's/^field_of_view = .*/field_of_view = 0.24/' -e 's/^\[dust\]/[dust_no]/' \
    -e "s/^diameter = 0.006 .*/$2/" "$definition" |
    sed -e '/^\[dust_no\]/,/^$/d' >"$1.toml"
  "$haptrial" dry-run "$1.toml" --out "$1"
  "$haptrial" replay "$1/S01.h5" --frames "$1/frames" --fps 1
  cp "$(ls "$1"/frames/frame-*.png | tail -1)" "$1.png"
}
drill 1-ball 'diameter = 0.003' 0.001
drill 2-fissure 'shape = "cylinder"\ndiameter = 0.003\nlength = 0.007' 0.003
drill 3-taper 'shape = "cone"\ndiameter = 0.0035\nnarrow_diameter = 0.0015\nlength = 0.007' 0.003
drill 4-pear 'shape = "pear"\ndiameter = 0.0035\nnarrow_diameter = 0.002\nlength = 0.007' 0.003
ffmpeg -v error -y -pattern_type glob -i "?-*.png" -frames:v 1 \
  -vf "crop=960:660:160:30,scale=430:296:flags=lanczos,pad=432:298:1:1:white,tile=2x2" \
  "$out/burr-shapes.png"

sed -e 's/^in_hand = .*/in_hand = ["fissure", "diamond", "suction"]/' \
  -e 's/^\[tools.cutting\]/[tools.fissure]/' \
  -e 's/^diameter = 0.006 .*/shape = "cylinder"\ndiameter = 0.0016\nlength = 0.006\nshaft_radius = 0.0006\nshaft_length = 0.025\nwear_volume = 2e-7/' \
  "$definition" >fissure.toml
"$haptrial" dry-run fissure.toml --out fissure
"$haptrial" replay fissure/S01.h5 --frames frames --fps 1
ffmpeg -v error -y -i frames/frame-00055.png -vf "scale=640:360:flags=lanczos" "$out/fissure.png"
