#!/usr/bin/env bash
# modules.sh KERNEL FOLDER: builds the modules that Debian's kernel lacks against the headers that kernel.sh unpacked: gpio-sim with the simulated
# interrupts that it needs, and v4l2loopback.
set -euo pipefail
kernel="$1" folder="$2"
version="$(<"$kernel/version")"
headers="$kernel/unpacked/usr/src/linux-headers-$version"
# The header package includes the common part by its installed path.
echo "include $kernel/unpacked/usr/src/linux-headers-${version%-amd64}-common/Makefile" >"$headers/Makefile"

rm -rf "$folder"
mkdir -p "$folder/gpio" "$folder/v4l2loopback"
cp "$kernel"/drivers/gpio/{gpio-sim.c,gpiolib.h} "$folder/gpio/"
# irq_sim can only be built into a kernel, and Debian's has it off; as a module it may not call irq_to_desc().
{
  echo '#include <linux/module.h>'
  sed 's|handle_simple_irq(irq_to_desc(irqnum));|generic_handle_irq_safe(irqnum);|' "$kernel/kernel/irq/irq_sim.c"
  echo 'MODULE_LICENSE("GPL");'
} >"$folder/gpio/irq_sim.c"
echo 'obj-m += irq_sim.o gpio-sim.o' >"$folder/gpio/Kbuild"
cp "$kernel"/unpacked/usr/src/v4l2loopback-*/*.[ch] "$folder/v4l2loopback/"
echo 'obj-m += v4l2loopback.o' >"$folder/v4l2loopback/Kbuild"
for name in gpio v4l2loopback; do
  make -s -C "$headers" M="$folder/$name" modules
done
