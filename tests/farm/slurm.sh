# shellcheck shell=bash
# shellcheck disable=SC2016,SC2034,SC2154,SC2164
# One node of Slurm for a test, without systemd: munged, slurmctld and slurmd in "$work/slurm", ended with the test.

start_slurm() { # skips where Slurm is not there, or does not start
  local program host port cpus dir=$work/slurm
  PATH=$PATH:/usr/sbin:/sbin
  for program in munged slurmctld slurmd sbatch sinfo; do
    command -v $program >/dev/null || skip "$program is not installed (Debian: slurmctld slurmd slurm-client munge)"
  done
  host=$(hostname -s 2>/dev/null || cat /etc/hostname)
  port=$((20000 + $$ % 20000))
  cpus=$(nproc)
  mkdir -p "$dir/state" "$dir/spool"
  chmod 755 "$work" "$dir" # munged wants to be reached, and no folder that others may write
  head -c 64 /dev/urandom >"$dir/key" && chmod 600 "$dir/key"
  cat >"$dir/slurm.conf" <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
CryptoType=crypto/munge
SlurmctldPort=$port
SlurmdPort=$((port + 1))
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
MpiDefault=none
ReturnToService=2
MinJobAge=300
NodeName=node NodeHostname=$host NodeAddr=127.0.0.1 CPUs=$cpus State=UNKNOWN
PartitionName=all Nodes=node Default=YES MaxTime=INFINITE State=UP
END
  export SLURM_CONF=$dir/slurm.conf
  trap 'stop_slurm; rm -rf "$work"' EXIT
  munged --foreground --force --key-file="$dir/key" --socket="$dir/munge.socket" --pid-file="$dir/munged.pid" \
    --log-file="$dir/munged.log" --seed-file="$dir/seed" >"$dir/munged.out" 2>&1 &
  slurm_processes=($!)
  wait_for "[ -S '$dir/munge.socket' ]" || no_slurm munged
  slurmctld -D -f "$SLURM_CONF" >"$dir/slurmctld.out" 2>&1 &
  slurm_processes+=($!)
  slurmd -D -N node -f "$SLURM_CONF" >"$dir/slurmd.out" 2>&1 &
  slurm_processes+=($!)
  wait_for "[ \"\$(sinfo -h -o %T 2>/dev/null)\" = idle ]" || no_slurm slurmd slurmctld
}

wait_for() { # CONDITION: up to ten seconds
  local i
  for i in $(seq 100); do
    if eval "$1"; then return 0; fi
    sleep 0.1
  done
  return 1
}

no_slurm() { # PROGRAM...
  local program
  for program in "$@"; do tail -n 5 "$work/slurm/$program.out" "$work/slurm/$program.log" 2>/dev/null || :; done
  skip "Slurm is installed but does not start here: $1 (above)"
}

stop_slurm() {
  local i
  scancel --user "$(id -un)" 2>/dev/null || :
  for ((i = ${#slurm_processes[@]} - 1; i >= 0; i--)); do kill "${slurm_processes[i]}" 2>/dev/null || :; done
  wait "${slurm_processes[@]}" 2>/dev/null || :
}
