#!/bin/sh
# A coarse gripper and a peer on Fast DDS (Debian: apt-get install g++ libfastrtps-dev): topics, services
# and an action, in a private network. Run it manually, because not every machine has Fast DDS:
#   sh tests/peers/fast_dds.sh
# Prints one line of JSON; expected:
#   {"paused": 1, "stepped": 1, "n_ticks": 7, "setpoint": -30000.0, "accepted": 1, "status": 4, "feedback": 2}
set -e
cd "$(dirname "$0")/../.."
folder=$(mktemp -d)
g++ -std=c++17 -O1 -o "$folder/peer" tests/peers/fast_dds.cpp -lfastrtps -lfastcdr
cat > "$folder/coarse.yaml" <<'SCENE'
name: coarse
controller: topics
membrane: { frequency: 8 }
grains: { count: 280, radius_min: 3.8 mm, radius_max: 4.2 mm }
object: { name: ball, shape: { sphere: { radius: 15 mm } }, position: [0 mm, 0 mm, 15 mm] }
flange: { position: [0 mm, 0 mm, 101 mm] }
SCENE
export folder
# Shared memory is not isolated by a network namespace: the peer uses only UDP.
export FASTDDS_BUILTIN_TRANSPORTS=UDPv4
exec unshare -n sh -c '
ip link set lo up
target/release/jamgrip run "$folder/coarse.yaml" --no-bag --no-stream --threads 1 --cache "$folder/cache" > /dev/null &
program=$!
timeout 120 "$folder/peer"
outcome=$?
kill -INT $program
wait $program
rm -r "$folder"
exit $outcome
'
