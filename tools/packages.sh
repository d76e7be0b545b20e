# shellcheck shell=bash
# Sourced by quickstart and check. Needs $root, the root of the repository.

# packages_for [OPTION...]: the packages of every build, and those for these options of check.
# shellcheck disable=SC2154  # root is set by the script that sources this
packages_for() {
  local first rest
  while read -r first rest; do
    if [ "${first:0:1}" != "[" ]; then
      echo "$first"
    elif [[ " $* " == *" ${first:1:-1} "* ]]; then
      echo "$rest"
    fi
  done < <(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$root/tools/packages.txt")
}

missing_packages() {
  local package there
  # Includes provided packages: NodeSource's nodejs contains npm and conflicts with Debian's.
  there="$(dpkg-query -W -f='${db:Status-Status} ${Package}, ${Provides}\n' | sed -n 's/^installed //p' |
    tr ',' '\n' | sed -e 's/^ *//' -e 's/ .*//')"
  while read -r package; do
    if ! grep -qxF "$package" <<<"$there"; then
      echo "$package"
    fi
  done < <(packages_for "$@")
}

# install_packages [OPTION...]: installs the missing packages of tools/packages.txt. If none is missing, it is silent and needs no network.
install_packages() {
  if ! command -v dpkg-query >/dev/null; then
    echo "This is not Debian: the packages of tools/packages.txt (or their like) must be there already." >&2
    return 0
  fi
  local missing
  mapfile -t missing < <(missing_packages "$@")
  if [ "${#missing[@]}" -eq 0 ]; then
    return 0
  fi
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "Packages are missing and there is no sudo. As root: apt-get install ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing: ${missing[*]}"
  local install=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends
    "${missing[@]}")
  # Package lists may be absent or out of date: fetch them only when the first try fails.
  if ! "${install[@]}" </dev/null >/dev/null 2>&1; then
    "${as_root[@]}" apt-get update -q </dev/null
    "${install[@]}" </dev/null
  fi
}
