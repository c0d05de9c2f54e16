# Shared by tools/run, tools/test and tools/check: where things are, what is missing, one build.
# Sourced, not run. Sets $root and moves there.

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

say() { printf '\033[1m== %s\033[0m\n' "$*" >&2; }
die() { printf 'error: %s\n' "$*" >&2; exit 1; }

# Installs the packages of tools/packages.txt that are not there yet; does nothing, quickly, when all are.
install_packages() {
  local wanted missing=() log
  command -v dpkg-query >/dev/null || die "this is not Debian: install the packages of tools/packages.txt by hand"
  mapfile -t wanted < <(grep -vE '^[[:space:]]*(#|$)' "$root/tools/packages.txt")
  mapfile -t missing < <(comm -23 <(printf '%s\n' "${wanted[@]}" | sort -u) \
    <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' 2>/dev/null | awk '$2 == "installed" {print $1}' | sort -u))
  # Node.js from elsewhere brings its own npm, and Debian's package refuses to stand beside it.
  if command -v npm >/dev/null; then
    mapfile -t missing < <(printf '%s\n' "${missing[@]}" | grep -vx -e npm -e '')
  fi
  [ "${#missing[@]}" -eq 0 ] && return 0

  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "missing packages and neither root nor sudo here. As root: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  say "installing ${#missing[@]} packages: ${missing[*]}"
  mkdir -p "$root/build"
  log="$root/build/apt.log"
  "${as_root[@]}" apt-get update >"$log" 2>&1 || die "apt-get update failed; see build/apt.log"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}" >>"$log" 2>&1 ||
    die "apt-get install failed; the last lines of build/apt.log:
$(tail -n 5 "$log")"
}

# build PRESET [TARGET…]: configures once, then builds. Quiet when there is nothing to do. A folder that is not there yet is set up to be built
# from nothing, groups of files as one; who works on the code and recompiles single files runs `cmake --preset PRESET` first, or sets CGSR_UNITY=OFF.
build() {
  local preset="$1" start precompile=OFF
  shift
  start=$SECONDS
  [ "$preset" = release ] && precompile=ON  # takes longer than it saves for the few programs that run under a sanitizer
  if [ ! -f "$root/build/$preset/build.ninja" ]; then
    say "configuring build/$preset"
    cmake -S "$root" --preset "$preset" -DCGSR_UNITY="${CGSR_UNITY:-ON}" -DCGSR_PRECOMPILE="$precompile" >"$root/build-$preset.log" 2>&1 ||
      { cat "$root/build-$preset.log" >&2; rm -f "$root/build-$preset.log"; die "cmake failed"; }
    rm -f "$root/build-$preset.log"
  fi
  say "building $preset${1:+: $*}"
  # Quiet while it goes well; what failed is built once more to be read.
  if ! cmake --build "$root/build/$preset" ${1:+--target "$@"} | tail -n 1 >&2; then
    cmake --build "$root/build/$preset" ${1:+--target "$@"} >&2 || die "the build failed"
  fi
  say "built $preset in $((SECONDS - start)) s"
}
