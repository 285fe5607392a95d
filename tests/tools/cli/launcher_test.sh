#!/usr/bin/env bash
# launcher_test.sh LAUNCHER TEST: runs the function TEST on a copy of the launcher, in a project of its own where apt,
# cmake and ninja are stand-ins that note their calls. Exit status 0 where it keeps its promise.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
project="$folder/the project"
calls=$folder/calls
mkdir -p "$project"/{host,kernels} "$folder"/{tools,home}
cp "$1" "$project/luciole"
touch "$project/CMakeLists.txt" "$calls"
unset LUCIOLE_BUILD XDG_CACHE_HOME POCL_CACHE_DIR
export HOME=$folder/home PATH="$folder/tools:$PATH" folder calls

# standIn NAME: a tool NAME that notes its call and then does what standard input says.
standIn() {
  # shellcheck disable=SC2016
  { printf '#!/usr/bin/env bash\necho %s "${@@Q}" >>"$calls"\n' "$1" && cat; } >"$folder/tools/$1"
  chmod +x "$folder/tools/$1"
}

standIn cmake <<'END'
while (($#)); do
  case $1 in -S) source=$2 ;; -B) build=$2 ;; esac
  shift
done
echo "CMAKE_HOME_DIRECTORY:INTERNAL=$source" >"$build/CMakeCache.txt"
touch "$build/build.ninja"
END
# Builds a program that shows its folder, arguments and standard input. A build reads whatever input it can get.
standIn ninja <<'END'
cat >/dev/null
sleep 0.3
echo "ninja's own chatter"
if [[ -e $folder/broken ]]; then echo "shade.cpp:7: error: broken" && exit 1; fi
printf '%s\n' '#!/usr/bin/env bash' 'if [[ $* == compile ]]; then echo >>"$folder/compiled"; exit 4; fi' 'printf "<%s>" "$PWD" "$@" "$(cat)"' 'exit 7' >"$2/luciole"
chmod +x "$2/luciole"
END
standIn dpkg-query <<'END'
for name in "${@:4}"; do [[ -e $folder/missing/$name ]] || echo "installed $name"; done
END
standIn apt-get <<'END'
if [[ " $* " == *" update "* ]]; then touch "$folder/lists"; else [[ -e $folder/lists ]]; fi
END
standIn apt-cache <<'END'
[[ -e $folder/lists && ! -e $folder/unknown/${@: -1} ]]
END
standIn sudo <<'END'
exec "$@"
END
# Tells three tests, of which two were skipped, and a suite with two more skipped ones, as ctest does.
standIn ctest <<'END'
while (($#)) && [[ $1 != --output-junit ]]; do shift; done
cat >"$2" <<'XML'
<testsuite>
	<testcase name="A.Runs" status="run">
		<system-out>all is well</system-out>
	</testcase>
	<testcase name="SuiteOfThree" status="run">
		<system-out>[ RUN      ] SuiteOfThree.First
a_test.cpp:8: Skipped
needs ffmpeg

[  SKIPPED ] SuiteOfThree.First (0 ms)
[ RUN      ] SuiteOfThree.Second
[       OK ] SuiteOfThree.Second (0 ms)
[ RUN      ] SuiteOfThree.Third
a_test.cpp:9: Skipped
needs ffmpeg

[  SKIPPED ] SuiteOfThree.Third (0 ms)
</system-out>
	</testcase>
	<testcase name="A.IsSkippedByGoogleTest" status="notrun">
		<skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>
		<properties/>
		<system-out>Note: Google Test filter = A.IsSkippedByGoogleTest
[ RUN      ] A.IsSkippedByGoogleTest
a_test.cpp:7: Skipped
needs oclgrind, which this system&apos;s archive lacks

[  SKIPPED ] A.IsSkippedByGoogleTest (0 ms)
</system-out>
	</testcase>
	<testcase name="B.IsSkippedByAScript" status="notrun">
		<skipped message="SKIP_RETURN_CODE=77"/>
		<properties/>
		<system-out>needs munged
</system-out>
	</testcase>
</testsuite>
XML
printf '%s\n' "1/3 Test A" "50% tests passed, 1 tests failed out of 2" "" "Errors while running CTest"
END

expect() {  # expect WHAT FOUND WANTED
  [[ $2 == "$3" ]] || { printf '%s is\n  %s\ninstead of\n  %s\n' "$1" "$2" "$3" && exit 1; }
}
callsOf() { grep -c "^$1 " "$calls" || true; }
launch() { "$project/luciole" "$@" </dev/null >"$folder/output" 2>"$folder/errors" || status=$?; }

KeepsFolderArgumentsInputAndStatus() {
  mkdir "$folder/some where"
  ln -s "$project/luciole" "$folder/some where/link"
  cd "$folder/some where"
  local output status=0
  output=$(echo "a scene" | ./link render "two words" '' '*' 2>/dev/null) || status=$?
  expect output "$output" "<$PWD><render><two words><><*><a scene>"
  expect status "$status" 7
}

BuildsAgainOnlyWhenASourceIsNewer() {
  launch && launch
  expect "number of builds" "$(callsOf ninja)" 1
  expect "number of dpkg-query calls" "$(callsOf dpkg-query)" 1
  touch "$project/kernels/new.cl"
  launch && launch
  expect "number of builds after a change" "$(callsOf ninja)" 2
  expect "number of configurations" "$(callsOf cmake)" 1
}

CompilesKernelsAfterABuildAndGoesOnWhereThatFails() {
  launch render && launch render
  expect "number of times" "$(wc -l <"$folder/compiled")" 1
  expect output "$(<"$folder/output")" "<$PWD><render><>"
  expect status "$status" 7
}

FailedBuildShowsItsLogAndIsTriedAgain() {
  local status=0
  touch "$folder/broken"
  launch
  expect status "$status" 3
  grep -q "shade.cpp:7: error: broken" "$folder/errors"
  rm "$folder/broken"
  launch
  expect "status once mended" "$status" 7
}

TwoAtOnceBuildOnce() {
  "$project/luciole" </dev/null >/dev/null 2>&1 &
  launch
  local other=0
  wait $! || other=$?
  expect "status of the other" "$other" 7
  expect "number of builds" "$(callsOf ninja)" 1
}

CopiedCheckoutIsBuiltFromItsOwnSources() {
  launch
  cp -a "$project" "$folder/copy"
  project=$folder/copy
  launch
  expect "number of configurations" "$(callsOf cmake)" 2
  expect "source folder" "$(sed 's/.*=//' "$folder/copy/build/CMakeCache.txt")" "$folder/copy"
}

InstallsOnlyWhatIsMissing() {
  mkdir "$folder/missing"
  touch "$folder/missing/libglm-dev" "$folder/missing/libfmt-dev"
  launch
  expect "number of list updates" "$(grep -c "^apt-get .* 'update'$" "$calls")" 1
  expect "last apt call" "$(grep '^apt-get' "$calls" | tail -n 1 | sed "s/.*'install'/'install'/")" \
    "'install' '--no-install-recommends' 'libglm-dev' 'libfmt-dev'"
}

TestBuildsAllAndPassesArgumentsOn() {
  launch test -R "Two Words"
  expect "target" "$(grep '^ninja' "$calls" | sed 's/.* //')" "'all'"
  expect "arguments of ctest" "$(grep '^ctest' "$calls" | sed "s/.*'-j' '[0-9]*' //")" "'-R' 'Two Words'"
  LUCIOLE_TESTS=some_tests launch test
  expect "target that was named" "$(grep '^ninja' "$calls" | tail -n 1 | sed 's/.* //')" "'some_tests'"
}

TestPackagesThatTheArchiveLacksAreLeftOutAndTold() {
  mkdir "$folder"/{missing,unknown}
  touch "$folder"/missing/{clang,oclgrind} "$folder/unknown/oclgrind"
  # shellcheck disable=SC2016
  standIn ninja <<<'echo "unavailable: $LUCIOLE_UNAVAILABLE" >"$folder/told"'
  launch test
  expect "what the tests are told" "$(<"$folder/told")" "unavailable: oclgrind"
  expect "last apt call" "$(grep '^apt-get' "$calls" | tail -n 1 | sed "s/.*'install'/'install'/")" \
    "'install' '--no-install-recommends' 'clang'"
  grep -q "archive lacks oclgrind" "$folder/errors"
  launch test
  expect "number of list updates" "$(grep -c "^apt-get .* 'update'$" "$calls")" 1
}

SkippedTestsAreToldWithTheirReasonsAboveCtestsLastLines() {
  launch test
  expect output "$(<"$folder/output")" "1/3 Test A
Skipped tests: 4
  2 × needs ffmpeg
  1 × needs munged
  1 × needs oclgrind, which this system's archive lacks
50% tests passed, 1 tests failed out of 2

Errors while running CTest"
  expect status "$status" 0
  standIn ctest <<<'exit 8'
  launch test
  expect "status of tests that fail" "$status" 8
}

status=0
"$2"
