#!/usr/bin/env bash
# Usage: unshare … enter_sandbox.sh ROOT WORK [READABLE…] -- COMMAND…
#
# In mount and process namespaces of its own: builds a root in the empty folder ROOT that holds the
# system's programs and libraries (read-only), the READABLE paths (read-only, where they are now),
# an empty /tmp and the folder WORK as /case; makes it the root, drops every capability, runs COMMAND
# in /case. Nothing else of the machine's files can be named from there.
set -euo pipefail

root=$1
work=$2
shift 2

# show PATH: the same path inside, read-only; symbolic links as they are.
show() {
  local inside=$root$1
  if [[ -L $1 ]]; then
    mkdir -p "$(dirname "$inside")"
    cp --no-dereference "$1" "$inside"
  elif [[ -d $1 ]]; then
    mkdir -p "$inside"
    mount --bind "$1" "$inside"
    mount -o remount,bind,ro "$inside"
  elif [[ -e $1 ]]; then
    mkdir -p "$(dirname "$inside")"
    touch "$inside"
    mount --bind "$1" "$inside"
    mount -o remount,bind,ro "$inside"
  fi
}

mount -t tmpfs sandbox "$root"
for path in /usr /etc /bin /sbin /lib /lib32 /lib64 /libx32; do
  show "$path"
done
while [[ $1 != -- ]]; do
  show "$1"
  shift
done
shift

mkdir -p "$root"/{proc,tmp,dev/shm,case,outside}
mount -t proc proc "$root/proc"
for device in null zero urandom; do
  touch "$root/dev/$device"
  mount --bind "/dev/$device" "$root/dev/$device"
done
mount --bind "$work" "$root/case"

cd "$root"
pivot_root . outside
umount --lazy /outside
rmdir /outside
cd /case
exec setpriv --no-new-privs --bounding-set=-all --inh-caps=-all "$@"
