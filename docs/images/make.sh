#!/usr/bin/env bash
# Makes the pictures of the README and the guides that show the program at work, about two minutes:
#   docs/images/make.sh [trials] [console] [report]    all without a name; HAPTRIAL=build/haptrial
# Needs Debian's chromium and chromium-driver for console and report. The report is that of
# results/force_training. Other pictures:
#   docs/algorithms/bone-look.sh, docs/drilling-session.sh   bones and drillings, from a labelled ear
#   docs/cavities.sh                                         stage-*.jpg, cavity-*.jpg, from labelled ears
#   docs/live-hints.sh                                       live-hint.png, with a rehearsal (15 min)
#   docs/algorithms/alignment-options.sh                     paths of the alignment
#   docs/algorithms/tutoring.sh                              a led hand beside its tutor's
#   docs/images/folders.py                                   folders.svg, from CMakeLists.txt
#   tests/benchmarks/stops.py, every_hand.gp                 stops.svg, every-hand.svg
#   docs/images/ear-variants.py                              ear-variants.png, from made ears
#   docs/ct-slices.sh                                        ct-slices.png, by a dry run
#   docs/images/scan.sh                                      scan-*.png, by a test
#   docs/images/validity-live.sh                             validity-live.jpg
#   HAPTRIAL_KEEP_PICTURES=FOLDER build/test_experiments --gtest_filter=LiveMouseDrilling*
#                                                            first-drilling.png
#   HAPTRIAL_KEEP_PICTURES=FOLDER build/test_drilling_analysis  drilling-visibility.png
# A page says under its picture which command draws it, if one does.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
haptrial=$(realpath "${HAPTRIAL:-build/haptrial}")
images=$PWD/docs/images
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# One training pass of each condition, as the participant sees it.
trials() {
  "$haptrial" dry-run experiments/force_training.toml --subjects 1 --trials 9 --frames 3 \
    --out "$work/trials" >/dev/null
  local condition
  for condition in haptic visual visuohaptic; do
    cp "$(find "$work/trials/frames" -name "*-$condition-03.png" | sort | sed -n 1p)" \
      "$images/trial-$condition.png"
  done
}

console() {
  python3 docs/images/console.py "$haptrial" "$work" "$images"
}

report() {
  cp -r results/force_training "$work/report"
  chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --window-size=728,1500 \
    --user-data-dir="$work/profile" --screenshot="$images/report.png" \
    "file://$work/report/report.html" 2>/dev/null
}

[ $# -gt 0 ] || set -- trials console report
for part; do
  case "$part" in
    trials | console | report) "$part" ;;
    *) echo "make.sh: '$part' is not known; allowed: trials, console, report" >&2; exit 2 ;;
  esac
done
