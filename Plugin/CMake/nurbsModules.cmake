# Scans and builds the VTK modules listed in module_files.

if (module_files)
  vtk_module_scan(
    MODULE_FILES ${module_files}
    PROVIDES_MODULES nurbs_modules
    WANT_BY_DEFAULT ON
    ENABLE_TESTS OFF)
  vtk_module_build(
    MODULES ${nurbs_modules}
    PACKAGE vtkNURBS
    VERSION "${PROJECT_VERSION}"
    SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}"
    INSTALL_EXPORT vtkNURBS
    HEADERS_DESTINATION "${NURBS_HEADERS_DESTINATION}"
    CMAKE_DESTINATION "${NURBS_CMAKE_DESTINATION}"
    TEST_DIRECTORY_NAME NONE)
else ()
  set(nurbs_modules)
endif ()
# Kernels of rooms that have no VTK class yet.
if (NOT TARGET nurbsCore)
  add_subdirectory(Filters/Core)
endif ()
if (NOT TARGET nurbsTessellation)
  add_subdirectory(Filters/Tessellation)
endif ()
if (NOT TARGET nurbsWavelet)
  add_subdirectory(Filters/Wavelet)
endif ()
if (NOT TARGET nurbsDeformation)
  add_subdirectory(Filters/Deformation)
endif ()
if (NOT TARGET nurbsVisibility)
  add_subdirectory(Filters/Visibility)
endif ()
