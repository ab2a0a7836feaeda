# The Debian packages vtknurbs and vtknurbs-dev (preset package, `./run package`).

if (NOT NURBS_DEBIAN_PACKAGE)
  return ()
endif ()
if (NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  message(FATAL_ERROR "NURBS_DEBIAN_PACKAGE needs CMAKE_INSTALL_PREFIX=/usr, as preset package has it")
endif ()

set(debian "${PROJECT_SOURCE_DIR}/Plugin/Debian")
foreach (package vtknurbs vtknurbs-dev)
  set(component runtime)
  if (package STREQUAL "vtknurbs-dev")
    set(component development)
  endif ()
  install(FILES "${debian}/copyright" DESTINATION "share/doc/${package}" COMPONENT "${component}")
endforeach ()
if (TARGET NURBS)
  # Who starts this ParaView for the first time has the plugin loaded.
  set(NURBS_PLUGIN "/usr/${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/NURBS/NURBS.so")
  configure_file("${debian}/ParaView.ini.in" "${CMAKE_BINARY_DIR}/ParaView${ParaView_VERSION}.ini" @ONLY)
  install(FILES "${CMAKE_BINARY_DIR}/ParaView${ParaView_VERSION}.ini"
    DESTINATION /etc/xdg/ParaView COMPONENT runtime)
  file(WRITE "${CMAKE_BINARY_DIR}/conffiles" "/etc/xdg/ParaView/ParaView${ParaView_VERSION}.ini\n")
endif ()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vtknurbs)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_CONTACT "vtkNURBS developers <vtknurbs@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME vtknurbs)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION
"Reads STEP, IGES and BREP files as exact trimmed surfaces, meshes them
within a certified error, draws them on the GPU, deforms them, tells what
is visible, and makes line drawings.
.
The vtknurbs tool, the Python package vtknurbs, the ParaView plugin NURBS
and their libraries.")
# The libraries that are linked, by dpkg-shlibdeps; ParaView's bring its exact version.
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
if (NURBS_VTK_FLAVOUR_FOUND STREQUAL "paraview")
  set(vtk_python python3-paraview)
  set(vtk_development paraview-dev)
else ()
  set(vtk_python python3-vtk9)
  set(vtk_development libvtk9-dev)
endif ()
set(python_minor "${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}")
math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "${vtk_python}, python3 (>= ${python_minor}~), \
python3 (<< ${Python3_VERSION_MAJOR}.${next_minor}~), libgl1-mesa-dri")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS "occt-misc, python3-numpy")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA "${debian}/prerm")
if (TARGET NURBS)
  list(APPEND CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA "${CMAKE_BINARY_DIR}/conffiles")
endif ()

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME vtknurbs-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
  "Headers of vtkNURBS and its CMake package: find_package(vtkNURBS).")
# What find_package(VTK) of Debian's package looks for besides its own files is in ./run packages.
execute_process(COMMAND "${PROJECT_SOURCE_DIR}/run" packages development
  OUTPUT_VARIABLE development OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ", " development "${development}")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "vtknurbs (= ${PROJECT_VERSION}-1), ${vtk_development}, libeigen3-dev, ${development}")

include(CPack)
foreach (component runtime python paraview licenses)
  cpack_add_component("${component}" GROUP runtime)
endforeach ()
cpack_add_component(development GROUP development)
cpack_add_component_group(runtime)
cpack_add_component_group(development)
