#!/usr/bin/env bash
# Runs a shipped study anew and keeps what it gave: results/STUDY with report, tables, figures and a
# manifest that says how. Session files stay out. Needs a build (quickstart.sh makes one).
#   results/regenerate.sh force_training [SEED]
# A variant, force_training_..., is also compared with force_training. A study of drillings is rated by
# simulated raters; of an experiment that its definition states whole a few participants are kept.
# power_QUESTION simulates docs/worked/power/QUESTION.toml, power_null the files of docs/worked/power/null.
# contact_evaluation, calibration and exam are no studies: haptrial evaluate --duck, haptrial deform
# calibrate and haptrial exam make them. exam makes the point's anew; EXAM_ANSWERS may name a folder
# of further answers, as those of CHAI3D, whose program is compiled elsewhere.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
study=${1:?which study? a definition in experiments/, without .toml}
seed=${2:-1}
definition=experiments/$study.toml
cd "$root"
sum() { sha256sum "$1" | cut -d' ' -f1; }
program() { build/haptrial --version | sed -n 1p; }

if [ "$study" = contact_evaluation ]; then  # no participants: a simulated recording of a contact
  out=$(mktemp -d)/duck
  trap 'rm -rf "$(dirname "$out")"' EXIT
  build/haptrial evaluate --duck --seed "$seed" --out "$out"
  cp "results/$study/contour.csv" "$out/"
  rm -rf "results/$study"
  mkdir -p "results/$study"
  cp "$out"/*.csv "$out"/report.html "$out"/*.svg "results/$study/"
  if [ -d "${HAPTRIAL_DATA:-../shared/data}/haptic/contour" ]; then
    HAPTRIAL_WRITE_RESULTS=1 build/test_contact_analysis --gtest_filter='ContourTableTest.*'
  else
    echo "regenerate.sh: no recordings of a real contact; contour.csv stays as it is" >&2
  fi
  cat >"results/$study/manifest.json" <<EOF
{
  "study": "$study",
  "simulated": true,
  "commands": [
    "haptrial evaluate --duck --seed $seed --out OUT"
  ],
  "seed": $seed,
  "program": "$(program)",
  "table_4_sha256": "$(sum "results/$study/table-4.csv")",
  "table_5_sha256": "$(sum "results/$study/table-5.csv")",
  "table_6_sha256": "$(sum "results/$study/table-6.csv")",
  "operations_sha256": "$(sum "results/$study/operations.csv")",
  "failures_sha256": "$(sum "results/$study/failures.csv")",
  "contour_sha256": "$(sum "results/$study/contour.csv")"
}
EOF
  exit
fi
if [ "$study" = power_null ]; then  # do the tests of the reports keep their level?
  out=$(mktemp -d)
  trap 'rm -rf "$out"' EXIT
  mkdir "$out/simulations"
  for question in docs/worked/power/null/*.toml; do
    build/haptrial power simulate "$question" --out "$out/simulations/$(basename "$question" .toml)"
  done
  mkdir -p "results/$study"
  python3 results/null_table.py "$out/simulations" "results/$study/null.csv"
  cat >"results/$study/manifest.json" <<EOF
{
  "study": "$study",
  "simulated": true,
  "commands": [
    "haptrial power simulate docs/worked/power/null/DEFINITION.toml --out SIMULATIONS/DEFINITION",
    "python3 results/null_table.py SIMULATIONS null.csv"
  ],
  "questions_sha256": "$(cat docs/worked/power/null/*.toml | sha256sum | cut -d' ' -f1)",
  "program": "$(program)",
  "null_sha256": "$(sum "results/$study/null.csv")"
}
EOF
  exit
fi
if [[ $study == power_* ]]; then  # many simulated studies
  out=$(mktemp -d)/power
  trap 'rm -rf "$(dirname "$out")"' EXIT
  question=docs/worked/power/${study#power_}.toml
  build/haptrial power simulate "$question" --out "$out"
  rm -rf "results/$study"
  mkdir -p "results/$study"
  cp "$out"/report.html "$out"/power.csv "$out"/power.json "$out"/power.svg "results/$study/"
  cat >"results/$study/manifest.json" <<EOF
{
  "study": "$study",
  "simulated": true,
  "commands": [
    "haptrial power simulate $question --out OUT"
  ],
  "question_sha256": "$(sum "$question")",
  "program": "$(program)",
  "power_sha256": "$(sum "results/$study/power.csv")"
}
EOF
  exit
fi
if [ "$study" = exam ]; then  # renderers of a point; rigid tools and soft bodies stay as they are
  folder=results/exam
  out=$(mktemp -d)
  trap 'rm -rf "$out"' EXIT
  build/haptrial exam make "$out/exam"
  for renderer in proxy penalty distance-field voxel; do
    build/haptrial exam run "$out/exam" "$renderer" --out "$out/answers/$renderer"
  done
  build/haptrial exam run "$out/exam" --name half-space --out "$out/answers/half-space" \
    --program python3 docs/worked/exam/half_space.py
  others=()
  if [ -d "${EXAM_ANSWERS:-}" ]; then
    others=("$EXAM_ANSWERS"/*)
  else
    echo "regenerate.sh: no EXAM_ANSWERS; the tables hold haptrial's renderers and half-space alone" >&2
  fi
  build/haptrial exam score "$out/exam" "$out/answers/proxy" "${others[@]}" \
    "$out"/answers/{penalty,distance-field,voxel,half-space} --out "$out/scores"
  rm -f "$folder"/ridge-*.svg
  cp "$out/scores/scores.csv" "$folder/exam-scores.csv"
  cp "$out/scores/report.html" "$out"/scores/ridge-*.svg "$folder/"
  exit
fi
if [ "$study" = calibration ]; then  # springs that follow elements, and a real cube
  folder=results/calibration
  out=$(mktemp -d)
  trap 'rm -rf "$out"' EXIT
  build/haptrial mesh make gear "$folder/gear.ply" --overwrite
  python3 "$folder/runs.py" list | {
    while read -r name arguments; do
      # shellcheck disable=SC2086
      build/haptrial deform calibrate "$folder"/$arguments --out "$out/$name"
      cp "$out/$name/calibration.json" "$folder/$name.json"
      cp "$out/$name/evaluations.csv" "$folder/$name.csv"
      for report in gear cube-made; do
        [ "$name" != "$report" ] || cp "$out/$name/report.html" "$folder/$name.html"
      done
    done
  }
  if [ -d "${HAPTRIAL_DATA:-../shared/data}/deformable" ]; then
    HAPTRIAL_WRITE_RESULTS=1 build/test_deformable --gtest_filter='TruthCubeSpringsTest.TheTable*'
  else
    echo "regenerate.sh: no data of the real cube; $folder/truth_cube.csv stays as it is" >&2
  fi
  HAPTRIAL_WRITE_RESULTS=1 build/test_deformable --gtest_filter='GearScanTest.TheScan*'
  python3 "$folder/runs.py" tables "$(program)"
  exit
fi
[ -f "$definition" ] || { echo "regenerate.sh: no $definition" >&2; exit 2; }

out=$(mktemp -d)/sessions
trap 'rm -rf "$(dirname "$out")"' EXIT
table=scores
rate=
few=
if grep -q '^protocol = "trials"' "$definition"; then
  table=estimates
  few=' --subjects 6'  # of a rehearsal; unquoted below: two words
fi
little=
if grep -q '^protocol = "bone_drilling"' "$definition"; then
  # Blood takes most of a rehearsal's time, and no metric depends on it; unquoted below: two words.
  little=' --set bleeding.rate=1e-9'
fi
# shellcheck disable=SC2086
build/haptrial dry-run "$definition" --seed "$seed"$few$little --out "$out"
if grep -q '^protocol = "bone_drilling"' "$definition"; then
  table=metrics
  build/haptrial rate simulate "$out"
  rate='
    "haptrial rate simulate OUT",'
fi
build/haptrial analyze "$out"
compare=
if [[ $study == force_training_* ]]; then
  build/haptrial compare results/force_training "$out" --out "$out"
  compare=',
    "haptrial compare results/force_training OUT --out OUT"'
fi

rm -rf "results/$study"
mkdir -p "results/$study"
[ -z "$compare" ] || cp "$out"/comparison.html "$out"/comparison.json "results/$study/"
cp "$out"/report.html "$out/$table.csv" "results/$study/"
if [ "$table" = estimates ]; then
  cp "$out"/results.json "results/$study/"  # the pictures are inside the report
else
  cp "$out"/report.md "$out"/statistics.json "$out"/*.svg "results/$study/"
fi
if [ -n "$rate" ]; then
  cp "$out/ratings.csv" "results/$study/"
fi
cat >"results/$study/manifest.json" <<EOF
{
  "study": "$study",
  "simulated": true,
  "commands": [
    "haptrial dry-run $definition --seed $seed$few$little --out OUT",$rate
    "haptrial analyze OUT"$compare
  ],
  "definition_sha256": "$(sum "$definition")",
  "seed": $seed,
  "program": "$(program)",
  "${table}_sha256": "$(sum "results/$study/$table.csv")"
}
EOF
