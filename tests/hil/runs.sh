# The runs of tools/hil by name. Sourced. CGSR_HIL_REPEAT says how often each fault, CGSR_HIL_FAULTS which ones; CGSR_HIL_PART names a part of a run
# that is done in several, which gets a folder of its own (out/hil/NAME-PART): the table of docs/faults.md joins them. CGSR_HIL_CAMERA=loopback takes
# v4l2loopback for faults that are not the camera's: it costs the host half of what vivid does. CGSR_HIL_MEMORY_MB is the
# guest's memory beside the images.

# run_hil NAME LONG
#   timing    images of the scenario from memory, for a minute (where the scenario is shorter, its last image stands); deadlines count
#   function  the first image stands, so that the robot always has something to follow; faults come
run_hil() {
  local name="$1" long="$2" start=$SECONDS job="$root/out/hil/$1${CGSR_HIL_PART:+-$CGSR_HIL_PART}" scene=sim-home-start play_s=60 scene_s=60 repeat=1 limit_s=900 camera=vivid script="$1" robot=follow memory_mb="${CGSR_HIL_MEMORY_MB:-1024}" arm_s spent
  spent=$(processor_s)
  case "$name" in
    package) run_package; return ;;
    power_cut) run_power_cut $((long == 1 ? 10 : 3)); return ;;
    devices | webcam) ;;
    short) limit_s=300 ;;
    profile) ;;
    follow) scene=sim-home scene_s=45 script=timing robot=sim-home camera=loopback ;;
    round) scene=sim-home-round robot=sim-home-round script=timing camera=loopback ;;
    lamp) scene=sim-home-lamp robot=sim-home-lamp script=timing camera=loopback ;;
    faults) limit_s=7200; [ "$long" = 0 ] || repeat=10 ;;
    kill) camera=loopback repeat=5 limit_s=7200; [ "$long" = 0 ] || repeat=100 ;;
    *) die "there is no run '$name' (there are: package, devices, webcam, short, profile, follow, round, lamp, faults, kill, power_cut)" ;;
  esac
  # In the guest the robot of the round knows where it is when the images begin, in lock-step only after 3 s: it starts with both of them.
  if [ "$name" = round ]; then arm_s=5; else arm_s="$(arming_s "${scene%-start}")"; fi
  if [ "$scene" = sim-home-start ]; then scene "$scene" sim-home 1 "$arm_s"; else scene "$scene" "$scene" "$scene_s" "$arm_s"; fi
  repeat="${CGSR_HIL_REPEAT:-$repeat}" camera="${CGSR_HIL_CAMERA:-$camera}"
  local images="$hil/scenes/$scene/images.yuyv"
  memory_mb=$((memory_mb + $(stat -c %s "$images") / 1000000))
  prepare_job "$job" "$script" "$robot" "$camera" "$play_s" "$repeat" "$(wc -l <"$hil/scenes/$scene/stamps.txt")" "$arm_s" "$hil/scenes/$scene/motion.txt"
  say "booting for $name (${job#"$root"/}/console.txt)"
  local code=0
  ICOUNT="${CGSR_HIL_ICOUNT:-1}" IMAGES="$images" MEMORY_MB="$memory_mb" LIMIT_S="${CGSR_HIL_LIMIT_S:-$limit_s}" bash "$guest/boot.sh" "$hil" "$job" || code=$?
  python3 "$root/tests/hil/evaluate.py" "$name" "$job" --job-code "$code" --scene "$hil/scenes/$scene" || code=1
  say "$name took $((SECONDS - start)) s, $(($(processor_s) - spent)) s of processor time; $(guest_times "$job/console.txt")"
  return "$code"
}

# What the guest spent its time on: until the job starts, and all of it.
guest_times() { awk '/^job starts at/ {start = $4} /^job ends with/ {end = $6} END {printf "guest: %s s to the job, %s s in all", start, end}' "$1"; }

# The package in the guest's root file system: install, upgrade, remove, purge.
run_package() {
  mkdir -p "$root/out/hil/package"
  bash "$root/tests/hil/package_chroot.sh" "$hil/rootfs" "$(robot_package)" "$hil/package" 2>&1 | tee "$root/out/hil/package/log.txt"
  return "${PIPESTATUS[0]}"
}

# run_power_cut COUNT: the guest loses its power in the middle of writing, COUNT times; each boot checks what the one before has left.
run_power_cut() {
  local job="$root/out/hil/power_cut" count="$1" boot whole=0 code
  rm -rf "$job"
  mkdir -p "$job"
  mke2fs -q -F -t ext4 "$hil/state.ext4" 128M
  for ((boot = 0; boot <= count; ++boot)); do
    prepare_job "$job/$boot" power_cut follow vivid 0 1 0
    sed -i "1i export RANDOM_CUT=$((boot * 5 + 1)) CUT=$((boot < count))" "$job/$boot/run.sh"
    sed -i 's/FEED=1/FEED=0/' "$job/$boot/env"
    code=0
    ICOUNT="${CGSR_HIL_ICOUNT:-1}" STATE="$hil/state.ext4" LIMIT_S=300 bash "$guest/boot.sh" "$hil" "$job/$boot" 2>/dev/null || code=$?
    grep -h "power_cut:" "$job/$boot/console.txt" || true
    ! grep -q "power_cut: whole" "$job/$boot/console.txt" || whole=$((whole + 1))
  done
  rm -f "$hil/state.ext4"
  python3 "$root/tests/hil/evaluate.py" power_cut "$job" --job-code "$code" --cuts "$count" --whole "$whole"
}

# The scenario of config/robots/NAME.toml.
scenario_file() {
  python3 - "config/robots/$1.toml" <<'PYTHON'
import pathlib, sys, tomllib
robot = pathlib.Path(sys.argv[1])
print((robot.parent / tomllib.loads(robot.read_text())["sim"]["scenario"]).resolve())
PYTHON
}

# When the arming switch is pressed in it, s.
arming_s() {
  python3 - "$(scenario_file "$1")" <<'PYTHON'
import pathlib, sys, tomllib
scenario = tomllib.loads(pathlib.Path(sys.argv[1]).read_text())
print(next(event["from_s"] for event in scenario["line_event"] if event["line"] == "arming"))
PYTHON
}

prepare_job() {
  local job="$1" script="$2" robot="$3" camera="$4" play_s="$5" repeat="$6" count="$7" arm_s="${8:-}" motion="${9:-}"
  rm -rf "$job"
  mkdir -p "$job/root/etc/cgsr" "$job/root/etc/systemd/system/cgsr.service.d" "$job/root/usr/libexec"
  printf 'export PLAY_S=%s REPEAT=%s FAULTS="%s"\n' "$play_s" "$repeat" "${CGSR_HIL_FAULTS:-}" | cat - "$root/tests/hil/jobs/$script.sh" >"$job/run.sh"
  strip -o "$job/root/usr/libexec/cgsr-hil-feeder" "$program/cgsr-hil-feeder"
  printf 'CAMERA=%s\nFEED=1\nIMAGES=%s\n' "$camera" "$count" >"$job/env"
  case "$script" in
    devices | webcam) ;;  # the package as it was installed
    timing)
      echo "ARM_AFTER=$arm_s" >>"$job/env"
      mkdir -p "$job/root/usr/share/cgsr-hil"
      cp -r config "$job/root/usr/share/cgsr-hil/"
      [ ! -e "$motion" ] || cp "$motion" "$job/root/usr/share/cgsr-hil/"  # of a scene that was made before it was written: the base says what it does
      sed "s|@ROBOT@|/usr/share/cgsr-hil/config/robots/$robot.toml|" "$root/tests/hil/robots/timing.toml" >"$job/root/etc/cgsr/robot.toml" ;;
    *) cp "$root/tests/hil/robots/$robot.toml" "$job/root/etc/cgsr/robot.toml" ;;
  esac
  cp "$root/tests/hil/robots/cgsr-service.conf" "$job/root/etc/systemd/system/cgsr.service.d/hil.conf"
  [ "$script" != webcam ] || cp "$root/docs/guides/laptop-with-a-webcam.md" "$job/root/"
}
