#!/bin/bash
# A cluster on this machine: a controller and three nodes of Slurm, started here and ended with this
# script. It renders a picture in 16 shares while one node dies with all its processes, one is
# declared dead though its task lives on, and one share and the merge fail once; then another one in
# rounds, with what is left of the cluster, of which a share and a plan fail once as well; then frames.
#
#   slurm_cluster.sh STROMBOLI SCENE FOLDER
#
# FOLDER exists, and its name is short: the path of a socket has at most 107 bytes. What happened is
# printed; the pictures are FOLDER/whole.exr, of one render, and FOLDER/out.exr, of the cluster.

set -u
stromboli=$1 scene=$2 folder=$3
picture="$scene -r 24 18 -s 64 --block 4"

user=$(id -un)
export SLURM_CONF=$folder/slurm.conf
chmod 711 "$folder" # munge wants its socket to be within everybody's reach
mkdir "$folder"/{run,log,state,spool,work} "$folder"/spool/n{1,2,3}

# Processes whose environment has all of these words: daemons have SLURM_CONF of this folder, which
# no other process has, and those of a node its name.
processes_with() {
    local files word
    files=(/proc/[0-9]*/environ)
    for word in "SLURM_CONF=$SLURM_CONF" "$@"; do
        mapfile -t files < <(grep -lzxF -- "$word" "${files[@]}" /dev/null 2>/dev/null)
    done
    printf '%s\n' "${files[@]}" | sed -n 's|^/proc/\([0-9]*\)/environ$|\1|p'
}
kill_with() {
    local process
    for process in $(processes_with "$@"); do
        [[ $process == "$BASHPID" ]] || kill -KILL "$process" 2>/dev/null
    done
}
# The parents of tasks, which overwrite their environment, of one node or of all: by the log that they
# write. Without them nobody tells the controller how a task has ended.
kill_parents_of_tasks() { # [NODE]
    local process
    for process in $(pgrep -x slurmstepd); do
        ls -l "/proc/$process/fd" 2>/dev/null | grep -q "$folder/log/slurmd.${1-}" &&
            kill -KILL "$process"
    done
}
end() {
    timeout 5 scancel --user="$user" 2>/dev/null
    kill -TERM "${munged-}" "${controller-}" 2>/dev/null
    kill_parents_of_tasks
    kill_with
    wait 2>/dev/null
}
trap end EXIT
die() {
    echo "FAILED: $*"
    tail -n 30 "$folder"/log/* "$folder"/work/out.exr.shares/*.log 2>/dev/null
    exit 1
}
until_true() { # SECONDS COMMAND...
    local end=$((SECONDS + $1))
    shift
    until "$@" >/dev/null 2>&1; do
        ((SECONDS < end)) || return 1
        sleep 0.2
    done
}

# Ports that nobody listens on now.
port=$((20000 + RANDOM % 20000))
while ss -Hltn 2>/dev/null | grep -q ":\($port\|$((port + 1))\|$((port + 2))\|$((port + 3))\) "; do
    port=$((20000 + RANDOM % 20000))
done

echo "CgroupPlugin=cgroup/v1" >"$folder/cgroup.conf" # loaded even if nothing uses it
cat >"$SLURM_CONF" <<END
ClusterName=lab
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=$port
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$folder/run/munge.sock,cred_expire=5
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool/%n
SlurmctldPidFile=$folder/run/slurmctld.pid
SlurmdPidFile=$folder/run/slurmd.%n.pid
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdLogFile=$folder/log/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
SlurmdTimeout=1
MessageTimeout=2
TCPTimeout=1
KillWait=1
ReturnToService=2
JobRequeue=1
JobFileAppend=1
MailProg=/bin/true
JobCompType=jobcomp/filetxt
JobCompLoc=$folder/log/jobcomp.txt
NodeName=n1 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1
NodeName=n2 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1
NodeName=n3 NodeHostname=localhost NodeAddr=127.0.0.1 Port=$((port + 3)) CPUs=1
PartitionName=p Nodes=n[1-3] Default=YES State=UP
END
head -c 1024 /dev/urandom >"$folder/munge.key"
chmod 600 "$folder/munge.key"

munged -F --socket="$folder/run/munge.sock" --key-file="$folder/munge.key" \
    --log-file="$folder/log/munged.log" --pid-file="$folder/run/munged.pid" \
    --seed-file="$folder/run/munged.seed" >"$folder/log/munged" 2>&1 &
munged=$!
until_true 5 test -S "$folder/run/munge.sock" || die "munged does not start"
slurmctld -D -f "$SLURM_CONF" >/dev/null 2>&1 &
controller=$!
for node in n1 n2 n3; do
    # Its tasks' parents inherit the word, and its tasks have SLURMD_NODENAME.
    FAKE_NODE=$node slurmd -D -N $node -f "$SLURM_CONF" >/dev/null 2>&1 &
    declare "slurmd_$node=$!"
done
all_idle() { [[ $(timeout 5 sinfo -h -N -t idle -o %N | wc -l) == 3 ]]; }
until_true 20 all_idle || die "the nodes are not there"

# The program as the nodes have it: each start and end is counted; share 5, a merge
# and a plan fail the first time; on the first start of share 7 the controller loses sight of the
# node, whose task takes its time.
cat >"$folder/stromboli" <<END
#!/bin/bash
words="\$*"
if [[ \$1 == @(plan|merge) && ! -e $folder/work/failed_\$1 ]]; then
    touch "$folder/work/failed_\$1"
    exit 3
fi
if [[ \$words == *--frames*-o* ]]; then
    frame=\${words#*--frames }
    echo "frame \${frame%% *}" >>"$folder/work/frames"
    if [[ \$frame == 3\ * && ! -e $folder/work/failed_frame ]]; then
        touch "$folder/work/failed_frame"
        exit 3
    fi
fi
[[ \$words == *--share* ]] || exec "$stromboli" "\$@"
share=\${words#*--share }
share=\${share%%/*}
if [[ \$words == *--plan* ]]; then
    if [[ \$share == 2 && ! -e $folder/work/failed_round ]]; then
        touch "$folder/work/failed_round"
        exit 3
    fi
    exec "$stromboli" "\$@"
fi
echo "start \$share \$SLURMD_NODENAME" >>"$folder/work/starts"
if [[ \$share == 5 && ! -e $folder/work/failed ]]; then
    touch "$folder/work/failed"
    exit 3
fi
if [[ \$share == 7 && ! -e $folder/work/seven ]]; then
    echo "\$SLURMD_NODENAME" >"$folder/work/seven"
    sleep 13
fi
sleep 0.5
"$stromboli" "\$@"
code=\$?
echo "end \$share \$SLURMD_NODENAME \$code" >>"$folder/work/starts"
exit \$code
END
chmod +x "$folder/stromboli"
cd "$folder/work" || exit 1

"$stromboli" render $picture --even -o "$folder/whole.exr" -q || die "no render"
"$stromboli" submit slurm $picture -o out.exr --shares 16 --job-time 5 \
    --program "$folder/stromboli" || die "submit failed"

# The node of share 7 loses its slurmd alone: its task goes on, and another copy is started elsewhere.
until_true 30 test -s seven || die "share 7 does not begin"
lost=$(cat seven)
slurmd=slurmd_$lost
kill -KILL "${!slurmd}"
echo "node $lost is believed dead while its task lives"

# Another node dies with all there is on it, in the middle of a share.
begins_share() {
    local word share node
    while read -r word share node; do
        [[ $word == start && $node != "$lost" && $share != [57] ]] || continue
        grep -q "^end $share " starts && continue
        victim=$node killed=$share
        return 0
    done <starts
    return 1
}
until_true 20 begins_share || die "no node is at work"
kill_with "FAKE_NODE=$victim"
kill_parents_of_tasks "$victim"
kill_with "SLURMD_NODENAME=$victim"
echo "node $victim is dead"

until_true 90 test -e out.exr || die "there is no picture"
merged() { [[ $(timeout 5 squeue -h | wc -l) == 0 ]]; }
until_true 20 merged || die "jobs are left"
# The copy that was believed dead may still be at it.
copies_ended() { [[ $(grep -c "^end 7 " starts) -ge 2 ]]; }
until_true 15 copies_ended || die "the second copy of share 7 has not ended"

cmp "$folder/whole.exr" out.exr || die "the picture has other bytes than that of one render"
echo "same bytes"
times_started() { grep -c "^start $1 " starts; }
for share in {1..16}; do
    expected=1
    [[ $share == 5 || $share == 7 ]] && expected=2
    # On a busy machine the share may have ended before the node did.
    [[ $share == "$killed" ]] && expected=$(($(times_started "$share") == 1 ? 1 : 2))
    [[ $(times_started "$share") == "$expected" ]] ||
        die "share $share was started $(times_started "$share") times, not $expected"
done
echo "each share was taken once, but for 5, which failed, 7, whose node was lost, and one that was killed"
[[ $(ls out.exr.shares/*.film | wc -l) == 16 && -z $(find . -name '*.tmp') ]] || die "films are left over"

# Submitted again, only the merge is left to do; with a share lost, that share.
again() {
    "$stromboli" submit slurm $picture -o out.exr --shares 16 --dry-run 2>/dev/null |
        sed -n 's/^#SBATCH --array=//p'
}
[[ -z $(again) ]] || die "submit takes shares again that are there"
rm out.exr.shares/part.{3,8,9}of16.film
[[ $(again) == 3,8-9 ]] || die "submit would take $(again), not 3,8-9"
echo "only what is missing is submitted again"

# Rounds until the noise is what is asked for: it takes three, and the fourth ends at once.
picture="$scene -r 24 18 -s 16 --block 8"
noise=0.24
"$stromboli" submit slurm $picture -o rounds.exr --shares 2 --noise $noise --rounds 4 \
    --job-time 5 --program "$folder/stromboli" || die "submit of rounds failed"
by_hand() {
    local round=2 films="$folder/hand1.film"
    "$stromboli" render $picture --share 1/1 -o "$folder/hand1.film" -q || return 1
    while "$stromboli" plan $films --noise $noise -o "$folder/hand$round.plan"; do
        "$stromboli" render $picture --plan "$folder/hand$round.plan" --share 1/1 \
            -o "$folder/hand$round.film" -q || return 1
        films+=" $folder/hand$round.film"
        round=$((round + 1))
    done
    "$stromboli" merge $films -o "$folder/hand.exr" -q
}
by_hand || die "the rounds by hand failed"
until_true 90 test -e rounds.exr || die "there is no picture of rounds"
until_true 20 merged || die "jobs of rounds are left"
cmp "$folder/hand.exr" rounds.exr || die "the picture of rounds has other bytes than by hand"
[[ -e failed_round && -e failed_plan && -e failed_merge ]] ||
    die "no share of a round, no plan or no merge has failed"
[[ -e rounds.exr.shares/round3.plan && ! -e rounds.exr.shares/round4.plan ]] ||
    die "there were not three rounds"
echo "rounds have the bytes of rounds by hand, and end when the noise is reached"

# Frames of a turntable, a task for each: the third fails once, and one is there already.
picture="$scene -r 24 18 -s 8 --turntable 6"
"$stromboli" render $picture -o "$folder/whole%d.png" -q || die "no turntable"
"$stromboli" render $picture --frames 4 -o turn%d.png -q || die "no frame 4"
"$stromboli" submit slurm $picture -o turn%d.png --job-time 5 --program "$folder/stromboli" ||
    die "submit of frames failed"
turned() { [[ $(ls turn?.png | wc -l) == 6 && $(timeout 5 squeue -h | wc -l) == 0 ]]; }
until_true 60 turned || die "frames are missing"
for frame in {0..5}; do
    cmp "$folder/whole$frame.png" turn$frame.png || die "frame $frame has other bytes"
    expected=$((frame == 3 ? 2 : frame == 4 ? 0 : 1))
    [[ $(grep -c "^frame $frame\$" frames) == "$expected" ]] || die "frame $frame was not begun $expected times"
done
echo "each frame was rendered once, but for the one that failed"
