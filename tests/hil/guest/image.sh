#!/usr/bin/env bash
# image.sh ROOTFS FILE PACKAGE: the guest's disk: the root file system, the guest's own files, and the robot's package as dpkg installs it.
set -euo pipefail
here="$(dirname "${BASH_SOURCE[0]}")"
rootfs="$1" file="$2" package="$3"
tree="$(dirname "$file")/tree"
rm -rf "$tree" "$file"
cp -a --reflink=auto "$rootfs" "$tree"
cp -a "$here/root/." "$tree/"
cp "$package" "$tree/tmp/robot.deb"
chroot "$tree" dpkg --force-unsafe-io -i /tmp/robot.deb
rm "$tree/tmp/robot.deb"
size_mb=$(($(du -sm "$tree" | cut -f1) * 5 / 4 + 64))
mke2fs -q -F -t ext4 -O ^has_journal -d "$tree" "$file" "$(((size_mb + 127) / 128 * 128))M"  # a memory module is a multiple of that
rm -rf "$tree"
