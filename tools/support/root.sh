# shellcheck shell=bash
# Sourced by the tools that try something on a Debian that has nothing of ours: a root of its own, and commands
# in it. Needs root's rights (sudo is asked), the package mmdebstrap, and the mirror that apt knows.

# make_root RELEASE FOLDER PACKAGE...: a Debian of its own in FOLDER, new each time, with these packages beside
# the essential ones.
make_root() {
  local release=$1 folder=$2 included
  shift 2
  included=$(IFS=,; printf '%s' "$*")
  remove_root "$folder"
  mkdir -p "$(dirname "$folder")"
  run_step "make a root of Debian $release" root-make \
    as_root mmdebstrap --variant=apt --include="$included" "$release" "$folder"
  # As this machine reaches the mirror.
  as_root cp /etc/resolv.conf /etc/hosts "$folder/etc/"
  run_step "refresh its package lists" root-update in_root "$folder" apt-get update
}

# in_root FOLDER COMMAND...: runs it there. What it mounts is gone with it.
in_root() {
  local folder=$1
  shift
  # shellcheck disable=SC2016 # the inner shell's
  as_root unshare --mount sh -euc '
    mount -t proc proc "$0/proc"
    mount --bind /dev "$0/dev"
    exec chroot "$0" env -i HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
      PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "$@"' "$folder" "$@"
}

remove_root() {
  [[ ! -e $1 ]] || as_root rm -rf --one-file-system "$1"
}
