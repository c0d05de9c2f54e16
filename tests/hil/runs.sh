# The runs of tools/hil by name. Sourced.

# run NAME → the robot's file, the seconds that are played, the form.
#   timing    images of the scenario from memory; deadlines count
#   function  the first image stands, so that the robot always has something to follow; faults come
run_hil() {
  local name="$1" long="$2" start=$SECONDS job="$root/out/hil/$1" scene="" play_s=60 repeat=1 limit_s=900 camera=loopback script="$1" robot=sim-home memory_mb=1536
  case "$name" in
    devices) scene=sim-home ;;
    follow) scene=sim-home play_s=45 script=timing ;;
    round) scene=sim-home-round robot=sim-home-round script=timing ;;
    lamp) scene=sim-home-lamp robot=sim-home-lamp script=timing ;;
    short) scene=sim-home camera=vivid ;;
    faults) scene=sim-home camera=vivid limit_s=7200; [ "$long" = 0 ] || repeat=10 ;;
    kill) scene=sim-home camera=vivid repeat=5 limit_s=7200; [ "$long" = 0 ] || repeat=100 ;;
    *) die "there is no run '$name' (there are: devices, short, follow, round, lamp, faults, kill)" ;;
  esac
  local images="$hil/scenes/$scene/images.yuyv"
  if [ "$script" = timing ]; then
    scene "$scene" "$play_s"
    memory_mb=$((1024 + $(stat -c %s "$images") / 1000000))
  else
    scene "$scene-start" 1
    images="$hil/scenes/$scene-start/images.yuyv"
  fi
  prepare_job "$job" "$script" "$robot" "$camera" "$play_s" "$repeat" "$(wc -l <"$(dirname "$images")/stamps.txt")"
  say "booting for $name (out/hil/$name/console.txt)"
  local code=0
  ICOUNT="${CGSR_HIL_ICOUNT:-1}" IMAGES="$images" MEMORY_MB="$memory_mb" LIMIT_S="${CGSR_HIL_LIMIT_S:-$limit_s}" bash "$guest/boot.sh" "$hil" "$job" || code=$?
  python3 "$root/tests/hil/evaluate.py" "$name" "$job" --job-code "$code" --scene "$(dirname "$images")" || code=1
  say "$name took $((SECONDS - start)) s"
  return "$code"
}

prepare_job() {
  local job="$1" script="$2" robot="$3" camera="$4" play_s="$5" repeat="$6" count="$7"
  rm -rf "$job"
  mkdir -p "$job/root/etc/cgsr" "$job/root/usr/share/cgsr-hil" "$job/root/etc/systemd/system/cgsr.service.d"
  cp "$root/tests/hil/jobs/$script.sh" "$job/run.sh"
  printf 'export PLAY_S=%s REPEAT=%s FAULTS="%s"\n' "$play_s" "$repeat" "${CGSR_HIL_FAULTS:-}" | cat - "$job/run.sh" >"$job/run" && mv "$job/run" "$job/run.sh"
  mkdir -p "$job/root/usr/libexec"
  strip -o "$job/root/usr/libexec/cgsr-hil-feeder" "$program/cgsr-hil-feeder"
  printf 'CAMERA=%s\nFEED=1\nIMAGES=%s\n' "$camera" "$count" >"$job/env"
  cp -r config "$job/root/usr/share/cgsr-hil/"
  sed "s|@ROBOT@|/usr/share/cgsr-hil/config/robots/$robot.toml|" "$root/tests/hil/robots/robot.toml" >"$job/root/etc/cgsr/robot.toml"
  [ "$script" = timing ] || cat "$root/tests/hil/robots/unbounded.toml" >>"$job/root/etc/cgsr/robot.toml"
  cp "$root/tests/hil/robots/cgsr-service.conf" "$job/root/etc/systemd/system/cgsr.service.d/hil.conf"
  if [ -z "$(package_files)" ]; then  # no package: the program as cmake --install lays it out
    DESTDIR="$job/root" cmake --install "$program" --prefix /usr --component cgsr >/dev/null
  fi
}
