#!/usr/bin/env bash
# Makes the site of the documents in out/site with mkdocs, and a page of each header with Doxygen.
#   docs/site/make-site.sh [FOLDER]
# Search needs a server: python3 -m http.server -d out/site
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$root/cmake/setup.sh"
site=$(realpath -m "${1:-$root/out/site}")
install_packages site
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root"
mkdir "$work/pages"
cp docs/site/mkdocs.yml "$work"
cp -r [A-Z]* ./*.sh analysis cmake core docs experiments protocols results tests "$work/pages"
# Warnings are errors: of Doxygen (Doxyfile says which there are), and of mkdocs for a dead link.
run_quietly doxygen - < <(cat docs/site/Doxyfile - <<<"OUTPUT_DIRECTORY=$work/pages")
run_quietly /usr/bin/python3 -m mkdocs build --strict --quiet --config-file "$work/mkdocs.yml" --site-dir "$site"
say "$site/index.html"
