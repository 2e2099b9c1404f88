#!/usr/bin/env bash
# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# A Slurm of one node for tests: munged, slurmctld and slurmd, without systemd, in a folder of its
# own and on ports of its own.
#
#   start_slurm.sh start FOLDER    prints what to `source`, so that sbatch and friends find it
#   start_slurm.sh stop FOLDER     ends the daemons that it started
#
# Exit code 77: this machine can't (not root, or Slurm isn't installed); the reason is on stderr.
set -euo pipefail
verb=${1:?start or stop} folder=$(realpath -m "${2:?folder}")

skip() { echo "no Slurm here: $*" >&2; exit 77; }

# Daemons by the numbers they wrote down, and by nothing else.
stop() {
  local name pid
  for name in slurmd slurmctld munged; do
    [ -f "$folder/$name.pid" ] || continue
    pid=$(cat "$folder/$name.pid")
    kill "$pid" 2>/dev/null || continue
    for _ in $(seq 50); do kill -0 "$pid" 2>/dev/null || break; sleep 0.1; done
    kill -9 "$pid" 2>/dev/null || true
  done
  [ ! -f "$folder/munge_folder" ] || rm -rf "$(cat "$folder/munge_folder")"
}

if [ "$verb" = stop ]; then stop; exit 0; fi

[ "$(id -u)" = 0 ] || skip "root is needed to start its daemons"
for program in munged slurmctld slurmd sbatch squeue scontrol; do
  PATH=$PATH:/usr/sbin command -v "$program" >/dev/null || skip "$program is not installed (Debian: slurm-wlm, munge)"
done
PATH=$PATH:/usr/sbin

mkdir -p "$folder"/{state,spool,log}
chmod 755 "$folder"
# munge refuses sockets and keys below folders that others may write to.
munge_folder=$(mktemp -d /run/palmar-munge.XXXXXX)
chmod 711 "$munge_folder"
echo "$munge_folder" >"$folder/munge_folder"
dd if=/dev/urandom of="$munge_folder/key" bs=1024 count=1 status=none
chmod 400 "$munge_folder/key"
chown root:root "$munge_folder/key"
munged --force --key-file "$munge_folder/key" --socket "$munge_folder/socket" \
  --pid-file "$munge_folder/munged.pid" --log-file "$munge_folder/munged.log" \
  --seed-file "$munge_folder/seed" >"$folder/log/munged.out" 2>&1 || {
  cat "$folder/log/munged.out" >&2; skip "munged does not start"; }
cp "$munge_folder/munged.pid" "$folder/munged.pid"

port=$((20000 + $$ % 20000))
host=$(hostname -s)
memory=$(awk '/MemTotal/ { print int($2 / 1024) }' /proc/meminfo)
cat >"$folder/slurm.conf" <<CONF
ClusterName=palmar$$
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
AuthType=auth/munge
AuthInfo=socket=$munge_folder/socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdLogFile=$folder/log/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=2,bf_interval=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
JobRequeue=1
KillWait=2
MinJobAge=300
ReturnToService=2
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=$memory State=UNKNOWN
PartitionName=test Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
echo "CgroupPlugin=cgroup/v1" >"$folder/cgroup.conf"
export SLURM_CONF="$folder/slurm.conf"
slurmctld -c >"$folder/log/slurmctld.out" 2>&1 || { cat "$folder/log/slurmctld.out" >&2; stop; skip "slurmctld does not start"; }
slurmd >"$folder/log/slurmd.out" 2>&1 || { cat "$folder/log/slurmd.out" >&2; stop; skip "slurmd does not start"; }
for _ in $(seq 150); do
  if sinfo -h -o %T 2>/dev/null | grep -q idle; then
    echo "export SLURM_CONF='$folder/slurm.conf'"
    exit 0
  fi
  sleep 0.2
done
tail -5 "$folder"/log/slurm*.log >&2
stop
skip "the node does not get ready"
