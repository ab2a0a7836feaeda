#!/usr/bin/env bash
# Installs the packages of `./run package` in a Debian 12 of their own and uses them there. As root; needs
# debootstrap, and Debian's mirror for what the packages depend on.
#
#   Testing/Plugin/Package/debian.sh [ROOT]   ROOT: folder of the chroot, made if it is not there
set -euo pipefail
repository="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../../.."

# Runs a command on a display of its own; the numbers of CTest's are lower. A server in a chroot shares
# the host's names of sockets.
on_display() { xvfb-run -a -n 900 -s "-screen 0 1280x1024x24 -noreset" "$@"; }

# Within the chroot.
check() {
  local plugin model=/usr/share/opencascade/data/step/linkrods.step
  cd "$(mktemp -d)"
  export DEBIAN_FRONTEND=noninteractive HOME="$PWD" XDG_RUNTIME_DIR="$PWD"
  apt-get -qq update
  dpkg --purge vtknurbs-dev vtknurbs >/dev/null 2>&1 || true
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
ResetCamera()
SaveScreenshot("paraview.png", ImageResolution=[600, 400])
PYTHON
  on_display pvpython load.py

  echo "== ParaView's window, started for the first time: the plugin is loaded already"
  cat >window.py <<PYTHON
import os
from paraview.simple import *
rods = OpenDataFile("$model")
display = Show(rods)
ResetCamera()
SaveScreenshot("window.png", ImageResolution=[600, 400])
with open("window.txt", "w") as told:
    told.write("drawn" if display.Representation == "NURBS Surface" else "not drawn")
os._exit(0)
PYTHON
  on_display timeout 300 paraview --script="$PWD/window.py" >window.log 2>&1 || true
  [ "$(cat window.txt)" = drawn ] || { cat window.log && exit 1; }
  for picture in rods.png paraview.png window.png; do
    [ "$(stat -c %s "$picture")" -gt 8000 ] || { echo "$picture is empty" && exit 1; }
  done

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
  dpkg --purge vtknurbs-dev vtknurbs >purge.log 2>&1 || { cat purge.log && exit 1; }
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
