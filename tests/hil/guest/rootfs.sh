#!/usr/bin/env bash
# rootfs.sh KERNEL MODULES FOLDER: the guest's root file system without the program: Debian's minimal base with the packages of packages.txt
# and the kernel modules that the tests load. Needs root.
set -euo pipefail
here="$(dirname "${BASH_SOURCE[0]}")"
kernel="$1" modules="$2" folder="$3"
version="$(<"$kernel/version")"
rm -rf "$folder"
sources=()
for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.sources /etc/apt/sources.list.d/*.list; do
  if [ -s "$file" ]; then sources+=("$file"); fi
done
mmdebstrap --mode=root --variant=minbase --format=directory --aptopt='Apt::Install-Recommends "false"' \
  --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
  --include="$(grep -v '^#' "$here/packages.txt" | paste -sd,)" bookworm "$folder" "${sources[@]}"

into="$folder/lib/modules/$version"
mkdir -p "$into/extra"
cp "$kernel/lib/modules/$version"/modules.{order,builtin,builtin.modinfo} "$into/"
for module in vivid vcan can can-raw can-dev can-gw configfs virtio_pci 9p 9pnet_virtio overlay ext4 i6300esb softdog; do
  modprobe -d "$kernel" -S "$version" --show-depends "$module" 2>/dev/null | awk '$1 == "insmod" {print $2}'
done | sort -u | while read -r file; do
  target="$into/${file#"$kernel/lib/modules/$version/"}"
  mkdir -p "$(dirname "$target")"
  cp "$file" "$target"
done
find "$modules" -name '*.ko' | while read -r file; do strip -g -o "$into/extra/$(basename "$file")" "$file"; done
depmod -b "$folder" "$version"

echo robot >"$folder/etc/hostname"
: >"$folder/etc/fstab"
echo 0123456789abcdef0123456789abcdef >"$folder/etc/machine-id"
passwd -q -R "$folder" -d root
# What a test would only wait for.
for unit in getty@tty1.service serial-getty@ttyS0.service systemd-networkd-wait-online.service systemd-timesyncd.service apt-daily.timer \
  apt-daily-upgrade.timer dpkg-db-backup.timer fstrim.timer e2scrub_all.timer e2scrub_reap.service systemd-pstore.service systemd-firstboot.service \
  systemd-hwdb-update.service ldconfig.service systemd-update-done.service systemd-journal-catalog-update.service; do
  ln -sf /dev/null "$folder/etc/systemd/system/$unit"
done
