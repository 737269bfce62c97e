#!/usr/bin/env bash
# man-page.sh COMMAND FILE: writes the manual page of haptrial (.gz) from what its --help says.
set -euo pipefail
command=$1 file=$2

# Text as it stands, for troff: no line is a request, no backslash an escape.
as_text() { sed -e 's/\\/\\e/g' -e "s/^\([.']\)/\\\\\&\1/" -e 's/-/\\-/g'; }

subcommands() { sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p'; }

# page NAME...: the help of a subcommand, then of those below it.
page() {
  local help name
  help=$("$command" "$@" --help)
  printf '.SH "%s"\n.nf\n%s\n.fi\n' "haptrial $*" "$(as_text <<<"$help")"
  for name in $(subcommands <<<"$help"); do page "$@" "$name"; done
}

help=$("$command" --help)
{
  printf '.TH HAPTRIAL 1 "" "%s" "User Commands"\n' "$("$command" --version | sed -n 1p)"
  printf '.SH NAME\nhaptrial \\- force\\-feedback experiments: run, record, analyse\n'
  printf '.SH SYNOPSIS\n.B haptrial\n.I SUBCOMMAND\n[\\fIOPTIONS\\fR]\n'
  printf '.SH DESCRIPTION\n.nf\n%s\n.fi\n' "$(as_text <<<"$help")"
  for name in $(subcommands <<<"$help"); do page "$name"; done
} | gzip -9n >"$file.partial"
mv "$file.partial" "$file"
