# kill -9 and SIGSTOP at random moments of a robot in motion.
. /hil/library
. /hil/faults
RANDOM=20261125
started || exit 3
failures=0
for ((round = 1; round <= ${REPEAT:-10}; ++round)); do
  FAULT_AFTER="0.$((RANDOM % 900 + 100))"
  if ((RANDOM % 2)); then fault killed; else fault hung; fi || failures=$((failures + 1))
  say "round $round, $failures failed"
done
exit $failures
