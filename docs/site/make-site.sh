#!/usr/bin/env bash
# Makes the site in out/site from the documents as they are: search, a gallery of the shipped
# experiments, guides by role, and the reference of commands, keys, tables and headers.
#   docs/site/make-site.sh [FOLDER]    HAPTRIAL=build/haptrial HEADERS=no leaves the headers out
# Open index.html; neither reading nor searching needs a server or a network.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$root/cmake/setup.sh"
site=$(realpath -m "${1:-$root/out/site}")
haptrial=$(realpath -m "${HAPTRIAL:-$root/build/haptrial}")
[ -x "$haptrial" ] || die "no command $haptrial; build it first, or name it in HAPTRIAL"
install_packages site
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PYTHONPATH=$root/docs/site PYTHONDONTWRITEBYTECODE=1
python=/usr/bin/python3  # Debian's, which has mkdocs

# Each public header has a page; a warning of Doxygen is an error (Doxyfile says which there are).
headers() {
  mkdir -p "$work/pages/headers"
  (cd "$root" && cat docs/site/Doxyfile - <<<"OUTPUT_DIRECTORY=$work/pages
    GENERATE_TAGFILE=$work/headers.xml" | run_quietly doxygen -)
}

[ "${HEADERS:-yes}" = no ] || headers
"$python" -m site_pages "$root" "$haptrial" "$work"
run_quietly "$python" -m mkdocs build --strict --quiet --config-file "$work/mkdocs.yml" --site-dir "$work/site"
"$python" -m site_finish "$work/site"
run_quietly "$python" -m site_check "$work/site"
mkdir -p "$(dirname "$site")"
rm -rf "$site"
mv "$work/site" "$site"
say "$site/index.html"
