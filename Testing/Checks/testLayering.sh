#!/usr/bin/env bash
# Does layering.sh see what it is for? Each case is a tree of one file with one offence.
set -euo pipefail
check="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/layering.sh"
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/{Filters/{Core,Sources,Tessellation},Rendering/EGL,Plugin/ParaView,Testing/Filters/Core,Documentation}
failures=0

# try accepted|refused FILE TEXT
try() {
  mkdir -p "$(dirname "$tree/$2")"
  printf '%b\n' "$3" >"$tree/$2"
  local got=refused
  ! "$check" "$tree" >/dev/null || got=accepted
  if [ "$got" != "$1" ]; then
    echo "layering.sh: $2 with '${3:0:60}' was $got, should be $1"
    failures=$((failures + 1))
  fi
  rm "$tree/$2"
}

try accepted Filters/Core/vtkNURBSModel.cxx '#include "vtkObject.h"'
try refused Filters/Core/Basis.cxx '#include "vtkObject.h"'
try refused Filters/Core/Basis.h '#  include <vtkMath.h>'
try refused Filters/Core/Basis.cxx '#include "vtk_eigen.h"'
try accepted Filters/Core/Basis.cxx '#include "Basis.h"\n// vtkObject.h is not included'
try accepted Testing/Filters/Core/TestModel.cxx '#include <vtkObject.h>'
try refused Testing/Filters/Core/nurbsBasisTest.cxx '#include <vtkObject.h>'
try accepted Plugin/CommandLine/main.cxx '#include "vtkReadModel.h"'
try refused Plugin/CommandLine/Report.cxx '#include <vtkPolyData.h>'
try accepted Filters/Sources/CADConverter.cxx '#include <gp_Pnt.hxx>'
try refused Filters/Sources/vtkNURBSCADReader.h '#include <gp_Pnt.hxx>'
try refused Filters/Tessellation/Tessellator.cxx '#include <gp_Pnt.hxx>'
try accepted Filters/Tessellation/LoopRepair.cxx '#include <CGAL/Surface_sweep_2.h>'
try refused Filters/Tessellation/LoopRepair.h '#include <CGAL/Surface_sweep_2.h>'
try accepted Rendering/EGL/vtkNURBSEGLRenderWindow.cxx '#include <EGL/egl.h>'
try refused Filters/Core/vtkNURBSModel.cxx '#include <EGL/egl.h>'
try refused Filters/Core/vtkNURBSModel.cxx '#include "vtkOpenGLRenderWindow.h"'
try accepted Plugin/ParaView/pqNURBSPanel.cxx '#include <QWidget>'
try refused Filters/Core/vtkNURBSModel.cxx '#include <QtCore/QString>'
try refused Filters/Core/Basis.h 'using namespace std;'
try refused Filters/Core/Basis.cxx '// B\xc3\xa9zier'
try refused Filters/Core/Basis.cxx '// TODO: more'
try refused Filters/Core/Basis.cxx "$(printf '//\\n%.0s' {1..700})"
try accepted Filters/Core/Basis.cxx "$(printf '//\\n%.0s' {1..690})"
touch "$tree/Filters/Tessellation/Tessellator.h"
try refused Filters/Sources/Shapes.cxx '#include "Tessellator.h"'
try accepted Filters/Tessellation/Tessellator.cxx '#include "Tessellator.h"'

two='namespace nurbs\n{\nstruct Point\n{\n};\n} // namespace nurbs'
hidden='namespace nurbs\n{\nnamespace\n{\nstruct Point\n{\n};\n} // namespace\n} // namespace nurbs'
printf '%b\n' "$two" >"$tree/Filters/Core/Points.cxx"
try refused Filters/Tessellation/Tessellator.cxx "$two"
try accepted Filters/Tessellation/Tessellator.cxx "$hidden"
try accepted Filters/Tessellation/Tessellator.cxx 'namespace nurbs\n{\nstruct Point;\n} // namespace nurbs'
try refused Filters/Tessellation/Tessellator.cxx "${two/struct Point/enum class Point}"

[ "$failures" -eq 0 ] && echo "layering.sh sees what it is for"
