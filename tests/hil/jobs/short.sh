# Boot, follow, three faults: what CI runs.
. /hil/library
. /hil/faults
failures=0
started || exit 3
mark "ready"
say "ready"
for name in ${FAULTS:-camera_gone bus_down killed}; do
  fault "$name" || failures=$((failures + 1))
  say "$name done"
done
systemctl stop cgsr
mark "stopped"
cp /var/lib/cgsr/*.json /run/hil/ 2>/dev/null
exit $failures
