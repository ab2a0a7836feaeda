# Options of the build, compiler flags, and where things are put.

option(NURBS_KERNEL_ONLY "Build the kernels and their tests only: no VTK, no OpenCASCADE" OFF)
option(NURBS_TESTING "Build the tests" ON)
option(NURBS_BENCHMARKS "Build the benchmarks and the comparisons with OpenCASCADE" OFF)
option(NURBS_FUZZ "Build the libFuzzer targets (needs clang)" OFF)
option(NURBS_WERROR "Treat warnings as errors" OFF)
set(NURBS_SANITIZE "" CACHE STRING "Comma-separated sanitizers, e.g. address,undefined")
option(NURBS_PARAVIEW_PLUGIN "Build the ParaView plugin, if the VTK is that of ParaView's SDK" ON)
option(NURBS_PARAVIEW_WIDGETS "Build the plugin's Qt widgets (needs Qt 5's development files)" ON)
option(NURBS_DEBIAN_PACKAGE "Prepare the build for cpack -G DEB" OFF)
set(NURBS_VTK_FLAVOUR "auto" CACHE STRING
  "Whose VTK to build on: paraview (ParaView's SDK), plain (find_package(VTK)), or auto")
set_property(CACHE NURBS_VTK_FLAVOUR PROPERTY STRINGS auto paraview plain)

set(BUILD_SHARED_LIBS ON)
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if (NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "Build type" FORCE)
endif ()

# Debian's Python, whose version its VTK was built for; another may come first in PATH.
if (EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python that VTK was built for")
endif ()

find_program(NURBS_CCACHE ccache)
if (NURBS_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_C_COMPILER_LAUNCHER "${NURBS_CCACHE}")
  set(CMAKE_CXX_COMPILER_LAUNCHER "${NURBS_CCACHE}")
endif ()

# Results must be the same whatever a compiler fuses and whichever clone of a function runs, hence
# no contraction; errno and traps are of no use to us and hinder vectorisation.
add_compile_options(
  -ffp-contract=off
  -fno-math-errno
  -fno-trapping-math
  "$<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>"
  "$<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>")

# A library's calls of its own functions are bound when it is linked: else hundreds of names are looked up
# in all of VTK's libraries when a filter first runs, which takes longer than drawing a small model.
add_link_options("LINKER:-Bsymbolic-functions")

if (NURBS_SANITIZE)
  add_compile_options(
    "-fsanitize=${NURBS_SANITIZE}" -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options("-fsanitize=${NURBS_SANITIZE}")
  add_compile_definitions(NURBS_SANITIZE)
endif ()
if (NURBS_FUZZ)
  if (NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "NURBS_FUZZ needs clang (libFuzzer); the compiler is ${CMAKE_CXX_COMPILER}")
  endif ()
  add_compile_options(-fsanitize=fuzzer-no-link)
endif ()

find_program(NURBS_LLD NAMES ld.lld ld.lld-14)
if (NURBS_LLD)
  add_link_options(-fuse-ld=lld)
endif ()

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(NURBS_PYTHON_DESTINATION "lib/python3/dist-packages")
set(NURBS_HEADERS_DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/vtknurbs")
set(NURBS_CMAKE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/vtkNURBS")
set(CMAKE_INSTALL_RPATH "$ORIGIN;$ORIGIN/../${CMAKE_INSTALL_LIBDIR};$ORIGIN/../../../../${CMAKE_INSTALL_LIBDIR}")

set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
find_package(Threads REQUIRED)
find_package(Eigen3 3.3 REQUIRED NO_MODULE)
