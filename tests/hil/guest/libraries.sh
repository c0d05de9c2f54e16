#!/usr/bin/env bash
# libraries.sh ROOTFS PACKAGE [NAME…]: installs into the root file system what the robot's package depends on, and the named packages. The
# host's apt resolves and downloads; the guest needs no network.
set -euo pipefail
rootfs="$1" package="$(realpath "$2")"
shift 2
archives="$rootfs/var/cache/apt/archives"
mkdir -p "$archives/partial"
apt-get -q -y --no-install-recommends --download-only -o Dir::State::status="$rootfs/var/lib/dpkg/status" -o Dir::Cache::archives="$archives" \
  -o Debug::NoLocking=true install "$package" "$@"
if compgen -G "$archives/*.deb" >/dev/null; then
  chroot "$rootfs" bash -c 'dpkg --force-unsafe-io -i /var/cache/apt/archives/*.deb'
  rm -f "$archives"/*.deb
fi
chroot "$rootfs" ldconfig
