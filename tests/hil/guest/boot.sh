#!/usr/bin/env bash
# boot.sh FOLDER JOB: boots the guest of build/hil (FOLDER) with a job, and ends when the guest does. JOB/root is laid over the guest's files, the
# results come back into JOB: console.txt is the serial line, code the job's exit code. Environment: ICOUNT=1 counts instructions as time, IMAGES
# names the file of the images, STATE a disk that keeps what is written to it, MEMORY_MB, LIMIT_S, APPEND (kernel command line).
#
# Disks are memory (NVDIMM): with counted time a computer that waits for a disk would see its clock jump.
set -euo pipefail
folder="$1" job="$2"
(cd "$job" && find root env run.sh -print0 | cpio -o -0 -H newc --quiet) >"$job/job.cpio"
cat "$folder/initrd.cpio" "$job/job.cpio" >"$job/initrd"
rm "$job/job.cpio"
trap 'rm -f "$job/initrd"' EXIT

memory() { printf 'memory-backend-file,id=%s,share=off,readonly=on,mem-path=%s,size=%s' "$1" "$2" "$(stat -c %s "$2")"; }
arguments=(-nodefaults -no-user-config -display none -no-reboot -machine pc,nvdimm=on -m "${MEMORY_MB:-1536},slots=3,maxmem=16G" -smp 1
  -cpu Nehalem -accel tcg -kernel "$folder/kernel/vmlinux" -initrd "$job/initrd" -serial "file:$job/console.txt"
  -object "$(memory disk "$folder/root.ext4")" -device nvdimm,id=nv0,memdev=disk,unarmed=on
  -fsdev "local,id=job,path=$job,security_model=none,multidevs=remap" -device virtio-9p-pci,fsdev=job,mount_tag=job
  -device isa-debug-exit,iobase=0xf4,iosize=0x04)
[ -z "${IMAGES:-}" ] || arguments+=(-object "$(memory images "$IMAGES")" -device nvdimm,id=nv1,memdev=images,unarmed=on)
[ -z "${STATE:-}" ] || arguments+=(-object "memory-backend-file,id=state,share=on,mem-path=$STATE,size=$(stat -c %s "$STATE")" -device nvdimm,id=nv2,memdev=state)
[ "${ICOUNT:-0}" = 0 ] || arguments+=(-icount "shift=0,sleep=off" -rtc "base=2026-01-01T00:00:00,clock=vm" -seed 1)
arguments+=(-append "console=ttyS0 panic=-1 quiet net.ifnames=0 nokaslr norandmaps tsc=reliable no_timer_check systemd.unit=hil.target ${APPEND:-}")
status=0
timeout "${LIMIT_S:-300}" qemu-system-x86_64 "${arguments[@]}" || status=$?
if [ ! -e "$job/code" ]; then
  spent="$(awk '{printf "%d", ($16 + $17) / 100}' "/proc/$$/stat")"
  echo "the guest did not finish (QEMU's exit code $status; the limit is ${LIMIT_S:-300} s, of which it got $spent s of processor time)" >&2
  exit 1
fi
exit "$(<"$job/code")"
