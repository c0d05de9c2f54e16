# Every fault, REPEAT times, in an order that changes.
. /hil/library
. /hil/faults
started || exit 3
mark "ready"
all="camera_frozen:lives:2 camera_gone:lives:2 camera_corrupt:lives:1 bus_silent:lives:1 bus_down:lives:1.5 emergency_stop:lives:1 powered_off:lives:1
  second_commander:lives:1.2 stopped:lives:1 killed:dies:2 hung:dies:6 disk_full:lives:2 memory_pressure:lives:3 clock_step:lives:2"
failures=0
for ((round = 1; round <= ${REPEAT:-1}; ++round)); do
  for entry in $(shuf -e --random-source=<(yes $round) ${FAULTS:-$all}); do
    fault $(tr : ' ' <<<"$entry") || failures=$((failures + 1))
    say "round $round: $entry, $failures failed"
  done
done
systemctl stop cgsr
mark "stopped"
exit $failures
