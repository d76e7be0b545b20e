#!/usr/bin/env bash
# Makes the Debian package and the wheel of a build, installs each in a clean root of Debian 12, and plans a STEP file there. Needs root
# rights, debootstrap and the archive that apt uses on this machine.
# usage: check_packages.sh BUILD_DIR
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
build="$1"
work="$(mktemp -d)"
clean="$work/root"

cleanup() {
  umount "$clean/proc" 2>/dev/null || true
  rm -rf --one-file-system "$work"
}
trap cleanup EXIT

if [ "$(id -u)" -ne 0 ]; then
  echo "a clean root needs root rights" >&2
  exit 1
fi
cpack --config "$build/CPackConfig.cmake" -B "$work/made"
python3 "$root/tools/make_wheel.py" "$build" "$work/made"
archive="$(apt-get indextargets --format '$(SITE) $(RELEASE)' | sed -n 's/ bookworm$//p' | sort -u | head -n 1)"
if [ -z "$archive" ]; then
  echo "apt knows no archive of Debian 12 (bookworm) on this machine" >&2
  exit 1
fi
debootstrap --variant=minbase bookworm "$clean" "$archive" >"$work/debootstrap.log" 2>&1 || {
  tail -n 20 "$work/debootstrap.log" >&2
  exit 1
}
mount -t proc proc "$clean/proc"
cp /etc/resolv.conf "$clean/etc/resolv.conf"
mkdir "$clean/packages"
cp "$work"/made/*.deb "$work"/made/*.whl "$clean/packages/"
python3 "$root/tests/packages/step_boxes.py" "$clean/packages/boxes.step"
# shellcheck disable=SC2016  # expanded in the clean root
chroot "$clean" /bin/sh -ec '
  export DEBIAN_FRONTEND=noninteractive LC_ALL=C
  apt-get update -q >/dev/null
  apt-get install -y -q --no-install-recommends python3-numpy python3-venv >/dev/null
  python3 -m venv --system-site-packages /tmp/venv
  /tmp/venv/bin/pip install -q --no-index /packages/*.whl
  cd /tmp
  venv/bin/dismantle --version
  venv/bin/dismantle plan /packages/boxes.step -o wheel -q
  venv/bin/dismantle verify wheel/plan.json -q
  test -s wheel/index.html
  venv/bin/python -c "import dismantle; plan = dismantle.run(\"/packages/boxes.step\"); assert plan.complete and len(plan.steps) == 2"
  apt-get install -y -q --no-install-recommends /packages/*.deb >/dev/null
  cd /tmp
  dismantle --version
  dismantle plan /packages/boxes.step -o plan -q
  dismantle verify plan/plan.json -q
  dismantle book plan/plan.json -o plan/book.pdf -q
  test -s plan/index.html
  test -s plan/book.pdf
  python3 -c "import dismantle; plan = dismantle.run(\"/packages/boxes.step\"); assert plan.complete and len(plan.steps) == 2"
  apt-get remove -y -q dismantle >/dev/null
  test ! -e /usr/bin/dismantle
'
echo "the wheel was installed and used in a clean root, then the package was installed, used and removed there"
