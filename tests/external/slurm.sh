#!/usr/bin/env bash
# Sweeps through a real Slurm on this machine: installs Debian's slurm-wlm and munge where they are missing, starts a controller and
# a node in folders of its own, submits, compares with runs by threads and shards, kills a task and the node, submits
# again, and stops everything. Root on Debian; five minutes on a machine busy with builds. Not part of .ci/run, which has no such time left, and whose
# machine may have no root: run it by hand after a change of `experiments/sweep/submit` or of `city submit`.
# EDIFICE names the program; without it the debug build is made.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
root=$PWD

say() { printf 'slurm.sh: %s\n' "$*" >&2; }
fail() {
    say "FAILED: $*"
    exit 1
}

[ "$(id -u)" -eq 0 ] || fail "needs root, to start munge and Slurm"
if ! command -v slurmctld >/dev/null || ! command -v slurmd >/dev/null || ! command -v munged >/dev/null; then
    say "installing slurm-wlm and munge"
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends slurm-wlm munge >/dev/null
fi
if [ -z "${EDIFICE:-}" ]; then
    cargo build --quiet --bin edifice
    EDIFICE="${CARGO_TARGET_DIR:-target}/debug/edifice"
fi
EDIFICE=$(realpath "$EDIFICE")

work=$(mktemp -d /tmp/edifice-slurm.XXXXXX)
run=$(mktemp -d /run/edifice-slurm.XXXXXX) # munge refuses folders that others may write
export SLURM_CONF=$work/slurm.conf
pid_of() { cat "$work/$1.pid" 2>/dev/null || true; }
stop() {
    local status=$?
    scancel --user=root 2>/dev/null || true
    sleep 1
    for daemon in slurmd slurmctld; do
        local pid
        pid=$(pid_of "$daemon")
        [ -z "$pid" ] || kill "$pid" 2>/dev/null || true
    done
    [ ! -f "$run/munged.pid" ] || kill "$(cat "$run/munged.pid")" 2>/dev/null || true
    if [ "$status" -eq 0 ]; then rm -rf "$work" "$run"; else say "logs are in $work"; fi
}
trap stop EXIT

# --- the cluster ---
chmod 755 "$run"
chown munge:munge "$run"
dd if=/dev/urandom of="$run/munge.key" bs=128 count=1 status=none
chown munge:munge "$run/munge.key"
chmod 400 "$run/munge.key"
runuser -u munge -- munged --key-file="$run/munge.key" --socket="$run/munge.socket" --pid-file="$run/munged.pid" \
    --log-file="$run/munged.log" --seed-file="$run/munged.seed"
host=$(hostname -s)
memory=$(slurmd -C | tr ' ' '\n' | sed -n 's/^RealMemory=//p')
# No accounting, no cgroups, whole processors: what a small site without systemd has. Arrays of at most 7 jobs.
cat >"$SLURM_CONF" <<CONF
ClusterName=edifice
SlurmctldHost=$host(127.0.0.1)
AuthInfo=socket=$run/munge.socket
SlurmUser=root
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/affinity
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
MpiDefault=none
ReturnToService=2
SlurmdTimeout=10
MaxArraySize=8
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$memory State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
mkdir -p "$work/state" "$work/spool"
slurmctld
slurmd
node_is_up() { sinfo -h -o %t 2>/dev/null | grep -Eq '^(idle|mix|alloc)'; }
wait_for() { # seconds, what, command
    local left=$1 what=$2
    shift 2
    until "$@"; do
        left=$((left - 1))
        [ "$left" -gt 0 ] || fail "waited too long until $what"
        sleep 1
    done
}
wait_for 30 "the node is up" node_is_up
queue_is_empty() { ! squeue -h 2>/dev/null | grep -q .; }
say "a controller and a node with $(nproc) processors and $memory MB are up"

# --- the same results by threads, shards and arrays ---
cd "$work"
sweep() { # rounds, arms as values of start, seeds, pack
    printf 'study = "optim/annealing"\ndata = ["*.knapsack.json"]\nseeds = %s\n[base]\nrounds = %s\n[[grid]]\nset.start = [%s]\n[task]\nmem = "200M"\npack = "%s"\n' \
        "$3" "$1" "$2" "$4"
}
edifice() { "$EDIFICE" sweep "$@"; }
sweep 50 "0.1, 0.3, 1.0, 3.0, 10.0" 5 200s >quick.toml
edifice run quick.toml --out one --threads 1
edifice run quick.toml --out two --threads 2
for i in 4 0 6 2 5 1 3; do edifice run quick.toml --out seven --shard "$i/7"; done
for out in one two seven; do edifice collect quick.toml --out $out; done
rows=$(wc -l <one/results.csv)
[ "$rows" -eq $((1 + 3 * 250)) ] || fail "250 tasks have $rows lines"
cmp one/results.csv two/results.csv
cmp one/results.csv seven/results.csv

edifice submit quick.toml --out slurm --engine slurm
[ -f slurm/array_1.sh ] || fail "13 jobs were not split at MaxArraySize 8"
wait_for 300 "250 tasks are done by Slurm" queue_is_empty
# Written by the job that collects.
cmp one/results.csv slurm/results.csv
say "250 tasks: the same bytes by 1 thread, 2 threads, 7 shards, and arrays of Slurm"

# --- a task and the node are killed ---
sweep 12000 "0.1, 10.0" 10 100s >slow.toml
edifice run slow.toml --out whole --threads "$(nproc)"
edifice collect slow.toml --out whole
edifice submit slow.toml --out faults --engine slurm
finished() { find faults -name "*.jsonl" -path "*journal*" -exec cat {} + 2>/dev/null | wc -l; }
some_finished() { [ "$(finished)" -ge 4 ]; }
wait_for 60 "some tasks are done" some_finished
runners() { # processes of ours that Slurm started
    { scontrol listpids 2>/dev/null || true; } | awk 'NR > 1 && $1 > 1 { print $1 }' | while read -r pid; do
        if [ "$(readlink "/proc/$pid/exe" 2>/dev/null)" = "$EDIFICE" ]; then printf '%s\n' "$pid"; fi
    done
}
a_task_runs() { [ -n "$(runners)" ]; }
wait_for 20 "a task runs" a_task_runs
victim=$(runners | sed -n 1p)
kill -9 "$victim"
say "killed the task of process $victim after $(finished) results"
sleep 2
wait_for 20 "a task runs again" a_task_runs
before=$(finished)
# A node that dies takes its daemon, the steps and the tasks with it.
steps=$(for pid in $(runners); do ps -o ppid= -p "$pid"; done | sort -u)
tasks=$(runners)
kill -9 "$(pid_of slurmd)"
# shellcheck disable=SC2086 # lists of numbers
kill -9 $tasks $steps 2>/dev/null || true
say "killed the node with $(printf '%s\n' "$tasks" | grep -c .) tasks on it after $before results"
sleep 3
slurmd
wait_for 60 "the node is up again" node_is_up
wait_for 400 "the queue is empty" queue_is_empty
after=$(finished)
[ "$after" -ge "$before" ] || fail "results were lost: $before before, $after now"
edifice status slow.toml --out faults
say "$after results before anything was submitted again"
edifice submit slow.toml --out faults --engine slurm
wait_for 400 "what was left is done" queue_is_empty
edifice retry slow.toml --out faults --json | grep -q '"finished":0' || fail "Slurm left tasks undone"
edifice collect slow.toml --out faults
cmp whole/results.csv faults/results.csv
keys=$(cat faults/journal/*.jsonl | sed 's/^{"key":"\([0-9a-f]*\)".*/\1/' | sort -u | wc -l)
[ "$keys" -eq 200 ] || fail "$keys tasks in the journals"
say "200 tasks: the same bytes after a task and the node were killed"

# --- a country in tiles ---
"$EDIFICE" --quiet city derive "$root/datasets/city_proceduralization/town.city-grammar.json" -o town.obj
"$EDIFICE" --quiet city plan town.obj --tile 60 -o country
cp -r country jobs
"$EDIFICE" --quiet city work country
"$EDIFICE" city submit jobs --engine slurm --workers 3 --minutes 5
wait_for 120 "the workers of the country are done" queue_is_empty
diff -r country/city-* jobs/city-* || fail "workers of Slurm wrote other bytes"
say "$(find jobs/city-* -name '*.bin' | wc -l) grammars of tiles: the same bytes by one worker and by three jobs of Slurm"
say passed
