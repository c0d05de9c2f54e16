# docs/guides/laptop-with-a-webcam.md as it stands, on vivid: what its blocks say is executed in one shell.
. /hil/library
systemctl stop cgsr
mark "ready"
mkdir -p /run/hil/guide/build/release
cd /run/hil/guide || exit 2
ln -s /usr/bin/cgsr build/release/cgsr
sed -n '/^```sh$/,/^```$/p' /laptop-with-a-webcam.md | grep -v '^```' >commands.sh
bash -euxo pipefail commands.sh </dev/null
code=$?
for output in $(grep -o '`out/[^`]*`' /laptop-with-a-webcam.md | tr -d '`' | sort -u); do
  [ -s "$output" ] || { echo "announced, but missing or empty: $output"; code=1; }
done
head -n 2 out/webcam.csv
grep -c . out/webcam.csv
exit $code
