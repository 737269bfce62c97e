#!/bin/bash
# Draws the pictures of bones in bone-look.md.
# bone-look.sh HAPTRIAL EAR JAW FOLDER: the command, ear3_171_labels.nrrd, a mandible, where to.
set -eu
draw=("$1" bone picture)
ear=$2
jaw=$3
out=$4
hidden=(--without "External auditory canal,Temporomandibular joint")
size=(--width 960 --height 640 --overwrite)

# A mastoidectomy as strokes of a burr [mm]: a funnel from the side of the mastoid to the antrum,
# layer by layer, each smaller than the one before.
strokes=()
while read -r x y0 y1 z0 z1 step d; do
  z=$z0
  while [ "$(awk "BEGIN{print ($z <= $z1)}")" = 1 ]; do
    strokes+=(--drill "$x,$y0,$z,$x,$y1,$z,$d")
    z=$(awk "BEGIN{print $z + $step}")
  done
done <<'LAYERS'
-53 -152 -139 -181 -165 2 6
-49 -152 -140 -181 -165 2 6
-45 -151.5 -141 -180 -166 2 6
-41 -151.5 -142 -179 -166 2 5
-38 -151.5 -144 -178 -167 2 5
-35 -151 -146 -176 -168 1.5 4
-33 -151 -147 -175 -169 1.5 4
LAYERS

"${draw[@]}" "$ear" "$out/bone-whole.png" "${hidden[@]}" "${size[@]}" --from -1,0.15,0.1
"${draw[@]}" "$ear" "$out/bone-drilled.png" "${hidden[@]}" "${size[@]}" --from -1,0.15,0.1 \
  --at=-45,-152,-174 --zoom 1.5 --spare "${strokes[@]}" --burr=-37,-145,-176,-70,-132,-160,4
"${draw[@]}" "$ear" "$out/bone-through.png" "${hidden[@]}" "${size[@]}" --from -1,0.3,0.1 \
  --at=-35,-149,-174 --zoom 3.5 --spare "${strokes[@]}"
"${draw[@]}" "$jaw" "$out/bone-mandible-cut.png" "${size[@]}" --from -0.35,-1,0.45 \
  --at=0,20,30 --zoom 1.3 --cut=-13,0,0,1,0,0,4
