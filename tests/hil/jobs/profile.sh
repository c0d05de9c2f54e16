# The follower for a minute of the computer's time: the service's own profile and the bus log.
. /hil/library
started || exit 3
mark "ready"
within 60 test -e /run/hil/loaded || { say "the images are not loaded"; exit 4; }
arm || { say "not armed"; exit 5; }
sleep 2
mark "play"
sleep "${PLAY_S:-60}"
cp /run/cgsr/status.json /run/hil/status.json
mark "end"
disarm
sleep 0.5
systemctl stop cgsr
mark "stopped"
cp /var/lib/cgsr/*.json /var/lib/cgsr/*.csv /run/hil/
cgsr top --once /run/hil/status.json
