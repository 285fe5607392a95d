#!/usr/bin/env bash
# ci_test.sh RUN TEST: runs the function TEST on a copy of .ci/run, in a project of its own where the launcher and the bare root are
# stand-ins, late enough for clang-tidy and the sanitizers to be left out. Exit status 0 where it keeps its promise.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder"/{project/.ci,project/tests,tools}
cp "$1" "$folder/project/.ci/run"
# Nothing is installed.
for tool in debootstrap ccache; do printf '#!/bin/sh\n' >"$folder/tools/$tool"; done
cat >"$folder/project/luciole" <<'END'
#!/usr/bin/env bash
until [[ -e $folder/begun ]]; do sleep 0.1; done
sleep 0.3
echo "100% tests passed here"
[[ ! -e $folder/fails ]]
END
chmod +x "$folder"/tools/* "$folder/project/luciole"
export folder PATH="$folder/tools:$PATH"

readonly kMinute=60
readonly kSystemPassed="Debian 13: the tests with label system pass."

# runs BEGIN: .ci/run as at minute BEGIN of its time, where the bare root does what standard input says. Its output is in $folder/output,
# its exit status in `status`.
runs() {
  rm -f "$folder/begun"
  # shellcheck disable=SC2016  # the stand-in's shell expands $folder
  { printf '#!/usr/bin/env bash\ntouch "$folder/begun"\n' && cat; } >"$folder/project/tests/bare_root.sh"
  chmod +x "$folder/project/tests/bare_root.sh"
  status=0
  SECONDS=$(($1 * kMinute)) bash "$folder/project/.ci/run" >"$folder/output" 2>&1 </dev/null || status=$?
}

# ends STATUS LINE: it had that exit status, and said the line.
ends() {
  ((status == $1)) && grep -qF "$2" "$folder/output" && return
  echo "exit status $status, not $1, or without \"$2\":"
  cat "$folder/output"
  exit 1
}

OtherTestsInDebian13MayBeUnfinishedOrNotBegun() {
  runs 66 <<<"echo '$kSystemPassed'; exec sleep 60"
  ends 0 "of all other tests the first 0 pass."
  runs 66 <<<"echo '9/9 Test #9: Lift ... Passed'; echo '$kSystemPassed'; echo '1/9 Test #1: View ... Passed'; echo '2/9 Test  #3: Square ... Passed'; exec sleep 60"
  ends 0 "of all other tests the first 2 pass."
}

FailureThereFailsTheRun() {
  runs 60 <<<"echo '1/9 Test #1: View ...***Failed'; exit 8"
  ends 1 "***Failed"
  runs 60 <<<"echo '$kSystemPassed'; echo '1/9 Test #1: View ...***Failed'; exit 8"
  ends 1 "***Failed"
  # Among tests that are still run.
  runs 66 <<<"echo '$kSystemPassed'; echo '1/9 Test #1: View ...***Timeout'; exec sleep 60"
  ends 1 "NOT FINISHED"
}

WithoutTheTestsOfTheSystemInTimeItFails() {
  runs 88 <<<"echo '1/9 Test #1: View ... Passed'; exec sleep 60"
  ends 1 "NOT FINISHED: the tests in a bare Debian 13"
}

MachineThatMakesNoRootIsTold() {
  runs 60 <<<"exit 77"
  ends 0 "NOT TESTED ON DEBIAN 13"
}

AllThatPassesEndsWell() {
  runs 60 <<<"echo '$kSystemPassed'; echo '9/9 Test #9: View ... Passed'"
  ends 0 "9/9 Test #9"
  ! grep "NOT FINISHED" "$folder/output"
}

FailureHereFailsTheRunAtOnce() {
  touch "$folder/fails"
  runs 60 <<<"exec sleep 60"
  ends 1 "tests passed here"
}

"$2"
