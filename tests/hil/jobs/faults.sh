# Every fault, REPEAT times, in an order that changes.
. /hil/library
. /hil/faults
started || exit 3
mark "ready"
failures=0
for ((round = 1; round <= ${REPEAT:-1}; ++round)); do
  for name in $(shuf -e --random-source=<(yes $round) ${FAULTS:-$(fault_names)}); do
    fault "$name" || failures=$((failures + 1))
    say "round $round: $name, $failures failed"
  done
done
systemctl stop cgsr
mark "stopped"
exit $failures
