#!/usr/bin/env bash
# slurm_test.sh LUCIOLE TEST: runs the function TEST with the program LUCIOLE on a Slurm of its own: one node, which is this
# machine, no accounts, cgroups or systemd, as whoever runs the test. Exit status 0 where the promise is kept, 77 where
# there is no Slurm.
set -euo pipefail

# The work is a child's, which hears of it and cleans up even where this process is killed.
if [[ ${3-} != child ]]; then
  setpriv --pdeathsig TERM bash "$0" "$1" "$2" child
  exit
fi

luciole=$(realpath "$1")
PATH=$PATH:/usr/sbin:/sbin
for program in munged slurmctld slurmd sbatch; do
  command -v "$program" >/dev/null && continue
  echo "needs $program (apt install munge slurmctld slurmd slurm-client)" >&2
  # Where everything is demanded, as CI does, a missing program is a failure.
  if [[ -v LUCIOLE_SHARED ]]; then exit 1; else exit 77; fi
done
# A Slurm that runs this test is another one.
unset "${!SLURM@}" "${!SBATCH@}" "${!SCANCEL@}" "${!SINFO@}" "${!SQUEUE@}"

folder=$(mktemp -d "${TMPDIR:-/tmp}/luciole-test-XXXXXX")
configuration=$folder/slurm.conf

# Whatever belongs to this Slurm (daemons, keepers of jobs, jobs) was started with its configuration in the environment.
killAll() {
  local files tries
  unset SLURM_CONF
  for ((tries = 0; tries < 100; ++tries)); do
    mapfile -t files < <(grep -lsxz "SLURM_CONF=$configuration" /proc/[0-9]*/environ)
    ((${#files[@]})) || return 0
    kill -KILL "${files[@]//[!0-9]/}" 2>/dev/null || true
    sleep 0.02
  done
}

cleanUp() {
  local status=$?
  killAll
  if ((status)); then tail -n 20 "$folder"/*.log "$folder"/*.out >&2 || true; fi
  rm -rf "$folder"
}
trap cleanUp EXIT
trap 'exit 1' INT TERM HUP

fail() {
  printf '%s\n' "$*" >&2
  exit 1
}
expect() {  # expect WHAT FOUND WANTED
  [[ $2 == "$3" ]] || fail "$1 is '$2' instead of '$3'"
}
await() {  # await SECONDS WHAT COMMAND…: until the command succeeds
  local end=$((SECONDS + $1))
  until "${@:3}"; do
    ((SECONDS < end)) || fail "waited $1 s in vain for $2"
    sleep 0.1
  done
}

daemon() {  # daemon NAME ARGS…: its process is $!
  "$@" >"$folder/$1.log" 2>&1 </dev/null &
  disown
}

# Four processors, however many there are, so that four jobs run at once. A job that is requeued waits until its first
# credential can't be valid any more: cred_expire and a second.
configure() {  # configure PORT
  cat >"$configuration" <<CONFIGURATION
ClusterName=luciole
SlurmctldHost=${HOSTNAME%%.*}(127.0.0.1)
SlurmctldPort=$1
SlurmdPort=$(($1 + 1))
NodeName=here NodeHostname=${HOSTNAME%%.*} NodeAddr=127.0.0.1 CPUs=4
PartitionName=all Nodes=here Default=YES
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
CredType=cred/munge
AuthInfo="socket=$folder/munge.socket,cred_expire=5"
StateSaveLocation="$folder/state"
SlurmdSpoolDir="$folder/spool"
SlurmctldPidFile="$folder/slurmctld.pid"
SlurmdPidFile="$folder/slurmd.pid"
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=1
SlurmdParameters=config_overrides
MailProg=/bin/true
CONFIGURATION
  # Nothing above uses cgroups; named, they are not looked for, which fails where none are mounted.
  echo CgroupPlugin=cgroup/v1 >"$folder/cgroup.conf"
}

# Fails where the port is another's.
startSlurm() {  # startSlurm PORT
  local controller node tries
  rm -rf "$folder"/{state,spool}
  mkdir "$folder"/{state,spool}
  configure "$1"
  daemon slurmctld -D && controller=$!
  daemon slurmd -D && node=$!
  for ((tries = 0; tries < 200; ++tries)); do
    [[ -d /proc/$controller && -d /proc/$node ]] || break
    # Another's port may never answer.
    [[ $(timeout 5 sinfo -h -o %t 2>/dev/null) != idle ]] || return 0
    sleep 0.05
  done
  kill -KILL "$controller" "$node" 2>/dev/null || true
  return 1
}

startCluster() {
  local tries=5
  export SLURM_CONF=$configuration
  (umask 077 && head -c 128 /dev/urandom >"$folder/munge.key")
  # Forced, as it has doubts about folders that only one user may enter.
  daemon munged --foreground --force --socket="$folder/munge.socket" --key-file="$folder/munge.key" \
    --pid-file="$folder/munge.pid" --log-file="$folder/munge.log" --seed-file="$folder/munge.seed"
  await 20 munged test -S "$folder/munge.socket"
  # Ports below those that the system gives to clients.
  until startSlurm $((16384 + RANDOM % 8192 * 2)); do
    ((--tries)) || fail "Slurm doesn't start"
  done
}

# A task is ARRAY_INDEX.
statesOf() { squeue -h -r -t all -j "$1" -o %T | sort | uniq -c | xargs; }
hasStates() { [[ $(statesOf "$1") == "$2" ]]; }

# Kills what the task runs, as a machine that fails does, and has Slurm run it again.
killAndRequeue() {  # killAndRequeue TASK
  local process rest processes=()
  while read -r process rest; do
    if [[ $process != PID ]]; then processes+=("$process"); fi
  done < <(scontrol listpids "$(squeue -h -j "$1" -o %A)")
  kill -KILL "${processes[@]}"
  await 20 "the end of $1" hasStates "$1" "1 FAILED"
  scontrol requeue "$1"
}

# A folder with ./luciole and a scene that moves.
prepare() {  # prepare FOLDER
  mkdir "$1"
  ln -s "$luciole" "$1/luciole"
  cat >"$1/scene.json" <<'SCENE'
{ "camera": { "eye": [0, 2, 6], "target": [0, 0, 0] }, "size": [96, 54],
  "objects": [ { "primitive": "plane", "scale": 4 }, { "primitive": "torus", "translate": [0, 1, 0] } ],
  "lights": [ { "type": "point", "position": [0, 3, 2], "range": 9, "shadow": true,
                "keys": [ { "frame": 1, "position": [-3, 3, 2] }, { "frame": 8, "position": [3, 3, 2] } ] } ] }
SCENE
}

# A ./luciole whose output is full when the second task runs it first: there it waits once it has something to say.
holdSecondTask() {  # holdSecondTask FOLDER
  rm "$1/luciole"
  cat >"$1/luciole" <<PROGRAM
#!/usr/bin/env bash
if [[ \$SLURM_ARRAY_TASK_ID == 2 && ! -v SLURM_RESTART_COUNT ]]; then
  { head -c 65536 /dev/zero && exec ${luciole@Q} "\$@"; } | sleep 600
else
  exec ${luciole@Q} "\$@"
fi
PROGRAM
  chmod +x "$1/luciole"
}

# The file without the time at which it was written, which OpenImageIO puts into its header.
undated() { LC_ALL=C sed 's/[0-9]\{4\}:[0-9][0-9]:[0-9][0-9] [0-9][0-9]:[0-9][0-9]:[0-9][0-9]//' "$1"; }

ArrayOfFourShardsWithOneKilledAndRequeuedEqualsOneProcess() {
  local array first number command='./luciole render scene.json --frames 1-8 -o frame.####.exr --resume --stats - --quiet'
  prepare "$folder/together"
  prepare "$folder/alone"
  holdSecondTask "$folder/together"
  startCluster
  array=$(sbatch --parsable --array=1-4 -D "$folder/together" -o "$folder/%a.out" --wrap "$command")
  # The second task's frames are 2 and 6. What the first one cost can't be told, which is after it was put in place.
  await 120 "the second task's first frame" test -e "$folder/together/frame.0002.exr"
  first=$(stat -c '%i %y' "$folder/together/frame.0002.exr")
  killAndRequeue "${array}_2"
  [[ ! -e $folder/together/frame.0006.exr ]] || fail "the second task wasn't killed between its frames"
  await 120 "the end of all tasks" hasStates "$array" "4 COMPLETED"
  expect "the frame that was there" "$(stat -c '%i %y' "$folder/together/frame.0002.exr")" "$first"

  (cd "$folder/alone" && eval "$command" >/dev/null)
  for number in {1..8}; do
    undated "$folder/together/frame.000$number.exr" >"$folder/a"
    undated "$folder/alone/frame.000$number.exr" >"$folder/b"
    cmp "$folder/a" "$folder/b" || fail "frame $number differs"
  done
}

AnotherArrayMakesWhatNoTaskIsAtAndTakesOverFromOneThatIsKilled() {
  local array again command='./luciole render scene.json --frames 1-8 -o frame.####.exr --resume --stats - --quiet'
  prepare "$folder/together"
  holdSecondTask "$folder/together"
  startCluster
  array=$(sbatch --parsable --array=1-4 -D "$folder/together" -o "$folder/%a.out" --wrap "$command")
  await 120 "the second task's first frame" test -e "$folder/together/frame.0002.exr"
  await 120 "the end of the other tasks" hasStates "$array" "3 COMPLETED 1 RUNNING"
  # Taken away, as if it were being made: the second task holds it for as long as it runs.
  rm "$folder/together/frame.0002.exr"
  # An array of one does all frames that aren't there.
  again=$(sbatch --parsable --array=9 -D "$folder/together" -o "$folder/again.out" --wrap "$command")
  await 120 "frame 6, which the second task hasn't begun" test -e "$folder/together/frame.0006.exr"
  [[ ! -e $folder/together/frame.0002.exr ]] || fail "the second array makes a frame that a task is at"
  killAndRequeue "${array}_2"
  await 120 "the end of the second array" hasStates "$again" "1 COMPLETED"
  await 120 "the end of all tasks" hasStates "$array" "4 COMPLETED"
  expect "number of frames" "$(find "$folder/together" -name 'frame.*.exr' | wc -l)" 8
  expect "files left behind" "$(find "$folder/together" -name '.*.lock')" ""
}

# Lines of a log: "check" what was found of a point, "repeat" a timed run.
countLines() { grep -c "\"$2\":" "$1/results.jsonl" 2>/dev/null || true; }
hasChecked() { [[ $(countLines "$1" check) -gt 0 ]]; }

# A ./luciole that halts once it has found something of a point, when the second task runs it first.
haltSecondTask() {  # haltSecondTask FOLDER
  rm "$1/luciole"
  cat >"$1/luciole" <<PROGRAM
#!/usr/bin/env bash
if [[ \$SLURM_ARRAY_TASK_ID == 2 && ! -v SLURM_RESTART_COUNT ]]; then
  ${luciole@Q} "\$@" &
  until grep -qs '"check":' points/2/results.jsonl; do sleep 0.002; done
  kill -STOP \$!
  wait
else
  exec ${luciole@Q} "\$@"
fi
PROGRAM
  chmod +x "$1/luciole"
}

# As many runs of each point as take much longer than halting does.
kScaleRuns=200

ScaleArrayWithOneKilledAndRequeuedMergesToOneProcess() {
  local array point run command="./luciole scale scene.json --size 96x54 --lights 1,10,100 --vary culling,tile --repeat $kScaleRuns -o points/"
  prepare "$folder/together"
  prepare "$folder/alone"
  mkdir "$folder"/{together,alone}/points
  haltSecondTask "$folder/together"
  startCluster
  # shellcheck disable=SC2016
  array=$(sbatch --parsable --array=1-4 -D "$folder/together" -o "$folder/%a.out" --wrap "$command"'$SLURM_ARRAY_TASK_ID')
  point=$folder/together/points/2
  await 120 "the second task's first point" hasChecked "$point"
  killAndRequeue "${array}_2"
  # Three of the twelve points are the second task's.
  (($(countLines "$point" repeat) < 3 * kScaleRuns)) || fail "the second task was done when it was killed"
  await 120 "the end of all tasks" hasStates "$array" "4 COMPLETED"

  (cd "$folder/alone" && eval "${command}1")
  for run in together alone; do
    (cd "$folder/$run" && ./luciole scale merge points/* -o merged)
    grep '"check":' "$folder/$run/merged/results.jsonl" | sort >"$folder/$run/checks"
  done
  expect "number of points" "$(countLines "$folder/together/merged" check)" 12
  expect "number of runs" "$(countLines "$folder/together/merged" repeat)" $((12 * kScaleRuns))
  diff "$folder/together/checks" "$folder/alone/checks"
  diff -r "$folder/together/merged/pictures" "$folder/alone/merged/pictures"
}

"$2"
