#!/usr/bin/env bash
# package_chroot.sh ROOTFS PACKAGE FOLDER: the robot's package in a clean Debian root that holds what it depends on: install, upgrade, remove, purge, as
# an administrator meets them. Needs root, and no network. FOLDER is made and removed.
set -euo pipefail
rootfs="$1" package="$2" folder="$3"
tree="$folder/tree"
rm -rf "$folder"
mkdir -p "$folder"
trap 'rm -rf "$folder"' EXIT
failures=0

check() {  # check WORDS COMMAND…
  local words="$1"
  shift
  if "$@" >"$folder/said" 2>&1; then
    echo "met      $words"
  else
    echo "NOT MET  $words: $(tail -n 3 "$folder/said" | tr '\n' ' ')"
    failures=$((failures + 1))
  fi
}
inside() { chroot "$tree" "$@"; }
files() { (cd "$tree" && find . -xdev \( -path ./var/cache -o -path ./var/lib/dpkg -o -path ./var/log -o -path ./run -o -path ./tmp \) -prune -o -print | sort); }
install_package() { cp "$1" "$tree/tmp/robot.deb" && inside dpkg --force-unsafe-io --force-confdef --force-confold -i /tmp/robot.deb; }

cp -a --reflink=auto "$rootfs" "$tree"
files >"$folder/before"

check "installs with what it depends on, and nothing forced" install_package "$package"
check "is configured" bash -c "chroot '$tree' dpkg-query -W -f '\${Status}' cgsr | grep -qx 'install ok installed'"
check "its program finds its libraries and runs" inside cgsr --version
check "has a user of its own, who may open cameras" bash -c "chroot '$tree' id -nG cgsr | grep -qw video"
check "is started at boot" test -L "$tree/etc/systemd/system/multi-user.target.wants/cgsr.service"
check "systemd accepts its unit" inside systemd-analyze verify --man=no /usr/lib/systemd/system/cgsr.service
check "checks its own configuration" inside cgsr check --devices-may-be-late --config /etc/cgsr/robot.toml

echo "motion.max_forward_mps = 0.2  # mine" >>"$tree/etc/cgsr/robot.toml"
inside systemctl disable cgsr.service >/dev/null 2>&1
dpkg-deb -R "$package" "$folder/next"
version="$(dpkg-deb -f "$package" Version)"
sed -i "s/^Version: .*/Version: $version+next/" "$folder/next/DEBIAN/control"
echo "# a line of the next version" >>"$folder/next/etc/cgsr/robot.toml"
dpkg-deb -Znone -b "$folder/next" "$folder/next.deb" >/dev/null
check "upgrades to a later version" install_package "$folder/next.deb"
check "the later version is there" bash -c "chroot '$tree' dpkg-query -W -f '\${Version}' cgsr | grep -qx '$version+next'"
check "an upgrade keeps the administrator's file" grep -q '# mine' "$tree/etc/cgsr/robot.toml"
check "an upgrade leaves a service disabled that was disabled" test ! -e "$tree/etc/systemd/system/multi-user.target.wants/cgsr.service"

check "is removed" inside dpkg -r cgsr
check "a removal keeps the administrator's file" test -e "$tree/etc/cgsr/robot.toml"
check "a removal takes the program" test ! -e "$tree/usr/bin/cgsr"
check "is purged" inside dpkg --purge cgsr
files >"$folder/after"
comm -13 "$folder/before" "$folder/after" | grep -vE '^\./(etc/(passwd|group|shadow|gshadow)-?|etc/\.pwd\.lock)$' >"$folder/left" || true
check "a purge leaves no file behind" test ! -s "$folder/left"
sed 's/^/         left: /' "$folder/left"
[ "$failures" = 0 ]
