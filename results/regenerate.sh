#!/usr/bin/env bash
# Runs a shipped study anew and keeps what it gave: results/STUDY with report, tables, figures and a
# manifest that says how. Session files stay out. Needs a build (quickstart.sh makes one).
#   results/regenerate.sh force_training [SEED]
# A variant, force_training_..., is also compared with force_training. A study of drillings is rated by
# simulated raters.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
study=${1:?which study? a definition in experiments/, without .toml}
seed=${2:-1}
definition=experiments/$study.toml
cd "$root"
[ -f "$definition" ] || { echo "regenerate.sh: no $definition" >&2; exit 2; }

out=$(mktemp -d)/sessions
trap 'rm -rf "$(dirname "$out")"' EXIT
build/haptrial dry-run "$definition" --seed "$seed" --out "$out"
table=scores
rate=
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

sum() { sha256sum "$1" | cut -d' ' -f1; }
rm -rf "results/$study"
mkdir -p "results/$study"
[ -z "$compare" ] || cp "$out"/comparison.html "$out"/comparison.json "results/$study/"
cp "$out"/report.html "$out"/report.md "$out/$table.csv" "$out"/statistics.json "$out"/*.svg "results/$study/"
if [ -n "$rate" ]; then
  cp "$out/ratings.csv" "results/$study/"
fi
cat >"results/$study/manifest.json" <<EOF
{
  "study": "$study",
  "simulated": true,
  "commands": [
    "haptrial dry-run $definition --seed $seed --out OUT",$rate
    "haptrial analyze OUT"$compare
  ],
  "definition_sha256": "$(sum "$definition")",
  "seed": $seed,
  "program": "$(build/haptrial --version)",
  "${table}_sha256": "$(sum "results/$study/$table.csv")"
}
EOF
