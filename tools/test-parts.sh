# Parts of tools/test: each is timed, and what fails is remembered until the end. Sourced after tools/common.sh.

failed=() flaky=() parts=()
most_retried=5  # more failures than this are no accident

# part NAME COMMAND…: runs the command and remembers how long it took.
part() {
  local name="$1" start=$SECONDS
  shift
  "$@"
  parts+=("$(printf '%-16s %5.1f min' "$name" "$(minutes $((SECONDS - start)))")")
}

minutes() { awk -v seconds="$1" 'BEGIN { printf "%.2f", seconds / 60 }'; }

# run_tests PRESET CTEST-ARGUMENT…
run_tests() {
  local preset="$1" scratch before left names count
  shift
  scratch="$(mktemp -d)"
  before="$(untracked)"
  say "tests of build/$preset"
  if ! quarantined "$scratch" ctest --test-dir "build/$preset" --output-on-failure --no-tests=error -j "$(nproc)" "$@"; then
    names="$root/build/$preset/Testing/Temporary/LastTestsFailed.log"
    count=$(wc -l <"$names" 2>/dev/null || echo 0)
    if [ "$count" -eq 0 ] || [ "$count" -gt "$most_retried" ]; then
      failed+=("$preset tests")
    else
      retry "$preset" "$scratch" "$names"
    fi
  fi
  left="$( (cd "$scratch" && find tmp -mindepth 1 && find cache -type f); comm -13 <(echo "$before") <(untracked))"
  rm -rf "$scratch"
  if [ -n "$left" ]; then
    printf 'left behind by a test of build/%s: %s\n' "$preset" "$left" >&2
    failed+=("$preset tests left files behind")
  fi
}

# Runs a command whose temporary files and cache lie in folders of their own. Mesa's cache of shaders is not the tests' to fill.
quarantined() {
  local scratch="$1"
  shift
  mkdir -p "$scratch/tmp" "$scratch/cache"
  TMPDIR="$scratch/tmp" TEST_TMPDIR="$scratch/tmp/" XDG_CACHE_HOME="$scratch/cache" MESA_SHADER_CACHE_DISABLE=true \
    PYTHONDONTWRITEBYTECODE=1 "$@"
}

# Files that are not git's, except what the build makes.
untracked() { git status --porcelain --ignored --untracked-files=all 2>/dev/null | grep -E '^(\?\?|!!) ' | grep -vE '^!! (build|out)/' | sort || true; }

# retry PRESET SCRATCH NAMES: once more, one at a time. Who passes now is flaky, who does not has failed.
retry() {
  local preset="$1" scratch="$2" once twice
  once="$(cut -d: -f2- "$3" | sort)"
  say "once more: $once"
  if quarantined "$scratch" ctest --test-dir "build/$preset" --output-on-failure --rerun-failed; then
    twice=""
  else
    twice="$(cut -d: -f2- "$3" | sort)"
    failed+=("$preset tests (each twice): $twice")
  fi
  mapfile -t -O "${#flaky[@]}" flaky < <(comm -23 <(echo "$once") <(echo "$twice") | sed "s/^/$preset: /")
}

run_checks() { tools/check "$@" || failed+=("tools/check $*"); }

# Prints the time of every part, flaky tests and failures; its exit code is that of tools/test.
report_parts() {
  say "how long it took, on $(nproc) processors"
  printf '  %s\n' "${parts[@]}" "$(printf '%-16s %5.1f min' all "$(minutes "$SECONDS")")" >&2
  if [ "${#flaky[@]}" -gt 0 ]; then
    say "FLAKY: passed only when run once more"
    printf '  %s\n' "${flaky[@]}" >&2
  fi
  if [ "${#failed[@]}" -gt 0 ]; then
    say "FAILED: ${failed[*]}. Rerun one test by name: tools/test NAME"
    exit 1
  fi
  say "all passed. Reports of single tests: build/release/Testing/Temporary/LastTest.log"
}
