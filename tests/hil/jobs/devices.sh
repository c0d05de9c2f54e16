# What the drivers of this kernel say of themselves, and what the program makes of them.
. /hil/library
set -x
v4l2-ctl -d /run/hil/camera --all | head -40
v4l2-ctl -d /run/hil/camera --list-formats-ext
ip -details -statistics link show can0
gpioinfo
sleep 2
tail -n 3 /run/hil/bus.log
timeout 2 candump -n 9 can0
cgsr devices
systemctl stop cgsr  # which has them
cgsr check --config /etc/cgsr/robot.toml
