# The recorded scenario, played to the service that systemd started. Nothing is written to a disk while it runs.
. /hil/library
started || exit 3
mark "ready"
within 60 test -e /run/hil/loaded || { say "the images are not loaded"; exit 4; }
grep -q 1 /run/hil/warm 2>/dev/null || sleep 3
mark "play"
touch /run/hil/play
sleep "${PLAY_S:-60}"
mark "end"
disarm
sleep 0.5
systemctl stop cgsr
mark "stopped"
cp /var/lib/cgsr/summary.json /run/hil/summary.json
cp /var/lib/cgsr/rows.csv /run/hil/rows.csv 2>/dev/null
systemd-analyze time
systemctl show cgsr -p NRestarts -p Result -p ExecMainStatus
