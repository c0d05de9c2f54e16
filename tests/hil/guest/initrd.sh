#!/usr/bin/env bash
# initrd.sh KERNEL FILE: the first stage of the guest: mounts the image read-only, lays a folder in memory and the job's files over it, and starts
# the init that the kernel's command line names.
set -euo pipefail
kernel="$1" file="$2"
version="$(<"$kernel/version")"
stage="$(mktemp -d)"
trap 'rm -rf "$stage"' EXIT
mkdir -p "$stage"/{bin,dev,proc,sys,modules,lower,memory,new}
cp /bin/busybox "$stage/bin/"
for applet in cp sh mount umount switch_root insmod echo cat mkdir sleep; do ln -s busybox "$stage/bin/$applet"; done
mknod "$stage/dev/console" c 5 1
for module in virtio_pci nfit nd_pmem ext4 overlay; do
  modprobe -d "$kernel" -S "$version" --show-depends "$module" 2>/dev/null | awk '$1 == "insmod" {print $2}'
done | awk '!seen[$0]++' | while read -r module; do
  cp "$module" "$stage/modules/"
  strip -g "$stage/modules/$(basename "$module")"
  basename "$module" >>"$stage/modules/order"
done
cat >"$stage/init" <<'INIT'
#!/bin/sh
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
while read -r module; do insmod "/modules/$module"; done </modules/order
mount -t ext4 -o ro,noload /dev/pmem0 /lower
mount -t tmpfs -o size=60% memory /memory
mkdir /memory/upper /memory/work
mount -t overlay -o lowerdir=/lower,upperdir=/memory/upper,workdir=/memory/work overlay /new || { echo "overlay failed"; sh; }
mkdir -p /new/job
cp /env /run.sh /new/job/
cp -a /root/. /new/
mount --move /dev /new/dev
mount --move /proc /new/proc
mount --move /sys /new/sys
exec switch_root /new /sbin/init
INIT
chmod +x "$stage/init"
(cd "$stage" && find . | cpio -o -H newc --quiet) >"$file"
