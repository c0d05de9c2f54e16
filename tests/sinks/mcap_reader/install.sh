#!/bin/sh
# Installs MCAP's own reader (npm ci) into a folder of the build, once for each lock file.
#
#   install.sh FOLDER
#
# Exit code 0: it is there. 77: npm or its registry is missing; the reason is on standard output. Other: it failed.
set -eu
here="$(cd "$(dirname "$0")" && pwd)"
mkdir -p "$1"
exec 9>"$1/lock"
flock 9
cp "$here/read.mjs" "$here/package.json" "$here/.npmrc" "$1"
cmp -s "$here/package-lock.json" "$1/installed" && exit 0
command -v node >/dev/null || { echo "node is not installed (Debian: nodejs)"; exit 77; }
command -v npm >/dev/null || { echo "npm is not installed (Debian: npm)"; exit 77; }
cp "$here/package-lock.json" "$1"
if ! (cd "$1" && npm ci --no-audit --no-fund --ignore-scripts >npm.log 2>&1); then
  echo "npm ci failed: $(grep -m1 -E 'npm (ERR!|error)' "$1/npm.log" || echo "see $1/npm.log")"
  grep -qE 'ENOTFOUND|EAI_AGAIN|ECONNREFUSED|ETIMEDOUT|ECONNRESET|ENETUNREACH' "$1/npm.log" && exit 77
  exit 1
fi
cp "$here/package-lock.json" "$1/installed"
