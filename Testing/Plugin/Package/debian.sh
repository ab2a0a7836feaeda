#!/usr/bin/env bash
# Installs the packages of `./run package` in a Debian 12 of their own and uses them there. As root; needs
# debootstrap, and Debian's mirror for what the packages depend on.
#
#   Testing/Plugin/Package/debian.sh [ROOT]   ROOT: folder of the chroot, made if it is not there
set -euo pipefail
repository="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../.."

# Within the chroot.
check() {
  local plugin model=/usr/share/opencascade/data/step/linkrods.step
  cd "$(mktemp -d)"
  export DEBIAN_FRONTEND=noninteractive HOME="$PWD" XDG_RUNTIME_DIR="$PWD"
  apt-get -qq update
  apt-get -qq -y -o Dpkg::Use-Pty=0 remove vtknurbs vtknurbs-dev >/dev/null 2>&1 || true
  apt-get -qq -y -o Dpkg::Use-Pty=0 --no-install-recommends install /src/build/vtknurbs_*.deb occt-misc xvfb xauth \
    >apt.log 2>&1 || { tail -n 20 apt.log && exit 1; }
  dpkg-query -W -f '${Package} ${Version}, ${Section}, ${Installed-Size} KiB; needs ${Depends}\n' vtknurbs
  [ -s /usr/share/doc/vtknurbs/copyright ]

  echo "== the tool"
  vtknurbs tessellate "$model" -o rods.vtp --report rods.json
  vtknurbs render "$model" -o rods.png

  echo "== Python"
  python3 /src/Testing/Plugin/Package/pipeline.py /usr "$model"

  echo "== ParaView's Python, the plugin by its path"
  plugin=$(dpkg -L vtknurbs | grep '/NURBS\.so$')
  cat >load.py <<PYTHON
from paraview.simple import *
LoadPlugin("$plugin", ns=globals())
rods = OpenDataFile("$model")
display = Show(rods)
assert display.Representation == "NURBS Surface", display.Representation
SaveScreenshot("paraview.png")
PYTHON
  xvfb-run -a pvpython load.py

  echo "== ParaView's window, started for the first time: the plugin is loaded already"
  cat >window.py <<PYTHON
import os
from paraview.simple import *
rods = OpenDataFile("$model")
display = Show(rods)
assert display.Representation == "NURBS Surface", display.Representation
SaveScreenshot("window.png")
print("the window has the plugin", flush=True)
os._exit(0)
PYTHON
  timeout 120 xvfb-run -a paraview --script=window.py >window.log 2>&1 || true
  grep 'the window has the plugin' window.log || { cat window.log && exit 1; }
  stat -c '%n: %s bytes' rods.png paraview.png window.png

  echo "== a C++ project"
  apt-get -qq -y -o Dpkg::Use-Pty=0 --no-install-recommends install /src/build/vtknurbs-dev_*.deb g++ cmake ninja-build \
    >apt.log 2>&1 || { tail -n 20 apt.log && exit 1; }
  cp -r /src/Testing/Plugin/Package consumer
  cmake -G Ninja -S consumer -B consumer/build -DCMAKE_BUILD_TYPE=Release >cmake.log 2>&1 ||
    { cat cmake.log && exit 1; }
  cmake --build consumer/build
  consumer/build/kernel
  consumer/build/pipeline

  echo "== removed again"
  apt-get -qq -y -o Dpkg::Use-Pty=0 purge vtknurbs vtknurbs-dev >/dev/null 2>&1
  for trace in /usr/bin/vtknurbs /usr/lib/python3/dist-packages/vtknurbs "$plugin" /etc/xdg/ParaView; do
    [ ! -e "$trace" ] || { echo "$trace is still there" && exit 1; }
  done
  echo "the packages work"
}

if [ "${1:-}" = --check ]; then
  check
  exit
fi
root="${1:-${NURBS_CI_CACHE:-/var/cache/vtknurbs-ci}/packages}"
cd "$repository"
ls build/package/vtknurbs_*.deb build/package/vtknurbs-dev_*.deb
mkdir -p "build/chroot/$(basename "$root")"
cp build/package/vtknurbs*.deb "build/chroot/$(basename "$root")/"
.ci/debian "$root" Testing/Plugin/Package/debian.sh --check
