# Boot, follow, three faults: what CI runs.
. /hil/library
. /hil/faults
failures=0
started || exit 3
mark "ready"
say "ready"
fault camera_gone lives 1.5 || failures=$((failures + 1))
say "camera_gone done"
fault bus_down lives 1.5 || failures=$((failures + 1))
say "bus_down done"
fault killed dies 2 || failures=$((failures + 1))
say "killed done"
systemctl stop cgsr
mark "stopped"
cp /var/lib/cgsr/*.json /run/hil/ 2>/dev/null
exit $failures
