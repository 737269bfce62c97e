#!/usr/bin/env bash
# bare_machine.sh PACKAGES FOLDER: makes a bare Debian 12 in FOLDER, installs the packages of
# make-package.sh that lie in PACKAGES, uses them as a newcomer would, and removes them. A line with
# the seconds of each step. Needs root, debootstrap and Debian's archive.
set -euo pipefail
packages=$(realpath "$1") root=$(realpath -m "$2")
trap 'umount "$root/proc" 2>/dev/null || true' EXIT

inside() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
  ${http_proxy:+http_proxy=$http_proxy} DEBIAN_FRONTEND=noninteractive chroot "$root" "$@"; }

# step NAME COMMAND...: what it printed is shown only when it fails.
step() {
  local name=$1 begun=$EPOCHREALTIME
  shift
  "$@" >"$root.log" 2>&1 || { cat "$root.log" >&2; echo "failed: $name" >&2; exit 1; }
  awk -v a="$begun" -v b="$EPOCHREALTIME" -v n="$name" 'BEGIN { printf "%-28s %6.1f s\n", n, b - a }'
}

in_home() { inside sh -c "cd /root && $1"; }

step "a bare Debian" debootstrap --variant=minbase bookworm "$root" http://deb.debian.org/debian
mount -t proc proc "$root/proc"
cp "$packages"/*.deb "$root/root/"
step "apt update" inside apt-get update -q
installed() { in_home "dpkg-query -W -f '\${Package}\n' | sort"; }
installed >"$root.before"
apt="apt-get install -q -y --no-install-recommends"
step "install haptrial" in_home "$apt ./haptrial_*.deb"
step "new, validate" in_home "haptrial new study.toml --from stiffness_discrimination &&
  haptrial validate study.toml"
step "dry run, two participants" in_home "haptrial dry-run study.toml --subjects 2 --out rehearsed"
step "report" in_home "haptrial analyze rehearsed && test -s rehearsed/report.html"
step "install python3-haptrial" in_home "$apt ./python3-haptrial_*.deb"
cat >"$root/root/notebook.py" <<'PYTHON'
import json, os
os.chdir("/usr/share/doc/haptrial/docs/worked/notebooks")
names = {"__name__": "__main__"}
for cell in json.load(open("own_method.ipynb"))["cells"]:
    if cell["cell_type"] == "code":
        exec("".join(cell["source"]), names)
PYTHON
step "a worked notebook" in_home "python3 notebook.py"
step "install libhaptrial-dev" in_home "$apt g++ make cmake ./libhaptrial-dev_*.deb"
step "build a program" in_home "cp -r /usr/share/doc/haptrial/docs/worked worked &&
  cmake -S worked/own -B built && cmake --build built --target valley"
step "use it" in_home "built/valley keys trials | grep 'type: valley'"
step "remove" inside apt-get purge -q -y haptrial python3-haptrial libhaptrial-dev
step "nothing is left" in_home "! find /usr /etc /var/lib -path /var/lib/dpkg -prune -o \
  -path /var/lib/apt -prune -o -iname '*haptrial*' -print | grep ."
