# What the last boot left is checked; then a file is written again and again, by turns with two contents, until the power goes in the middle of writing:
# as soon as the new file lies beside the old one, before it is renamed over it. CUT=0 checks only.
. /hil/library
systemctl stop cgsr hil-feeder
state=/run/hil/state
mkdir -p $state
mount -t ext4 /dev/pmem1 $state || { say "power_cut: the file system does not mount"; exit 3; }
known=$(for kind in webcam recording; do cgsr config new --$kind | sha256sum; done)
write() { cgsr config new --force --"$1" --output $state/robot.toml >/dev/null; }
if [ -e $state/writing ]; then
  left=$(find $state -name 'robot.toml.*' | wc -l)
  if grep -q "$(sha256sum <$state/robot.toml)" <<<"$known"; then say "power_cut: whole, $left files beside it"; else say "power_cut: damaged"; fi
  rm -f $state/robot.toml.*
  write recording && write webcam || say "power_cut: cannot be written again"
else
  write webcam || exit 4
  touch $state/writing
fi
sync
if [ "${CUT:-1}" = 0 ]; then
  umount $state
  exit 0
fi
# QEMU ends at once when this byte is written: nothing that is in memory only survives.
mkfifo /run/hil/never /run/hil/cut
dd of=/dev/port bs=1 seek=244 count=1 conv=notrunc status=none </run/hil/cut &
(
  exec 3<>/run/hil/never 4>/run/hil/cut
  until compgen -G "$state/robot.toml.*" >/dev/null; do read -r -t 0.0002 <&3; done
  delay=$((RANDOM_CUT % 8))
  [ $delay = 0 ] || read -r -t "0.000$delay" <&3
  printf 0 >&4
) &
chrt -f -p 60 $!
while :; do
  write recording
  write webcam
done
