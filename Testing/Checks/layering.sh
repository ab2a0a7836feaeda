#!/usr/bin/env bash
# Every line of code in its place (the rules are in the README and in Documentation/Developer).
# Prints each offence as file:line: what; exits 1 if there is any. With a folder as argument it
# checks that tree instead of this one.
set -euo pipefail
cd "${1:-"$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.."}"

offences=0
# offence MESSAGE < lines of grep -Hn
offence() {
  while IFS= read -r line; do
    printf '%s: %s\n' "$(cut -d: -f1-2 <<<"$line")" "$1"
    offences=$((offences + 1))
  done
}
# including REGEX < file names: the #include lines that match.
including() { xargs -r grep -HnE "^[[:space:]]*#[[:space:]]*include[[:space:]]*[<\"]($1)" || true; }

mapfile -t sources < <(find Filters Rendering Plugin Testing Documentation -type f \
  \( -name '*.h' -o -name '*.cxx' \) | LC_ALL=C sort)
list() { [ ${#sources[@]} -eq 0 ] || printf '%s\n' "${sources[@]}"; }

vtk='vtk[A-Z]|vtkm/|vtk_'
opencascade='[A-Za-z0-9_]+\.(hxx|lxx|gxx)[>"]'
cgal='CGAL/'
opengl='GL/|GLES[0-9]*/|EGL/|epoxy/|glad/|vtk_glew|vtkOpenGL|vtkEGL'
qt='Q(t[A-Z][A-Za-z0-9]*/|[A-Z][A-Za-z0-9]*[>"/])|pq[A-Z]'

offence 'only files named vtk*, and main.cxx of the command line, may know VTK' < <(
  list | grep -vE '^Testing/|/(vtk|pq)[^/]*$|^Plugin/CommandLine/main\.cxx$' | including "$vtk")
offence 'math tests, named nurbs*, may not know VTK' < <(
  list | grep -E '^Testing/.*/nurbs[^/]*$' | including "$vtk")
offence 'OpenCASCADE belongs in Filters/Sources' < <(
  list | grep -vE '^(Filters/Sources|Testing/(Filters/Sources|Peers|Benchmarks|Verification))/' |
    including "$opencascade")
offence 'a public VTK header may not show OpenCASCADE' < <(
  list | grep -E '/vtk[^/]*\.h$' | including "$opencascade")
offence 'CGAL belongs in .cxx files' < <(list | grep -E '\.h$' | including "$cgal")
offence 'OpenGL belongs in Rendering' < <(
  list | grep -vE '^(Testing/)?Rendering/|^Testing/Benchmarks/' | including "$opengl")
offence 'Qt belongs in files named pq*' < <(list | grep -vE '/pq[^/]*$' | including "$qt")
offence 'rooms of Filters may include only Core and themselves' < <(
  for room in Sources Tessellation Visibility Wavelet Deformation; do
    others=$(find Filters -mindepth 2 -maxdepth 2 -name '*.h' ! -path 'Filters/Core/*' \
      ! -path "Filters/$room/*" -printf '%f|' | sed 's/\./\\./g; s/|$//')
    [ -z "$others" ] || list | grep "^Filters/$room/" | including "($others)\""
  done)
offence 'using namespace in a header' < <(
  list | grep -E '\.h$' | xargs -r grep -HnE '^[[:space:]]*using namespace' || true)
offence 'sources are ASCII' < <(list | xargs -r env LC_ALL=C grep -HnP '[^\x00-\x7F]' || true)
offence 'unfinished work is marked' < <(
  list | xargs -r grep -HnwE 'TODO|FIXME|XXX|HACK' || true)
offence 'a file has fewer than 700 lines' < <(
  list | xargs -r wc -l | awk '$2 != "total" && $1 >= 700 { print $2 ":" $1 ":" }')
# A class of one name in two files is one class to the linker, whichever library has it: a file's own
# types belong into an anonymous namespace. Types begin at the start of a line, namespaces end with
# "} // namespace", as clang-format has it.
offence 'namespace nurbs has a type of this name already' < <(
  list | grep -E '^(Filters|Rendering|Plugin)/' | xargs -r awk '
    FNR == 1 { depth = 0 }
    /^namespace( |$)/ { names[++depth] = $2 }
    /^} \/\/ namespace/ { --depth }
    /^(struct|class|union|enum) / && !/;$/ {
      space = ""
      for (i = 1; i <= depth; ++i) { space = names[i] == "" ? "-" : space names[i] "::" }
      if (space !~ /^nurbs::/) { next }
      sub(/^(struct|class|union|enum class|enum) /, "")
      sub(/^[A-Z_0-9]+ /, "")
      if (!match($0, /^[A-Za-z0-9_]+/) || substr($0, RLENGTH + 1) ~ /^(::|<)/) { next }
      name = space substr($0, 1, RLENGTH)
      if (name in seen) { print FILENAME ":" FNR ": " name; print seen[name] ": " name }
      seen[name] = FILENAME ":" FNR
    }')

if [ "$offences" -gt 0 ]; then
  echo "layering: $offences offences in ${#sources[@]} files"
  exit 1
fi
echo "layering: ${#sources[@]} files, no offence"
