# shellcheck shell=bash
# Sourced by the tools: steps that report themselves in one line and keep their output in a log.

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
log_dir=$source_dir/build/logs
# shellcheck disable=SC2034 # the tools use it
jobs=$(nproc)

# Prints the comment block at the top of the calling script, which is its manual.
print_manual() {
  awk 'NR > 1 { if (!/^#/) exit; sub(/^# ?/, ""); print }' "$0"
}

die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

as_root() {
  if ((EUID == 0)); then
    "$@"
  else
    command -v sudo >/dev/null || die "needs root's rights, and there is no sudo; run it as root"
    sudo "$@"
  fi
}

seconds_as_text() {
  printf '%d min %02d s' $(($1 / 60)) $(($1 % 60))
}

# Says every half minute how far a long step is, from Ninja's or CTest's last "[12/34]" or "12/34". Its sleep
# outlives it: who reads what this prints from a pipe must not wait for that.
report_progress() {
  local title=$1 log=$2 elapsed=0 place
  while sleep 30 >/dev/null 2>&1; do
    elapsed=$((elapsed + 30))
    place=$(grep -oE '^(\[[0-9]+/[0-9]+\]|[ ]*[0-9]+/[0-9]+)' "$log" 2>/dev/null | tail -n 1 | tr -d ' []')
    printf '    %s: %s%s\n' "$title" "$(seconds_as_text "$elapsed")" "${place:+, $place}"
  done
}

# run_step TITLE LOG COMMAND...: runs the command with its output in build/logs/LOG.log; one line when
# it is done, the end of the log if it failed. Returns the command's exit code. In a function as the command
# `set -e` does not hold, since its code is asked for: its steps are chained by &&.
run_step() {
  local title=$1 log=$log_dir/$2.log start=$SECONDS code=0 reporter
  shift 2
  mkdir -p "$log_dir"
  : >"$log"
  report_progress "$title" "$log" &
  reporter=$!
  "$@" >"$log" 2>&1 </dev/null || code=$?
  { kill "$reporter" && wait "$reporter"; } 2>/dev/null || true
  if ((code == 0)); then
    printf '  ok    %-44s %s\n' "$title" "$(seconds_as_text $((SECONDS - start)))"
  else
    printf '  FAIL  %-44s %s\n' "$title" "$(seconds_as_text $((SECONDS - start)))"
    tail -n 40 "$log" | sed 's/^/    | /'
    printf '    whole output: %s\n' "${log#"$source_dir"/}"
  fi
  return "$code"
}
