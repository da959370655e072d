# shellcheck shell=bash
# Sourced by the tools that set other identification packages beside `flexcomp diagnose`.

# Prints a Python with mujoco.sysid and FIGAROH, of its own; installs it once. Needs steps.sh.
find_rivals_python() {
  local own=$source_dir/build/rivals/python
  if ! "$own/bin/python" -c 'import figaroh, mujoco.sysid, pinocchio, scipy, yaml' 2>/dev/null; then
    {
      echo 'Installing mujoco[sysid] and FIGAROH into build/rivals/python (once, 1.4 GB) ...'
      python3 -m venv --clear "$own"
      "$own/bin/pip" install --quiet 'mujoco[sysid]==4.0.0' figaroh==1.0.2
    } >&2 || die 'cannot install them'
  fi
  printf '%s\n' "$own/bin/python"
}
