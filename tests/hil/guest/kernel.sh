#!/usr/bin/env bash
# kernel.sh FOLDER: Debian's kernel for the guest, its headers and the sources of the modules that it lacks, downloaded and unpacked into
# FOLDER; nothing is installed. Leaves FOLDER/version, FOLDER/vmlinux and FOLDER/lib/modules.
set -euo pipefail
folder="$1"
image="$(apt-cache depends linux-image-amd64 | sed -n 's/^ *Depends: \(linux-image-[0-9].*-amd64\)$/\1/p' | head -n 1)"
[ -n "$image" ] || { echo "apt knows no linux-image-amd64" >&2; exit 1; }
version="${image#linux-image-}"
common="${version%-amd64}-common"
series="$(cut -d. -f1,2 <<<"$version")"

rm -rf "$folder"
mkdir -p "$folder/debs" "$folder/unpacked"
cd "$folder/debs"
apt-get download -q "$image" "linux-headers-$version" "linux-headers-$common" "linux-kbuild-$series" "linux-source-$series" v4l2loopback-dkms
for package in ./*.deb; do dpkg-deb -x "$package" "$folder/unpacked"; done
rm -rf "$folder/debs"

cd "$folder"
tar -xf "unpacked/usr/src/linux-source-$series.tar.xz" --strip-components=1 "linux-source-$series/drivers/gpio" "linux-source-$series/kernel/irq" \
  "linux-source-$series/scripts/extract-vmlinux"
rm -f "unpacked/usr/src/linux-source-$series.tar.xz"
bash scripts/extract-vmlinux "unpacked/boot/vmlinuz-$version" >vmlinux
mv unpacked/lib lib
depmod -b . "$version"
echo "$version" >version
